"""Read what the strip shows of an armature's action; read once, and cached."""

from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

import bpy
import numpy as np

from ....solvers.arrays import Array, Flags
from ....solvers.errors import InvalidMotionError
from ...actions.bone_channels import bone_path
from ...actions.contact_keys import contact_keys
from ...actions.curves import GENERATED, Channel, types_of
from ...actions.reliability_curves import reliability_path
from ...blender import compat
from ...blender.compat import Source
from ...scene import history
from ...scene.played_time import PlayedTime, played_time
from ..confidence_colors import reliability_source
from ..marked_ranges import (
    CONTACT_ROWS,
    Mark,
    Range,
    Rows,
    StripRow,
    confidence_ranges,
    contact_ranges,
    issue_ranges,
    ranges_of,
)

CHANNELS = ("rotation_quaternion", "rotation_euler", "rotation_axis_angle", "location")
MAX_CACHED = 8
"""Number of cached strips and actions. It bounds the memory."""
KEY_DECIMALS = 2
"""Decimals of a frame by which keys of two actions are compared; the rest is rounding, since
keys are 32-bit numbers."""


class ActionKeys(NamedTuple):
    """The frames of an action's keys and issues, as plain arrays."""

    first: float
    last: float
    step: float
    """Frames from one sample to the next."""
    filled: Mapping[str, Array]
    """By bone, the frames that the recording lacked."""
    corrected: Mapping[str, Array]
    """By bone, the frames whose recorded values were replaced."""
    confidence: Mapping[str, Array]
    """By bone, frame and value of its keys, shape (n_keys, 2)."""
    contacts: tuple[Array, ...]
    """Frame and value of the keys of each part of `CONTACT_ROWS`, shape (n_keys, 2)."""


class Strip(NamedTuple):
    """Rows of the strip, and the frames that it covers."""

    first: float
    last: float
    step: float
    rows: Rows

    def placed(self, time: PlayedTime) -> "Strip":
        """Return the strip of frames of an action at the scene frames where that is played."""
        rows = {
            row: tuple(
                Range(*time.scene_range(each.first, each.last), each.mark) for each in found
            )
            for row, found in self.rows.items()
        }
        ends = time.scene_range(self.first, self.last)
        return Strip(*ends, abs(time.scale) * self.step, rows)


class _StripKey(NamedTuple):
    """Key of a strip; it holds no data-blocks, since undo replaces them."""

    action: tuple[int, int, int]
    bones: tuple[str, ...]
    checked: str
    n_issues: int
    time: PlayedTime


_actions: dict[tuple[int, int, int], ActionKeys | None] = {}
_strips: dict[_StripKey, Strip | None] = {}
_contacts: dict[tuple[int, int, int], tuple[Array, ...]] = {}


def forget() -> None:
    """Clear the caches, so that the next drawing reads again."""
    _actions.clear()
    _strips.clear()
    _contacts.clear()


def strip_of(context: bpy.types.Context) -> Strip | None:
    """Return the strip of the active armature, or None where there is nothing to show.

    In Pose Mode, confidence and changed frames are those of the selected bones, if any are,
    and of all bones below them.
    """
    armature = context.view_layer.objects.active
    if armature is None or armature.type != "ARMATURE":
        return None
    source = reliability_source(armature)
    if source is None:
        return None
    shown = context.scene.mocap_assist
    is_checked = shown.checked_action == source[0]
    block = _block(armature, source)
    time = played_time(armature, context.scene.frame_current_final)
    bones = _selected_bones(armature)
    report, n_issues = (shown.report, len(shown.issues)) if is_checked else ("", 0)
    key = _StripKey(block, bones, report, n_issues, time)
    if key not in _strips:
        keys = _keys_of(block, armature, source)
        listed = shown.issues if is_checked else ()
        issues = [(each.start, each.stop, each.kind) for each in listed]
        _make_room(_strips)
        strip = None if keys is None else strip_from(keys, frozenset(bones), issues)
        _strips[key] = strip and strip.placed(time)
    return _strips[key]


def is_checked(context: bpy.types.Context) -> bool:
    """Return whether Check has listed the issues of what the active armature plays."""
    source = reliability_source(context.view_layer.objects.active)
    return source is not None and context.scene.mocap_assist.checked_action == source[0]


def contacts_of(armature: bpy.types.Object) -> tuple[Array, ...] | None:
    """Return the contact keys of an armature's action, as in `ActionKeys`, if it has any.

    Other keys are not read: a long action has many, and the 3D View would wait for them after
    each edit.
    """
    source = reliability_source(armature)
    if source is None:
        return None
    block = _block(armature, source)
    if block not in _contacts:
        _make_room(_contacts)
        _contacts[block] = tuple(contact_keys(*source))
    keys = _contacts[block]
    return keys if any(map(len, keys)) else None


def _block(armature: bpy.types.Object, source: Source) -> tuple[int, int, int]:
    return armature.session_uid, source[0].session_uid, source[1].handle


def _keys_of(
    block: tuple[int, int, int], armature: bpy.types.Object, source: Source
) -> ActionKeys | None:
    if block not in _actions:
        _make_room(_actions)
        try:
            _actions[block] = read_action(armature, source)
        except InvalidMotionError:
            _actions[block] = None
    return _actions[block]


