"""Run the drivers of this folder in a Blender with a window: `make test-gui`.

The window is that of ../shared/tools/blender-gui.sh where it is there, else of the `blender` on
the PATH. Pictures and logs lie in build/gui, a folder for each driver. A driver that lacks its
recordings is skipped. The exit status is 0 where all that ran have passed, 1 where one failed,
and 2 where there is no Blender with a window.
"""

import argparse
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
from window import made_depth, own_window

ROOT = Path(__file__).resolve().parents[2]
SHARED = ROOT.parent / "shared"
TOOL = SHARED / "tools" / "blender-gui.sh"
FOLDER, FIXTURES = ROOT / "tests" / "gui", ROOT / "tests" / "fixtures"
PICTURES = ROOT / "build" / "gui"
PACKAGES = "python3-scipy python3-pil python3-xlib"
"""Of the tool's Debian: what the plain zip lacks, and what drops files."""
RECORDINGS = {
    "axes": {
        "walk.bvh": "mocap/cmu_walk/07_01.bvh",
        "joints.txt": "kinect/irds/215_18_0_5_1_stand.txt",
    },
    "cameras": {},
    "clean": {},
    "contacts": {
        "walking.glb": "corpus/glb/mixamo_blender/walking.glb",
        "HDM_bd.asf": "mocap/hdm05/HDM_bd.asf",
        **{
            f"HDM_bd_{name}_120.amc": f"mocap/hdm05/HDM_bd_{name}_120.amc"
            for name in ("hopBothLegs1hops_002", "lieDownFloor_002", "kickLFront1Reps_001")
        },
    },
    "export": {},
    "depth": {"walk.npz": "depth/truth/walk_front.npz"},
    "drop": {
        "drop_files.py": FOLDER / "window" / "drop_files.py",
        "walk.bvh": "corpus/bvh/bandai_namco/dataset-1_walk_tired_001.bvh",
        "Jump.fbx": "corpus/fbx/mixamo_web/Jump.fbx",
        "actor.asf": "mocap/hdm05/HDM_bd.asf",
        "kick.amc": "mocap/hdm05/HDM_bd_kickLFront1Reps_002_120.amc",
    },
    "fix": {},
    "import": {
        "walk.bvh": "mocap/cmu_walk/07_01.bvh",
        "joints.txt": "kinect/irds/215_18_0_5_1_stand.txt",
        "markers.trc": "formats/trc/motion_capture_run.trc",
    },
    "languages": {},
    "library": {
        f"clips/{name}.bvh": f"mocap/cmu_walk/{name}.bvh"
        for name in ("05_01", "07_01", "07_02", "10_04", "35_01", "35_02")
    },
    "listen": {},
    "marker_overlay": {"markers.trc": "formats/trc/subject02_running.trc"},
    "markers": {"markers.c3d": "markers/85_02.c3d"},
    "people": {},
    "physics": {"walk.bvh": "mocap/cmu_walk/07_01.bvh"},
    "redo": {"walk.bvh": "mocap/cmu_walk/07_01.bvh"},
    "reconstruct": {"kinect.txt": "kinect/irds/217_18_0_3_1_wheelchair.txt"},
    "retarget": {},
    "strip": {},
    "submit": {"clusters/flamenco_stub.py": FIXTURES / "clusters" / "flamenco_stub.py"},
    "supports": {
        "HDM_dg.asf": "mocap/hdm05/HDM_dg.asf",
        "HDM_dg_lieDownFloor_014_120.amc": "mocap/hdm05/HDM_dg_lieDownFloor_014_120.amc",
    },
    "skin": {"walking.glb": "corpus/glb/mixamo_blender/walking.glb"},
    "import_framing": {
        "walk.bvh": "mocap/cmu_walk/07_01.bvh",
        "mixamo.fbx": "corpus/fbx/mixamo_web/Walking.fbx",
        "kinect.txt": "kinect/irds/215_18_0_5_1_stand.txt",
        "cmu.c3d": "markers/85_02.c3d",
        "gait.c3d": "formats/c3d/PiG_Motion-FlatFoot-Hole.c3d",
    },
    "track": {"walk.npz": "depth/truth/walk_front.npz"},
    "track_live": {
        "walk.npz": "depth/truth/walk_front.npz",
        "record_images.py": FOLDER / "window" / "record_images.py",
    },
    "undo": {},
    "vary": {
        f"kicks/{name}": f"mocap/hdm05/{name}"
        for name in (
            "HDM_bd.asf",
            *(f"HDM_bd_kickLFront1Reps_{number:03}_120.amc" for number in range(1, 7)),
        )
    },
}  # fmt: skip
"""For each driver, the files copied next to it, and their paths, from ../shared/data on."""
MADE = {"cameras": made_depth.write_cameras, "people": made_depth.write_people}
"""Drivers whose recordings are made, and what writes them into a folder."""
FIRST_FRAMES = {"track": 30}
"""Of a recording of depth: tracking a frame takes a second."""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", metavar="DRIVER", help="such as clean; or all")
    parser.add_argument("--zip", required=True, type=Path, help="the extension without wheels")
    parsed = parser.parse_args()
    if unknown := set(parsed.names) - set(RECORDINGS):
        parser.error(
            f"no driver {', '.join(sorted(unknown))}; there are {', '.join(RECORDINGS)}"
        )
    if not TOOL.exists() and (missing := own_window.missing()):
        print(f"Stopped: there is no {TOOL}, and no {', '.join(missing)} on the PATH.")
        return 2
    failed = [name for name in parsed.names or RECORDINGS if not passes(name, parsed.zip)]
    print(f"Failed: {', '.join(failed)}." if failed else "All drivers that ran have passed.")
    return 1 if failed else 0


