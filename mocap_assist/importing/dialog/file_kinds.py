"""Find the kinds of the chosen recordings, so that Import shows only their settings."""

from collections.abc import Collection, Iterable
from pathlib import Path

from ....solvers.faults import Failure, attempt
from ....solvers.recordings import detect_format, is_scene_file
from ..depth_folders import is_take

DEPTH, SKELETON, JOINTS, MARKERS, SMPL = "depth", "skeleton", "joints", "markers", "smpl"
SCENE = "scene"
MOVING = {SKELETON, JOINTS, MARKERS, SMPL}
MAX_PREVIEWED_FILES = 50
"""Number of files whose first bytes are read, so that the dialog opens without delay."""
FOR_KINDS: dict[str, set[str]] = {
    "target": {JOINTS},
    "up": MOVING, "forward": MOVING, "place_on_floor": MOVING,
    "height": {SMPL},
    "keep_meshes": {SCENE},
    "rotate_mode": {SKELETON, JOINTS, SMPL},
    "focal_length": {DEPTH}, "focal_length_y": {DEPTH}, "center_x": {DEPTH},
    "center_y": {DEPTH}, "held": {DEPTH}, "mirrored": {DEPTH},
}  # fmt: skip
"""Kinds of recordings that a setting applies to; settings not listed apply to all kinds."""


def kinds_of(paths: Iterable[Path]) -> str:
    """Return the kinds of recordings, separated by spaces."""
    return " ".join(
        sorted({kind for path in [*paths][:MAX_PREVIEWED_FILES] for kind in _kinds(path)})
    )


def fitting(names: Iterable[str], kinds: Collection[str]) -> list[str]:
    """Return the settings that apply to these kinds; all if no kind is known."""
    return [name for name in names if not kinds or FOR_KINDS.get(name, {*kinds}) & {*kinds}]


def _kinds(path: Path) -> set[str]:
    if is_scene_file(path):
        return {SKELETON, SCENE}
    if is_take(path):
        return {DEPTH}
    found = attempt(path, detect_format, path)
    if found is None:
        return {DEPTH}
    if isinstance(found, Failure):
        return set()
    if found.lacks_bones:
        return {SMPL, JOINTS} if path.suffix.lower() == ".npy" else {SMPL}
    if found.has_skeleton:
        return {SKELETON}
    return {MARKERS} if found.has_markers else {JOINTS}