def _make_room(store: dict[Any, Any]) -> None:
    """Drop the oldest entries."""
    while len(store) >= MAX_CACHED:
        del store[next(iter(store))]


def _selected_bones(armature: bpy.types.Object) -> tuple[str, ...]:
    """Return the bones that are selected in Pose Mode, and those below them.

    None where these are all bones, or no bone is selected.
    """
    if armature.mode != "POSE":
        return ()
    names: dict[str, None] = {}  # an ordered set; parents come before their children
    for bone in armature.pose.bones:
        parent = bone.parent
        if compat.is_selected(bone) or (parent is not None and parent.name in names):
            names[bone.name] = None
    return () if len(names) == len(armature.pose.bones) else tuple(names)


def strip_from(
    keys: ActionKeys, bones: frozenset[str], issues: Iterable[tuple[float, float, str]]
) -> Strip | None:
    """Compute the rows that have a range, for some bones, or for all if there are none."""
    rows: dict[StripRow, tuple[Range, ...]] = {
        StripRow.CONFIDENCE: _confidence(keys, bones),
        **issue_ranges(issues),
        StripRow.FILLED: ranges_of(_frames(keys.filled, bones), keys.step, Mark.FILLED),
        StripRow.CORRECTED: ranges_of(
            _frames(keys.corrected, bones), keys.step, Mark.CORRECTED
        ),
    }
    for (row, mark), part in zip(CONTACT_ROWS, keys.contacts, strict=True):
        rows[row] = contact_ranges(part, keys.last, keys.step, mark)
    found = {row: ranges for row, ranges in rows.items() if ranges}
    return Strip(keys.first, keys.last, keys.step, found) if found else None


def _values_of_bones(by_bone: Mapping[str, Array], bones: frozenset[str]) -> list[Array]:
    return [each for bone, each in by_bone.items() if not bones or bone in bones]


def _frames(by_bone: Mapping[str, Array], bones: frozenset[str]) -> Array:
    return np.concatenate([np.empty(0), *_values_of_bones(by_bone, bones)])


def _confidence(keys: ActionKeys, bones: frozenset[str]) -> tuple[Range, ...]:
    chosen = _values_of_bones(keys.confidence, bones)
    if not chosen:
        return ()
    frames = np.arange(keys.first, keys.last + 0.5 * keys.step, keys.step)
    lowest = np.min([np.interp(frames, *each.T) for each in chosen], axis=0)
    return confidence_ranges(lowest, frames, keys.step)


def read_action(armature: bpy.types.Object, source: Source) -> ActionKeys | None:
    """Read the keys of an action and of the recording that it was made from.

    All channels of one property are keyed together, so the first one speaks for all.
    """
    names = [bone.name for bone in armature.pose.bones]
    moves = {bone_path(name, channel): name for name in names for channel in CHANNELS}
    ratings = {reliability_path(name): name for name in names}
    recorded = _first_curves(history.raw_of(*source), moves)
    played = _first_curves(source, moves | ratings)
    filled: dict[str, list[Array]] = {}
    corrected: dict[str, list[Array]] = {}
    for path, curve in played.items():
        if path not in moves:
            continue
        generated = Channel(curve).keys[types_of(curve) == GENERATED, 0]
        if len(generated):
            known = _is_keyed(generated, recorded.get(path))
            filled.setdefault(moves[path], []).append(generated[~known])
            corrected.setdefault(moves[path], []).append(generated[known])
    longest = max(played.values(), key=lambda each: len(each.keyframe_points), default=None)
    if longest is None or not len(longest.keyframe_points):
        return None
    times = Channel(longest).keys[:, 0]
    return ActionKeys(
        first=float(times[0]),
        last=float(times[-1]),
        step=float(np.median(np.diff(times))) if len(times) > 1 else 1.0,
        filled={bone: np.concatenate(each) for bone, each in filled.items()},
        corrected={bone: np.concatenate(each) for bone, each in corrected.items()},
        confidence={
            ratings[path]: Channel(curve).keys
            for path, curve in played.items()
            if path in ratings and len(curve.keyframe_points)
        },
        contacts=tuple(contact_keys(*source)),
    )


def _first_curves(source: Source | None, paths: Iterable[str]) -> dict[str, bpy.types.FCurve]:
    """Return the first F-Curve of each of these data paths that is not muted."""
    bag = None if source is None else compat.channelbag(*source)
    found: dict[str, bpy.types.FCurve] = {}
    for curve in () if bag is None else bag.fcurves:
        path = curve.data_path
        if path in paths and path not in found and Channel(curve).is_on:
            found[path] = curve
    return found


def _is_keyed(frames: Array, curve: bpy.types.FCurve | None) -> Flags:
    """Return which of the frames have a key, shape (n_frames,); none without a curve."""
    if curve is None:
        return np.zeros(len(frames), bool)
    times = Channel(curve).keys[:, 0].round(KEY_DECIMALS)
    return np.asarray(np.isin(frames.round(KEY_DECIMALS), times))
