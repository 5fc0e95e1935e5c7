"""Blend observed joints with those of library poses, by reliability."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..arrays import Array, Flags
from ..motion import JointRecording, Tracks
from ..progress import Progress
from ..signals import fill_gaps, smooth_gaussian
from .pose_completion import CompletedJoints, PostureSettings, blend_gaps, complete_joints
from .pose_library import PostureLibrary
from .reliability import OBSERVED_RELIABILITY, REPLACED_RELIABILITY, WRONG_RELIABILITY

HALF_WEIGHT_M = 0.15
"""Distance (m) from the smoothed path at which the weight of the library pose is halved.
Sensors that err by more have a reliability near 0. Chosen by hand; `make sensitivity` varies
it."""
UNCERTAIN_RELIABILITY = 0.07
"""Reliability from which `HALF_WEIGHT_M` applies in full; at `WRONG_RELIABILITY` it has no
effect. On intact takes of UI-PRMD, joints of reliability 0.1 to 0.5 are 10 cm off, joints below
0.05 are 40 cm off. Sweep: x0.1 costs 4.2 %. It guards joints that are only uncertain:
`test_wrong_joint_is_replaced_and_an_uncertain_one_stays_near`."""
POSITION_SMOOTHING_S = 0.1
"""Standard deviation (s) of the Gaussian that smooths observed positions. Chosen by hand;
`make sensitivity` varies it."""


class CompletedTake(NamedTuple):
    """A recording whose unreliable and missing joints are from library poses."""

    recording: JointRecording
    rebuilt: CompletedJoints
    reliability: Array
    """Of the completed joints, shape (n_frames, n_joints)."""
    confidence: Array
    """Upper limit of the confidence of each joint, shape (n_frames, n_joints)."""


def complete_take(
    recording: JointRecording,
    postures: PostureLibrary | None,
    reliability: Array,
    settings: PostureSettings,
    progress: Progress,
) -> CompletedTake:
    """Replace unreliable and missing joints by those of library poses.

    `reliability` has the shape (n_frames, n_joints), 0 to 1.
    """
    rebuilt = complete_joints(recording, postures, reliability, settings, progress)
    tracks, causal = recording.tracks, settings.causal
    observed = tracks.visible.any(axis=0)
    smooth = fill_gaps(tracks.positions[:, observed], causal=causal)
    smooth = smooth_gaussian(smooth, POSITION_SMOOTHING_S * tracks.frame_rate, causal=causal)
    distance = np.zeros(reliability.shape)
    distance[:, observed] = np.linalg.norm(
        rebuilt.tracks.positions[:, observed] - smooth, axis=-1
    )
    replacement = replacement_weights(tracks.visible, reliability, distance)
    if not causal:
        used = tracks.visible & (replacement <= 0.0)
        bridged = blend_gaps(
            tracks.positions, used, rebuilt.tracks.positions, rebuilt.deviation,
            recording.frame_rate,
        )  # fmt: skip
        rebuilt = rebuilt._replace(tracks=rebuilt.tracks.with_positions(bridged))
    return blend_rebuilt(recording, rebuilt, reliability, replacement)


def blend_rebuilt(
    recording: JointRecording, rebuilt: CompletedJoints, reliability: Array, replacement: Array
) -> CompletedTake:
    """Blend observed joints and library poses by the weights of `replacement_weights`.

    `reliability` and `replacement` have the shape (n_frames, n_joints), 0 to 1.
    """
    return CompletedTake(
        replace(recording, tracks=_blend_tracks(recording.tracks, rebuilt.tracks, replacement)),
        rebuilt,
        np.maximum(reliability, replacement * rebuilt.confidence),
        np.maximum(1.0 - replacement, rebuilt.confidence),
    )


def replacement_weights(visible: Flags, reliability: Array, distance: Array) -> Array:
    """Return the weight of library poses, shape (n_frames, n_joints), 0 to 1.

    An observed joint of low reliability still indicates roughly where the joint is. A library
    pose far from that position gets a low weight; `distance`, in meters, is that from the
    smoothed path of the joint.
    """
    replacement = np.clip(
        (OBSERVED_RELIABILITY - reliability) / (OBSERVED_RELIABILITY - REPLACED_RELIABILITY),
        0.0,
        1.0,
    )
    closeness = 1.0 / (1.0 + (distance / HALF_WEIGHT_M) ** 4)
    certainty = np.clip(
        (reliability - WRONG_RELIABILITY) / (UNCERTAIN_RELIABILITY - WRONG_RELIABILITY),
        0.0,
        1.0,
    )
    return np.where(
        visible, replacement * (1.0 - certainty + certainty * closeness), replacement
    )


def _blend_tracks(tracks: Tracks, rebuilt: Tracks, replacement: Array) -> Tracks:
    """Blend observed and library positions; missing joints are taken from the library."""
    weight = np.where(tracks.visible, replacement, 1.0)[..., None]
    completed = np.where(tracks.visible[..., None], tracks.positions, 0.0)
    return tracks.with_positions(weight * rebuilt.positions + (1.0 - weight) * completed)
