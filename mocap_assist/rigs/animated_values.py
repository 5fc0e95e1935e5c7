"""Values that actions animate, kept as they are while other frames and actions are played."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

import bpy

from ..actions.bone_channels import animated_curves
from ..blender.compat import Source


@contextmanager
def values_kept(animated: bpy.types.Object, *more: Source) -> Iterator[None]:
    """Put back, at the end, what an object's animation has changed since the start.

    These are the values that the action, the NLA strips, or one of `more` have keys for: what
    was posed without a key, too, and what only the other action keys, which would otherwise
    stay as that has left it. The caller brings frame and action back.

    Parameters
    ----------
    animated : bpy.types.Object
    more : actions, each with the slot that will be played
    """
    kept = [_Value.of(animated, path) for path in _paths(animated, more)]
    try:
        yield
    finally:
        for value in kept:
            value.put_back(animated)
        animated.update_tag(refresh={"OBJECT", "DATA"})
        bpy.context.view_layer.update()


def _paths(animated: bpy.types.Object, more: Iterable[Source]) -> set[str]:
    """Return the data paths of all that is animated, or will be."""
    animation = animated.animation_data
    strips = [strip for track in animation.nla_tracks for strip in track.strips]
    played = [(each.action, each.action_slot) for each in (animation, *strips)]
    return {
        path
        for action, slot in (*played, *more)
        if action is not None and slot is not None
        for path, _ in animated_curves(action, slot)
    }


class _Value(NamedTuple):
    """Value of one of Blender's own properties, or of a custom one."""

    owner: str
    """Data path of what has the property; nothing for the object itself."""
    name: str
    is_custom: bool
    held: Any
    """None where there is nothing that keys change."""

    @classmethod
    def of(cls, animated: bpy.types.Object, path: str) -> "_Value":
        is_custom = path.endswith('"]')
        owner, _, name = path.removesuffix('"]').rpartition('["' if is_custom else ".")
        name = bpy.utils.unescape_identifier(name)
        try:
            holder = _holder(animated, owner)
            held = holder[name] if is_custom else getattr(holder, name)
        except (ValueError, KeyError, AttributeError):
            held = None
        return cls(owner, name, is_custom, _animatable_value(held))

    def put_back(self, animated: bpy.types.Object) -> None:
        if self.held is None:
            return
        holder = _holder(animated, self.owner)
        if self.is_custom:
            holder[self.name] = self.held
        else:
            setattr(holder, self.name, self.held)


def _animatable_value(held: Any) -> Any:
    """Return a number, a choice or a tuple of numbers; None for all that no keys change.

    A file may have curves of anything: groups of properties and pointers to data stay.
    """
    if isinstance(held, (bool, int, float, str)):
        return held
    is_array = hasattr(held, "__len__") and not hasattr(held, "keys")
    values = tuple(held) if is_array else ()
    is_numeric = all(isinstance(value, (bool, int, float)) for value in values)
    return values if values and is_numeric else None


def _holder(animated: bpy.types.Object, owner: str) -> Any:
    return animated.path_resolve(owner) if owner else animated
