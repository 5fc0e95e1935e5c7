"""Numbers that no metric varies and no family lists: in other folders, or inside a value.

Such a value is an array, a named tuple, a table, or computed from another constant.
"""

import ast
from collections.abc import Iterator
from itertools import zip_longest
from pathlib import Path

from .constants import (
    FAMILIES,
    ROOT,
    UNMEASURED,
    Constant,
    assigned_values,
    constants_of,
    text_of,
)

FOLDERS = ("solvers", "mocap_assist", "operators")
REASONS: dict[str, tuple[str, ...]] = {
    "draws or lays out what is on screen, or in a picture": (
        "pictures/*",
        "mocap_assist/check/key_map.*",
        "mocap_assist/check/panel.*",
        "mocap_assist/depth/depth_points.*",
        "mocap_assist/exporting/stick_mesh.*",
        "mocap_assist/find_similar/gallery*",
        "mocap_assist/find_similar/ghost_drawing.*",
        "mocap_assist/find_similar/match_grid.PICTURE_*",
        "mocap_assist/find_similar/panel.*",
        "mocap_assist/library/thumbnails.*",
        "mocap_assist/markers/sticks.*",
        "mocap_assist/overlays/*",
        "mocap_assist/panel_parts/figure_rows.*",
        "mocap_assist/track/body_overlay.*",
        "mocap_assist/ui/workspace.SPLITS",
        "mocap_assist/variants/panel.*",
    ),
    "makes synthetic takes": ("samples/*", "depth_tracking/forest_training/*"),
    "layout of a file, or of a property": ("*.LAYOUT", "mocap_assist/actions/curves.KEY"),
    "definition or conversion of units": (
        "motion/skeletons/file_conventions.UNIT_NAMES",
        "recordings/conventions/points.METERS",
        "recordings/point_bodies/landmark_recording.PERCENT",
        "recordings/point_bodies/time_units.SECONDS",
        "recordings/reading_settings.METERS",
        "recordings/streams/protocols/rokoko.HALF",
        "rotations/representations.FULL_TURN_RAD",
        "workflows/standard_joints.UNITS",
    ),
    "rest pose of a maker's skeleton": (
        "motion/skeletons/*_POSE",
        "motion/skeletons/mediapipe._THUMB",
        "reconstruction/joint_rotations/other_joints.TRUNK",
        "recordings/skeleton_files/smpl_bodies/joints.*",
    ),
    "priors of a marker set, whose numbers have names": ("markers/body_tables.SIDE*",),
    "fraction of a bar of progress": (
        "command_line/batches/screen.MIN_STEP",
        "recordings/read_recording.OPENING_FRACTION",
        "mocap_assist/exporting/write_file.*",
        "mocap_assist/importing/transaction.READING_FRACTION",
    ),
    "choices that the user sees, with a reason each": ("presets.PRESETS",),
}
"""Patterns of keys of what is no tuning, by reason."""


def other_constants() -> Iterator[Constant]:
    """Yield each name in capitals with a float in its value that no family lists."""
    families = FAMILIES | UNMEASURED
    listed = {(each.path, each.name) for family in families for each in constants_of(family)}
    for folder in FOLDERS:
        for module in sorted((ROOT / folder).rglob("*.py")):
            path = str(module.relative_to(ROOT))
            found = _in_module(module, path)
            yield from (each for each in found if (path, each.name) not in listed)


def _in_module(module: Path, path: str) -> Iterator[Constant]:
    source = module.read_text(encoding="utf-8")
    lines, body = source.splitlines(), ast.parse(source).body
    for node, after in zip_longest(body, body[1:]):
        for name, expression in assigned_values(node).items():
            if _has_float(expression):
                text = text_of(node, after, lines)
                yield Constant(path, name, ast.unparse(expression), text, node.lineno)


def _has_float(expression: ast.expr) -> bool:
    return any(
        isinstance(node, ast.Constant) and isinstance(node.value, float)
        and abs(node.value) not in (0.0, 1.0)
        for node in ast.walk(expression)
    )  # fmt: skip
