"""Checks that a tracked armature's channels describe its visible pose."""

from collections.abc import Mapping

import bpy
import numpy as np

from ....solvers.depth_tracking.body import SEGMENTS, motion_frames, scene_from_camera
from ....solvers.errors import InvalidMotionError
from ....solvers.motion import Motion
from ...actions.bone_channels import Curves, location_curves, rotation_curves
from ...actions.curves import Channel
from ...actions.rotation_modes import rotation_property
from ...blender.compat import Source
from ...scene.history import playing_strips, source_of
from .body import REST_TOLERANCE_M, TrackedBody, armature_from_motion, bones_of, posed_frames

MAX_STRIP_OFFSET = 0.05
"""Frames by which a strip may shift an action. It guards strips that move the action off the
depth images."""
MAX_NAMED = 3
"""Bones that a message names."""


def check_in_time(armature: bpy.types.Object, source: Source) -> None:
    """Raise InvalidMotionError if an NLA strip shifts or stretches the action."""
    action, animation = source[0], armature.animation_data
    if animation.action == action:
        return
    strip = next(each for each in playing_strips(animation) if source_of(each) == source)
    action_range = strip.action_frame_start, strip.action_frame_end
    start_shift = strip.frame_start - action_range[0]
    stretch = (strip.scale - 1.0) * (action_range[1] - action_range[0])
    retimed = strip.use_reverse or strip.use_animated_time
    if retimed or max(abs(start_shift), abs(start_shift + stretch)) > MAX_STRIP_OFFSET:
        raise InvalidMotionError(
            f"The NLA strip of {action.name} does not match its frames, {action_range[0]:g} to"
            f" {action_range[1]:g}. Move the strip back, or assign the action itself."
        )


def check_keyed(armature: bpy.types.Object, curves: Curves) -> None:
    """Raise InvalidMotionError if these curves lack the channels of the motion."""
    names = bones_of(armature)
    bones = [armature.pose.bones[names[segment]] for segment in SEGMENTS]
    unkeyed = [
        bone.name
        for bone in bones
        if _n_keyed(rotation_curves(bone, curves)) < rotation_property(bone.rotation_mode)[1]
    ]
    if unkeyed:
        more = f" and {len(unkeyed) - MAX_NAMED} more" * (len(unkeyed) > MAX_NAMED)
        raise InvalidMotionError(
            f"Rotation channels of {', '.join(unkeyed[:MAX_NAMED])}{more} of {armature.name}"
            " have no keys or are muted. Unmute them, or restore the rotation mode with keys."
        )
    if _n_keyed(location_curves(bones[0], curves)) < 3:
        raise InvalidMotionError(
            f"Location channels of {bones[0].name} of {armature.name} have no keys or are"
            " muted. Unmute them, or key the location."
        )


def _n_keyed(channels: Mapping[int, Channel]) -> int:
    return sum(len(channel.curve.keyframe_points) > 0 for channel in channels.values())


def check_posed(armature: bpy.types.Object, tracked: TrackedBody, pose: Motion) -> None:
    """Raise InvalidMotionError if bones are not where the channels of the pose place them.

    Parameters
    ----------
    armature : an armature that Track has created
    tracked : its stored body
    pose : one frame, read from the rotations of its bones and the position of its hips
    """
    if armature.data.pose_position == "REST":
        raise InvalidMotionError(
            f"{armature.name} shows its rest pose. Set its data to Pose Position."
        )
    to_armature = armature_from_motion(armature, tracked.body)
    frames = motion_frames(tracked.body, pose)[0]
    read = to_armature @ scene_from_camera(None) @ frames
    off = np.abs(posed_frames(armature, tracked.body) - read).max(axis=(1, 2))
    misplaced = off > REST_TOLERANCE_M * np.cbrt(np.linalg.det(to_armature[:3, :3]))
    if misplaced.any():
        bone = bones_of(armature)[SEGMENTS[int(np.argmax(misplaced))]]
        raise InvalidMotionError(
            f"{bone} of {armature.name} is not where its rotations place it."
            " Clear its location (Alt G) and scale (Alt S). For a constraint, apply the visual"
            " transform (Ctrl A), then remove it."
        )
