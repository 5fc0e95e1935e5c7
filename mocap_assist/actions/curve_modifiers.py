"""F-Curve modifiers, such as Noise, where keys that were read through them are written back."""

from collections.abc import Iterator
from typing import Any, NamedTuple

import bpy

LAST_FRAME = 1048574.0
"""Blender's MAXFRAME, frames."""
# Cycles repeats the keys before the first and after the last, and changes none of them.
HARMLESS = {"CYCLES"}


class Written(NamedTuple):
    """The frames that get new keys, and the kept keys next to them."""

    first: float
    last: float
    key_before: float | None
    """None where no key is kept on that side."""
    key_after: float | None


def act_on_keys(curve: bpy.types.FCurve) -> bool:
    """Whether modifiers change the keyed values."""
    return any(_changes_curve(modifier) for modifier in curve.modifiers)


def keep_outside(curve: bpy.types.FCurve, written: Written) -> None:
    """Restrict the modifiers to the kept keys: the values of the new ones include their effect.

    Each ends at the last kept key before the new ones, and begins again at the first after
    them; from there to the new keys its influence fades. Where no keys are kept it goes.
    """
    if not act_on_keys(curve):
        return
    stack = [(modifier.type, _settings(modifier)) for modifier in curve.modifiers]
    for modifier in reversed(curve.modifiers):
        curve.modifiers.remove(modifier)
    for kind, settings in stack:
        if kind in HARMLESS or settings["mute"]:
            _add(curve, kind, settings)
            continue
        sections = _steps if kind == "STEPPED" else _sections
        for section in sections(settings, written):
            _add(curve, kind, settings | section)


def _changes_curve(modifier: bpy.types.FModifier) -> bool:
    return modifier.type not in HARMLESS and not modifier.mute


def _sections(settings: dict[str, Any], written: Written) -> Iterator[dict[str, Any]]:
    """Restrict a modifier to the frames before, and to those after the new keys."""
    limited = settings["use_restricted_range"]
    start, stop = -LAST_FRAME, LAST_FRAME
    if limited:
        start, stop = settings["frame_start"], settings["frame_end"]
    if written.key_before is not None and start < written.first:
        section = {"use_restricted_range": True, "frame_start": start, "frame_end": stop}
        if stop > written.key_before:
            fade = written.first - written.key_before
            section |= {"frame_end": written.first, "blend_out": fade}
        yield section
    if written.key_after is not None and stop > written.last:
        section = {"use_restricted_range": True, "frame_start": start, "frame_end": stop}
        if start < written.key_after:
            fade = written.key_after - written.last
            section |= {"frame_start": written.last, "blend_in": fade}
        yield section


def _steps(settings: dict[str, Any], written: Written) -> Iterator[dict[str, Any]]:
    """Restrict a Stepped modifier, which has a range of its own and no fade."""
    start = settings["frame_start"] if settings["use_frame_start"] else -LAST_FRAME
    stop = settings["frame_end"] if settings["use_frame_end"] else LAST_FRAME
    for low, high in (
        (start, min(stop, -LAST_FRAME if written.key_before is None else written.key_before)),
        (max(start, LAST_FRAME if written.key_after is None else written.key_after), stop),
    ):
        if low < high:
            yield {"use_frame_start": True, "frame_start": low,
                   "use_frame_end": True, "frame_end": high}  # fmt: skip


def _settings(modifier: bpy.types.FModifier) -> dict[str, Any]:
    """Return everything that can be set, in Blender's order: a degree before its factors."""
    names = [each.identifier for each in modifier.bl_rna.properties if not each.is_readonly]
    found = {name: getattr(modifier, name) for name in names}
    if "coefficients" in found:
        found["coefficients"] = found["coefficients"][:]
    if modifier.type == "ENVELOPE":
        found["control_points"] = [
            (each.frame, each.min, each.max) for each in modifier.control_points
        ]
    return found


def _add(curve: bpy.types.FCurve, kind: str, settings: dict[str, Any]) -> None:
    modifier = curve.modifiers.new(kind)
    settings = dict(settings)
    if points := settings.pop("control_points", ()):
        frames, *limits = zip(*points, strict=True)
        for frame in frames:
            modifier.control_points.add(frame)
        # Never point.min = ...: after that Blender takes the point for a modifier, reads the
        # memory behind it as the address of a curve, and now and then crashes.
        for name, values in zip(("min", "max"), limits, strict=True):
            modifier.control_points.foreach_set(name, values)
    modifier.frame_start = -LAST_FRAME  # Blender keeps the start before the end at every step
    for name in ("frame_end", "frame_start"):
        setattr(modifier, name, settings.pop(name))
    for name, value in settings.items():
        setattr(modifier, name, value)
