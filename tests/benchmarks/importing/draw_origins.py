"""Draw takes of other programs as Import reads them, to be looked at.

.venv-4.5/bin/python -m tests.benchmarks.importing.draw_origins   # into docs/pictures/formats
"""

import sys
from pathlib import Path

from ..shared.clips import DATA
from ..shared.report import PICTURES
from .bench_scene_io import load_checkout

ORIGINS = {
    "bandai_namco": "bvh/bandai_namco/dataset-1_bow_active_001.bvh",
    "fbx": "fbx/mixamo_web/Rolling.fbx",
    "glb": "glb/mixamo_blender/walking.glb",
    "vrma": "vrm/vrma_pixiv/test.vrma",
    "mvnx": "lab/xsens_mvnx/test_mocap.mvnx",
    "smpl": "bvh/smpl_momask/momask_out.bvh",
    "kimodo": "smpl/kimodo_soma_npz/05_root_path.npz",
    "vicon": "lab/c3d_vicon/Vicon.c3d",
}
"""Files of the corpus by the name of their picture."""
SUFFIX = ".png"


def main() -> None:
    """Write one picture for each origin that is named, or for all."""
    load_checkout()
    from mocap_ext.mocap_assist.importing.solve_reading import Conversion, read_takes
    from mocap_ext.solvers.pictures import draw_stick_figures
    from mocap_ext.solvers.recordings import FloorPlacement

    folder = Path(sys.argv[1]) if sys.argv[1:] else PICTURES / "formats"
    for name, file in ORIGINS.items():
        first = read_takes(DATA / "corpus" / file, Conversion(floor=FloorPlacement.AUTO))[0]
        label = f"{Path(file).name}, as it was read"
        draw_stick_figures({label: first.recording}).save(folder / (name + SUFFIX))
        print(name, flush=True)


if __name__ == "__main__":
    main()
