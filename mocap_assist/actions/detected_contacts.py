"""Which contact keys are as they were detected, and which ones the animator has edited."""

import hashlib
from collections.abc import Mapping, Sequence
from typing import Any

import bpy
import numpy as np

from ...solvers.arrays import Array, Flags
from ..blender import compat
from ..blender.stored_json import load_json, store_json

DETECTED = "mocap_assist_detected_contacts"
"""Property of an action: for the handle of each slot the detected contacts, and the frames of
the first and the last key of all else. Actions of earlier versions have a digest of all
contact keys, and all contacts are the animator's if a key has changed since."""
RANGE = "range"
FEET, OTHERS = slice(2), slice(2, None)
"""The keys of both feet come first."""
DECIMALS = 2
"""Decimals of a frame that are no rounding: keys are 32-bit numbers. By definition."""


def find_detected(
    action: bpy.types.Action, slot: bpy.types.ActionSlot, keys: Mapping[str, Array]
) -> dict[str, Flags]:
    """Return which keys begin a contact, or a time without one, as it was detected, (n_keys,).

    It begins and ends at the same frames as then. If all keys of the action were moved, so were
    the frames; if its begin or end was deleted, the contacts that are left still count. Keys
    have the shape (n_keys, 2), by the name of their property.
    """
    if isinstance(action.get(DETECTED), str) and action[DETECTED] == _digest([*keys.values()]):
        return {name: np.ones(len(each), np.bool_) for name, each in keys.items()}
    stored = load_json(action, DETECTED, dict).get(str(slot.handle))
    stored = stored if isinstance(stored, dict) else {}
    then = {name: _rows(stored.get(name), 3) for name in keys}
    shifts = [0.0]
    if (limits := _rows([stored.get(RANGE)], 2)) and (now := _key_range(action, slot, keys)):
        shifts += [now[0] - limits[0][0], now[1] - limits[0][1]]
    found = [
        {name: _matches(keys[name], then[name], shift) for name in keys} for shift in shifts
    ]
    return max(found, key=lambda each: sum(flags.sum() for flags in each.values()))


def store_detected(
    action: bpy.types.Action,
    slot: bpy.types.ActionSlot,
    keys: Mapping[str, Array],
    detected: Mapping[str, Flags],
) -> None:
    """Note which keys begin a contact, or a time without one, that was detected."""
    contacts: dict[str, Any] = {
        name: _segments(keys[name])[detected[name]].tolist() for name in keys
    }
    if limits := _key_range(action, slot, keys):
        contacts[RANGE] = limits
    others = load_json(action, DETECTED, dict)
    store_json(action, DETECTED, {**others, str(slot.handle): contacts})


def _segments(keys: Array) -> Array:
    """Return start, stop and value of each key, (n_keys, 3); the last has no length."""
    stops = np.append(keys[1:, 0], keys[-1:, 0])
    return np.column_stack([keys[:, 0], stops, keys[:, 1] > 0.5]).round(DECIMALS)


def _matches(keys: Array, stored: Sequence[Sequence[float]], shift: float) -> Flags:
    """Return which keys begin a stored segment, moved by `shift` frames, shape (n_keys,)."""
    moved = {
        (round(start + shift, DECIMALS), round(stop + shift, DECIMALS), float(value))
        for start, stop, value in stored
    }
    begins = {(start, value) for start, _, value in moved}
    segments = [(start, stop, value) for start, stop, value in _segments(keys).tolist()]
    flags = [segment in moved for segment in segments]
    if segments:
        start, _, value = segments[-1]
        flags[-1] = (start, value) in begins  # What followed may have been deleted.
    return np.array(flags, dtype=np.bool_)


def _key_range(
    action: bpy.types.Action, slot: bpy.types.ActionSlot, contacts: Mapping[str, Array]
) -> list[float]:
    """Return the first and the last frame with a key that is no contact; nothing without."""
    bag = compat.channelbag(action, slot)
    paths = {f'["{name}"]' for name in contacts}
    ranges = [
        curve.range()
        for curve in (() if bag is None else bag.fcurves)
        if len(curve.keyframe_points) and curve.data_path not in paths
    ]
    return [min(r[0] for r in ranges), max(r[1] for r in ranges)] if ranges else []


def _rows(value: Any, width: int) -> list[list[float]]:
    """Return the rows of a stored list that have as many numbers; users may have edited it."""
    return [
        row
        for row in (value if isinstance(value, list) else [])
        if isinstance(row, list)
        and len(row) == width
        and all(isinstance(each, int | float) for each in row)
    ]


def _digest(keys: Sequence[Array]) -> str:
    """Return the digest of earlier versions of all contact keys, those of both feet first."""
    rows = [each.ravel().tolist() for each in keys]
    known = rows if rows[-1] else rows[:-1]  # Without hips it is as before they had keys,
    text = repr(known if any(rows[OTHERS]) else rows[FEET])  # and of feet alone, too.
    return hashlib.sha256(text.encode()).hexdigest()
