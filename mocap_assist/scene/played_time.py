"""Scene frames of a result that is played on an NLA strip, which may be moved or scaled."""

from math import ceil, floor, inf
from typing import NamedTuple

import bpy

from .history import playing_strips, result_player


class PlayedTime(NamedTuple):
    """Line from the frames of an action to those of the scene, and the part that is played."""

    start: float = 0.0
    """Scene frame of frame 0 of the action."""
    scale: float = 1.0
    """Scene frames from one frame of the action to the next; negative in a reversed strip."""
    first: float = -inf
    """First and last frame of the action that are played."""
    last: float = inf
    n_repeats: float = 1.0

    @property
    def begin(self) -> float:
        """Return the scene frame from which it is played."""
        return self.scene_range(self.first, self.last)[0]

    def scene_frame(self, frame: float) -> float:
        """Return the scene frame of a frame of the action, in a repeated strip the first."""
        return self.start + self.scale * frame

    def scene_range(self, first: float, last: float) -> tuple[float, float]:
        """Return the first and the last scene frame of a range of the action."""
        low, high = sorted((self.scene_frame(first), self.scene_frame(last)))
        return low, high

    def action_range(self, first: float, last: float) -> tuple[float, float]:
        """Return the range of the action on a range of the scene, also beyond the strip."""
        low, high = sorted((each - self.start) / self.scale for each in (first, last))
        return low, high

    def action_frame(self, frame: float) -> float:
        """Return the frame of the action that is played at a scene frame.

        Before and after a strip it is that of the strip's nearer end.
        """
        found = (self._in_first_pass(frame) - self.start) / self.scale
        return min(max(found, self.first), self.last)

    def _in_first_pass(self, frame: float) -> float:
        """Return the scene frame in the first pass of a repeated strip, as Blender plays it."""
        if self.n_repeats == 1.0:
            return frame
        begin, end = self.scene_range(self.first, self.last)
        n_passed = min((frame - begin) / (end - begin), self.n_repeats)
        n_complete = min(floor(n_passed), ceil(self.n_repeats) - 1)
        return begin + (end - begin) * (n_passed - max(n_complete, 0))


def played_time(player: bpy.types.Object, frame: float = -inf) -> PlayedTime:
    """Return when an armature or a marker plays its result; by default at its own frames.

    Where several strips play it, that is the time of the one that plays at this scene frame, or
    of the first.
    """
    times = played_times(player)
    return next((each for each in reversed(times) if each.begin <= frame), times[0])


def played_times(player: bpy.types.Object) -> tuple[PlayedTime, ...]:
    """Return the times of the strips that play the result, from first to last.

    A strip whose time is animated counts as one that is not. An assigned action has its own
    frames.
    """
    return tuple(map(_time_of_strip, played_strips(player))) or (PlayedTime(),)


def played_strips(player: bpy.types.Object) -> tuple[bpy.types.NlaStrip, ...]:
    """Return the strips of a track that play the result, from first to last.

    In Tweak Mode it is the tweaked strip, whatever that plays; none play an assigned action.
    """
    animation = player.animation_data
    found = result_player(player)
    if animation is not None and animation.use_tweak_mode and found in {None, animation}:
        found = _tweaked_strip(animation)
        return () if found is None else (found,)
    if not isinstance(found, bpy.types.NlaStrip):
        return ()
    tracks = (each.strips.values() for each in animation.nla_tracks)
    track = next(strips for strips in tracks if found in strips)
    return tuple(each for each in track if each.action == found.action and not each.mute)


def _tweaked_strip(animation: bpy.types.AnimData) -> bpy.types.NlaStrip | None:
    """Return the strip whose action is assigned in Tweak Mode."""
    same = (each for each in playing_strips(animation) if each.action == animation.action)
    return max(same, key=lambda each: each.active, default=None)


def _time_of_strip(strip: bpy.types.NlaStrip) -> PlayedTime:
    first, last = strip.action_frame_start, strip.action_frame_end
    if not first < last:
        return PlayedTime(strip.frame_start - first, 1.0, first, last)
    scale = strip.scale
    if strip.use_reverse:
        return PlayedTime(strip.frame_start + scale * last, -scale, first, last, strip.repeat)
    return PlayedTime(strip.frame_start - scale * first, scale, first, last, strip.repeat)
