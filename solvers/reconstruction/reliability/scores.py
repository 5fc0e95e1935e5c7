"""Reliability of each tracked joint [SHJT13, section IV]."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...motion import JointRecording
from ...motion.humanoid import N_JOINTS, POSTURE_JOINTS, posture_joint_indices
from ...progress import Progress, unwatched
from .error_model import (
    CAUSAL_MODEL,
    CENTERED_MODEL,
    DEVIATION_WINDOW_S,
    measure_error_indicators,
)
from .reference import find_reference_postures, parent_distances, reference_lengths
from .settings import (
    DEFAULT_SETTINGS,
    SENSOR_RATE_HZ,
    ReliabilityMethod,
    ReliabilitySettings,
)
from .terms import (
    behavior_term,
    frame_count,
    gaussian_mean,
    is_tracked,
    kinematics_term,
    tracking_term,
)


@dataclass(frozen=True, eq=False)
class Reliability:
    """Reliability of each joint at each frame, 0 to 1, and its terms.

    Attributes
    ----------
    combined, behavior, kinematics, tracking : shape (n_frames, n_joints)
        The last three are the terms of [SHJT13], eq. 4, 6 and 7; a term without data in
        the recording is 1.
    """

    combined: NDArray[np.float64]
    behavior: NDArray[np.float64]
    kinematics: NDArray[np.float64]
    tracking: NDArray[np.float64]

    @property
    def behaviour(self) -> NDArray[np.float64]:
        """`behavior`, by the name of the interface's first version."""
        return self.behavior


def measure_reliability(
    recording: JointRecording,
    *,
    settings: ReliabilitySettings = DEFAULT_SETTINGS,
    reference: Array | None = None,
    progress: Progress = unwatched,
) -> Reliability:
    """Measure the reliability of each joint of a depth camera's recording.

    Parameters
    ----------
    recording : JointRecording
        Any joints; NaN where not tracked.
    settings : ReliabilitySettings
    reference : shape (n_joints,), meters, optional
        Length of the segment above each joint; measured in the recording by default
        (`expected_lengths`).
    progress : Progress

    Returns
    -------
    Reliability
        For the joints of the recording, in their order. A joint that is NaN has 0 everywhere.

    Raises
    ------
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [SHJT13] Shum, Ho, Jiang, Takagi (2013). Real-time posture reconstruction for Microsoft
       Kinect. IEEE Transactions on Cybernetics 43(5). doi:10.1109/TCYB.2013.2275945
    """
    positions, parents = recording.tracks.positions, np.array(recording.parents)
    visible = recording.tracks.visible
    behavior = behavior_term(positions, recording.frame_rate, settings)
    tracking = tracking_term(recording, settings)
    progress(0.4, "Measuring reliability")
    lengths = parent_distances(positions, parents)
    if reference is None:
        reference = _reference_of(recording, lengths, behavior)
    kinematics = kinematics_term(lengths, reference, parents)
    behavior, kinematics, tracking = (
        np.where(visible, term, 0.0) for term in (behavior, kinematics, tracking)
    )
    rate = recording.frame_rate
    if settings.method is ReliabilityMethod.PUBLISHED:
        worst = np.minimum(np.minimum(behavior, kinematics), tracking)
        combined = gaussian_mean(worst, rate, settings)
    else:
        signs = measure_error_indicators(
            positions, lengths - reference, parents, rate, settings.causal
        )
        model = CAUSAL_MODEL if settings.causal else CENTERED_MODEL
        within = model.probability_within(signs, settings.tolerance)
        combined = np.minimum(within, gaussian_mean(tracking, rate, settings))
    combined = np.where(visible, combined, 0.0)
    progress(1.0, "Measuring reliability")
    return Reliability(combined, behavior, kinematics, tracking)


def expected_lengths(recording: JointRecording, settings: ReliabilitySettings) -> Array:
    """Return the actor's length of the segment above each joint, shape (n_joints,), meters.

    NaN for roots, and where no frame shows both ends.
    """
    positions = recording.tracks.positions
    lengths = parent_distances(positions, np.array(recording.parents))
    behavior = behavior_term(positions, recording.frame_rate, settings)
    return _reference_of(recording, lengths, behavior)


def memory_frames(frame_rate: float, settings: ReliabilitySettings) -> int:
    """Return the number of frames that the causal reliability of a frame depends on."""
    step = frame_count(1.0 / SENSOR_RATE_HZ, frame_rate)
    windows = (settings.vibration_window, 2.0 * DEVIATION_WINDOW_S, settings.window)
    return 2 * step + max(frame_count(window, frame_rate) for window in windows) + 1


def _reference_of(recording: JointRecording, lengths: Array, behavior: Array) -> Array:
    """Return the expected lengths from those of each frame, where joints do not vibrate."""
    parents, tracked = np.array(recording.parents), is_tracked(recording)
    postures = find_reference_postures(recording.names, recording.tracks.positions, tracked)
    reliable = np.minimum(behavior, tracked)
    reliable = np.minimum(reliable, reliable[:, np.maximum(parents, 0)])
    return reference_lengths(lengths, postures, reliable)


def posture_reliability(
    recording: JointRecording, combined: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the reliability of the posture joints, (n_frames, 20); 0 where missing."""
    result = np.zeros((recording.n_frames, N_JOINTS))
    for role, index in posture_joint_indices(recording.names).items():
        result[:, POSTURE_JOINTS.index(role)] = combined[:, index]
    return result
