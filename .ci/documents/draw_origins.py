"""Draw takes of many makers as Blender shows them: imported, cleaned, and on a Rigify rig.

    make pictures-origins                    # all, into build/origins
    make pictures-origins TAKES="cmu xsens"  # parts of names

Every file goes through the buttons Import and Clean, three of them through Retarget too. Then
the bones of the evaluated scene are drawn, not what our readers think of them: from the front
(the camera looks along +Y, as Blender's front view) and from the side (along -X). Limbs of the
left side, by the names of the bones, are orange, those of the right side blue. The line is the
floor, at height 0. The last two figures of a row are its fastest moments.
"""

import os
import re
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from draw_rigs import load_extension, make_rigify
from numpy.typing import NDArray

TAKES = {
    "bandai_namco": "corpus/bvh/bandai_namco/dataset-1_run_angry_001.bvh",
    "mixamo_fbx": "corpus/fbx/mixamo_web/Jump.fbx",
    "mixamo_glb": "corpus/glb/mixamo_blender/walking.glb",
    "cesium_glb": "corpus/glb/khronos_cesiumman/CesiumMan.glb",
    "momask_smpl": "corpus/bvh/smpl_momask/momask_out.bvh",
    "kimodo_npz": "corpus/smpl/kimodo_soma_npz/01_single_text_prompt.npz",
    "xsens_mvnx": "corpus/lab/xsens_mvnx/test_mocap.mvnx",
    "xia_bvh": "corpus/bvh/dme_xia/angry_13_000.bvh",
    "life_forms_bvh": "corpus/bvh/olympe_ballet/ballet.bvh",
    "poser_bvh": "corpus/bvh/assimp_boxing_toes/Boxing_Toes.bvh",
    "cmu_bvh": "mocap/cmu_walk/35_17.bvh",
    "hdm05_amc": "mocap/hdm05/HDM_dg_kickLFront1Reps_013_120.amc",
    "z_up_bvh": "corpus/bvh/pybvh_test3/bvh_test3.bvh",
}
ON_RIGIFY = {"bandai_namco", "mixamo_fbx", "kimodo_npz"}
LEFT = re.compile(r"left|(^|[_.:\s])l([_.\s]|$)|^l[A-Z]|_L_|^l(?=femur|tibia|foot|toes|hum)")
RIGHT = re.compile(r"right|(^|[_.:\s])r([_.\s]|$)|^r[A-Z]|_R_|^r(?=femur|tibia|foot|toes|hum)")
COLORS = {"left": (213, 94, 0), "right": (0, 90, 181), "": (90, 90, 90)}
N_EVEN, N_FAST, N_PROBED = 5, 2, 60
HEIGHT_PX, MARGIN_PX, WIDTH = 190.0, 14.0, 1.1
"""Height of the tallest figure; the width of a cell is relative to it."""
VIEWS: dict[str, Callable[[NDArray[np.float64]], NDArray[np.float64]]] = {
    "front": lambda points: points[..., [0, 2]],
    "side": lambda points: points[..., [1, 2]] * (-1.0, 1.0),
}


class Bones(NamedTuple):
    """Ends of the bones over time, in meters of the world."""

    names: tuple[str, ...]
    ends: NDArray[np.float64]
    """Shape (n_frames, n_bones, 2, 3)."""


def main(data: Path, folder: Path, wanted: list[str]) -> None:
    """Draw a picture for each take."""
    import bpy

    load_extension(bpy)
    folder.mkdir(parents=True, exist_ok=True)
    for name, file in TAKES.items():
        if wanted and not any(part in name for part in wanted):
            continue
        draw_take(bpy, data / file, folder / f"{name}.png", name in ON_RIGIFY)
        print(f"Drew {name}", flush=True)


def draw_take(bpy: ModuleType, file: Path, path: Path, on_rigify: bool) -> None:
    """Import, clean and perhaps retarget a take; draw each step."""
    from mocap_ext.solvers.pictures import stack_pictures

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    rig = make_rigify(bpy) if on_rigify else None
    before = set(bpy.data.objects)
    bpy.ops.mocap_assist.import_recording(filepath=str(file))
    armature = [
        each for each in bpy.data.objects if each not in before and each.type == "ARMATURE"
    ][-1]
    for each in bpy.context.view_layer.objects.selected:
        each.select_set(False)
    bpy.context.view_layer.objects.active = armature
    armature.select_set(True)
    frames = chosen_frames(bpy, armature)
    rows = [draw_rows(f"{file.name}, imported", sampled(bpy, armature, frames), frames)]
    bpy.ops.mocap_assist.denoise()
    rows.append(draw_rows("after Clean", sampled(bpy, armature, frames), frames))
    if rig is not None:
        bpy.ops.mocap_assist.retarget(target=rig.name)
        rows.append(draw_rows("on Rigify", sampled(bpy, rig, frames), frames))
    stack_pictures(rows).save(path)