def passes(name: str, zip_path: Path) -> bool:
    """Run one driver and say how it ended; one that has no recordings counts as passed."""
    out = PICTURES / name
    shutil.rmtree(out, ignore_errors=True)
    try:
        given = lay_out(name, out / "given")
    except FileNotFoundError as error:
        print(f"{name}: skipped, since {error.filename} is missing.")
        return True
    driver, picture = next(FOLDER.rglob(f"drive_{name}.py")), out / f"{name}.png"
    if TOOL.exists():
        options = {
            "BG_DEBS": PACKAGES,
            "BG_FILES": " ".join(map(str, given)),
            "BG_TIMEOUT": str(own_window.SECONDS),
        }
        command = ["bash", TOOL, "run", zip_path, driver, picture]
        ended = subprocess.run(
            command, env=os.environ | options, capture_output=True, text=True, check=False
        )
        status, output = ended.returncode, ended.stdout + ended.stderr
    else:
        status, output = own_window.run(zip_path, driver, given, picture)
    (out / "run.txt").write_text(output, encoding="utf-8")
    n_images = len(list(out.glob("*.png")))
    ending = "passed" if status == 0 else f"FAILED with status {status}, see {out / 'run.txt'}"
    print(f"{name}: {ending}; {n_images} pictures.", flush=True)
    return status == 0


def lay_out(name: str, folder: Path) -> list[Path]:
    """Copy what a driver needs into `folder`, and return all files there."""
    folder.mkdir(parents=True)
    if name in MADE:
        MADE[name](folder)
    for copy_name, source in RECORDINGS[name].items():
        path = folder / copy_name
        path.parent.mkdir(parents=True, exist_ok=True)
        if name in FIRST_FRAMES:
            _cut(SHARED / "data" / source, path, FIRST_FRAMES[name])
        else:
            shutil.copy(SHARED / "data" / source, path)
    return [FOLDER / "window" / "driver_scene.py", *sorted(folder.iterdir())]


def _cut(source: Path, path: Path, n_frames: int) -> None:
    """Copy the first frames of a recording of depth."""
    with np.load(source) as arrays:
        content = {name: arrays[name] for name in arrays.files}
    np.savez_compressed(
        path, **content | {name: content[name][:n_frames] for name in ("depth", "joints")}
    )


if __name__ == "__main__":
    sys.exit(main())
