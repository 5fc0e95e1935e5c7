"""What would let a tracked armature be read otherwise than it is seen; each with a sentence."""

from collections.abc import Mapping

import bpy
import numpy as np

from ...solvers.depth_tracking.body import SEGMENTS, motion_frames, scene_from_camera
from ...solvers.errors import InvalidMotionError
from ...solvers.motion import Motion
from ..actions.bone_channels import Curves, location_curves, rotation_curves
from ..actions.curves import Channel
from ..actions.rotation_modes import rotation_property
from ..blender.compat import Source
from ..scene.history import playing_strips
from .tracked_body import EVEN, TrackedBody, armature_from_motion, bones_of, posed_frames

IN_TIME = 0.05
"""Frames that a strip may play an action too late or too early."""
NAMED = 3
"""Bones that a sentence names."""


def check_in_time(armature: bpy.types.Object, source: Source) -> None:
    """Raise InvalidMotionError where an NLA strip plays an action at other frames."""
    action, animation = source[0], armature.animation_data
    if animation.action == action:
        return
    strip = next(each for each in playing_strips(animation) if each.action == action)
    own = strip.action_frame_start, strip.action_frame_end
    late = strip.frame_start - own[0]
    longer = (strip.scale - 1.0) * (own[1] - own[0])
    bent = strip.use_reverse or strip.use_animated_time
    if bent or max(abs(late), abs(late + longer)) > IN_TIME:
        raise InvalidMotionError(
            f"{action.name} plays at other frames on its NLA strip than its own,"
            f" {own[0]:g} to {own[1]:g}. Put the strip back there, or assign the action itself."
        )


def check_keyed(armature: bpy.types.Object, curves: Curves) -> None:
    """Raise InvalidMotionError where no motion could be read from these curves, or written."""
    names = bones_of(armature)
    bones = [armature.pose.bones[names[segment]] for segment in SEGMENTS]
    still = [
        bone.name
        for bone in bones
        if _n_keyed(rotation_curves(bone, curves)) < rotation_property(bone.rotation_mode)[1]
    ]
    if still:
        more = f" and {len(still) - NAMED} more" * (len(still) > NAMED)
        raise InvalidMotionError(
            f"Rotation channels of {', '.join(still[:NAMED])}{more} of {armature.name} have no"
            " keys or are muted. Unmute them, or set the mode back to the one that has keys."
        )
    if _n_keyed(location_curves(bones[0], curves)) < 3:
        raise InvalidMotionError(
            f"Location channels of {bones[0].name} of {armature.name} have no keys or are"
            " muted. Unmute them, or key the location."
        )


def _n_keyed(channels: Mapping[int, Channel]) -> int:
    return sum(len(channel.curve.keyframe_points) > 0 for channel in channels.values())


def check_posed(armature: bpy.types.Object, tracked: TrackedBody, pose: Motion) -> None:
    """Raise InvalidMotionError where bones are seen elsewhere than a pose of them says.

    Parameters
    ----------
    armature : an armature that Track has made
    tracked : what is kept with it
    pose : one frame, read from the turns of its bones and the place of its hips
    """
    if armature.data.pose_position == "REST":
        raise InvalidMotionError(
            f"{armature.name} shows its rest pose. Switch its data to Pose Position, and pose"
            " it there."
        )
    to_armature = armature_from_motion(armature, tracked.body)
    frames = motion_frames(tracked.body, pose)[0]
    read = to_armature @ scene_from_camera(None) @ frames
    off = np.abs(posed_frames(armature, tracked.body) - read).max(axis=(1, 2))
    elsewhere = off > EVEN * np.cbrt(np.linalg.det(to_armature[:3, :3]))
    if elsewhere.any():
        bone = bones_of(armature)[SEGMENTS[int(np.argmax(elsewhere))]]
        raise InvalidMotionError(
            f"{bone} of {armature.name} lies elsewhere than the turns of its bones put it."
            " Clear its location (Alt G) and scale (Alt S); of a constraint, apply the visual"
            " transform (Ctrl A), then remove it."
        )