def chosen_frames(bpy: ModuleType, armature: Any) -> list[float]:
    """Return frames of the take: some evenly spaced, and the fastest."""
    first, last = armature.animation_data.action.frame_range
    probed = np.linspace(first, last, N_PROBED)
    ends = sampled(bpy, armature, list(probed)).ends
    speeds = np.linalg.norm(np.diff(ends[:, :, 0], axis=0), axis=-1).mean(axis=-1)
    fast: list[int] = []
    for index in np.argsort(speeds)[::-1]:
        if all(abs(index - other) > N_PROBED // 10 for other in fast):
            fast.append(int(index))
    even = np.linspace(first, last, N_EVEN)
    return [*map(float, even), *(float(probed[index]) for index in sorted(fast[:N_FAST]))]


def sampled(bpy: ModuleType, armature: Any, frames: list[float]) -> Bones:
    """Return where the bones of the body are, as Blender evaluates them."""
    bones = [bone.name for bone in armature.pose.bones if bone.name.startswith("DEF-")]
    if bones:
        bones = [name for name in bones if BODY.search(name)]
    else:
        bones = [bone.name for bone in armature.pose.bones]
    ends = np.empty((len(frames), len(bones), 2, 3))
    for index, frame in enumerate(frames):
        bpy.context.scene.frame_set(int(frame), subframe=frame % 1.0)
        for number, name in enumerate(bones):
            bone = armature.pose.bones[name]
            children = [each for each in bone.children if each.name in bones]
            tail = bone.tail if len(children) != 1 else children[0].head
            ends[index, number] = [
                armature.matrix_world @ bone.head, armature.matrix_world @ tail
            ]  # fmt: skip
    return Bones(tuple(bones), ends)


BODY = re.compile(r"spine|shoulder|upper_arm|forearm|hand|thigh|shin|foot|toe")


def draw_rows(title: str, bones: Bones, frames: list[float]) -> Any:
    """Draw the figures from the front and from the side."""
    from mocap_ext.solvers.pictures import Canvas

    tallest = max(float(np.ptp(ends[..., 2])) for ends in bones.ends)
    highest = float(bones.ends[..., 2].max())
    lowest = min(float(bones.ends[..., 2].min()), 0.0)
    scale = HEIGHT_PX / max(tallest, 0.1)
    cell, row = WIDTH * HEIGHT_PX, (highest - lowest) * scale + 2 * MARGIN_PX
    canvas = Canvas(cell * len(frames) + 80.0, 30.0 + 2 * row)
    canvas.text(MARGIN_PX, 15.0, f"{title}: tallest {tallest:.2f} m, lowest {lowest:.2f} m")
    for number, (view, project) in enumerate(VIEWS.items()):
        floor = 30.0 + number * row + MARGIN_PX + highest * scale
        canvas.line([(70.0, floor), (70.0 + cell * len(frames), floor)], (150, 150, 150))
        canvas.text(MARGIN_PX, floor - 60.0, view)
        for index, frame in enumerate(frames):
            ends = project(bones.ends[index])
            middle = np.array([ends[..., 0].min() + 0.5 * np.ptp(ends[..., 0]), 0.0])
            origin = np.array([70.0 + (index + 0.5) * cell, floor])
            for name, bone in zip(bones.names, ends, strict=True):
                points = (bone - middle) * (scale, -scale) + origin
                canvas.line(points, COLORS[side_of(name)], 2.5)
            canvas.text(origin[0], floor + 8.0, f"{frame:.0f}", anchor="mm")
    return canvas.picture()


def side_of(name: str) -> str:
    """Return the side that the name of a bone says."""
    plain = name.split(":")[-1]
    for side, pattern in (("left", LEFT), ("right", RIGHT)):
        if pattern.search(plain) or pattern.search(plain.lower()):
            return side
    return ""


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve(), sys.argv[3:])
    sys.stdout.flush()
    os._exit(0)  # Blender may hang at its end
