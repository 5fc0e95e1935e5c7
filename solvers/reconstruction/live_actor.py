"""What a live reconstruction knows of its actor, measured in the first seconds."""

from dataclasses import dataclass, replace

from ..arrays import Array
from ..errors import InvalidMotionError
from ..motion import JointRecording, Sensor
from ..motion.humanoid import estimate_bone_lengths, posture_positions
from ..progress import Progress, unwatched, within
from .complete_take import complete_take
from .joint_rotations import JointOffsets, measure_joint_offsets
from .pose_completion import FittedLibrary
from .pose_library import PostureLibrary
from .reconstruct import (
    DEFAULT_SETTINGS,
    ReconstructMethod,
    ReconstructSettings,
    correction_settings,
    posture_settings,
    shipped_residual_prior,
)
from .reliability import (
    ReliabilitySettings,
    expected_lengths,
    measure_reliability,
    posture_reliability,
)
from .residual_correction import (
    ResidualPrior,
    TakeOffsets,
    mean_log_variance,
    predict_postures,
    smooth_postures,
)


@dataclass(frozen=True, eq=False)
class LiveActor:
    """Body of an actor, and how a sensor sees it; see `measure_actor`.

    Attributes
    ----------
    names : tuple of str
        The joints of the sensor.
    sensor : Sensor
    frame_rate : float, hertz
    settings : ReconstructSettings
        Causal.
    segment_lengths : shape (n_joints,), meters
        Length of the segment above each joint.
    bone_lengths : shape (20,), meters
    library : FittedLibrary
        The library of poses, fitted to this body.
    prior : ResidualPrior
    sensor_offsets : TakeOffsets
    size : float, meters
        Sum of the bone lengths of the joints that the prior sees.
    variance_level : float
        Mean logarithm of the variances that the prior predicts.
    observed_offsets, corrected_offsets : JointOffsets
        Joints that are not posture joints, before and after the correction.
    """

    names: tuple[str, ...]
    sensor: Sensor
    frame_rate: float
    settings: ReconstructSettings
    segment_lengths: Array
    bone_lengths: Array
    library: FittedLibrary
    prior: ResidualPrior
    sensor_offsets: TakeOffsets
    size: float
    variance_level: float
    observed_offsets: JointOffsets
    corrected_offsets: JointOffsets

    @property
    def is_known_sensor(self) -> bool:
        """Whether the prior was learned from this sensor."""
        return self.sensor is Sensor.KINECT_V2


def measure_actor(
    recording: JointRecording,
    postures: PostureLibrary | None = None,
    *,
    settings: ReconstructSettings = DEFAULT_SETTINGS,
    progress: Progress = unwatched,
) -> LiveActor:
    """Measure the actor of the first seconds of a stream, for `LiveReconstructor`.

    Parameters
    ----------
    recording : JointRecording
        15 to 32 joints of a body, among them the hips; NaN where not tracked.
    postures : PostureLibrary, optional
        The shipped library by default.
    settings : ReconstructSettings
        Of `reconstruct`; its default method is used, causally.
    progress : Progress

    Returns
    -------
    LiveActor

    Raises
    ------
    InvalidMotionError
        The joint names do not describe a body, or almost no joint was observed.
    SolveCancelled
        Raised by `progress`.
    """
    settings = replace(settings, causal=True, method=ReconstructMethod.BOTH)
    prior, is_known_sensor = shipped_residual_prior(), recording.sensor is Sensor.KINECT_V2
    signs = reliability_settings(settings)
    lengths = expected_lengths(recording, signs)
    reliability = measure_reliability(recording, settings=signs, reference=lengths).combined
    completed = complete_take(
        recording, postures, reliability, posture_settings(settings), within(progress, 0.1, 0.8)
    )
    rebuilt, blended = completed.rebuilt, completed.recording
    weights = posture_reliability(blended, completed.reliability)
    corrected = predict_postures(
        blended, prior, weights, correction_settings(settings, is_known_sensor)
    )
    smooth = smooth_postures(blended, float(prior.smoothing), weights, causal=True)
    if rebuilt.library is None or corrected.offsets is None:
        raise InvalidMotionError("The actor was not recognized in these frames.")
    progress(1.0, "Measured the actor")
    return LiveActor(
        recording.names,
        recording.sensor,
        recording.frame_rate,
        settings,
        lengths,
        rebuilt.lengths,
        rebuilt.library,
        prior,
        corrected.offsets,
        float(estimate_bone_lengths(smooth.positions).sum()),
        mean_log_variance(corrected.variances),
        rebuilt.joint_offsets,
        measure_joint_offsets(
            recording.names,
            blended.tracks.positions,
            completed.reliability,
            posture_positions(blended),
            corrected.positions,
        ),
    )


def reliability_settings(settings: ReconstructSettings) -> ReliabilitySettings:
    """Return the settings of the reliability."""
    return ReliabilitySettings(causal=settings.causal, inferred=settings.inferred)
