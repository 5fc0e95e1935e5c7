"""Reconstruct clean poses while an actor moves, one frame after another."""

from collections import deque
from collections.abc import Sequence
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..motion import JointRecording, Tracks
from ..motion.humanoid import (
    ADULT_BONE_LENGTHS_M,
    PostureNormalizer,
    posture_positions,
)
from ..progress import unwatched
from ..signals import CausalSmoother
from .complete_take import (
    POSITION_SMOOTHING_S,
    CompletedTake,
    blend_rebuilt,
    replacement_weights,
)
from .joint_rotations import LimbTwists, find_anchors, positions_from_postures
from .live_actor import LiveActor, reliability_settings
from .pose_completion import (
    CompletedJoints,
    ObservedTake,
    ResidualFilter,
    complete_from_fitted,
)
from .reconstruct import correction_settings, posture_settings
from .reliability import Reliability, measure_reliability, memory_frames, posture_reliability
from .residual_correction import (
    SmoothedPostures,
    TrajectoryFilter,
    assemble_correction,
    subtract_offsets,
)

Scalar = TypeVar("Scalar", bound=np.generic)


class ObservedFrame(NamedTuple):
    """One frame of a sensor.

    Attributes
    ----------
    positions : shape (n_joints, 3), meters
        NaN: missing.
    tracking_state : shape (n_joints,), optional
        As in `JointRecording`.
    confidence : shape (n_joints,), 0 to 1, optional
    """

    positions: Array
    tracking_state: NDArray[np.int8] | None = None
    confidence: Array | None = None


class LivePose(NamedTuple):
    """The reconstructed pose of one frame.

    Attributes
    ----------
    positions : shape (n_joints, 3), meters
    confidence : shape (n_joints,), 0 to 1
    reliability : shape (n_joints,), 0 to 1
        Of the observed joints.
    twists : LimbTwists, optional
        Axial rotations of upper arms and thighs from the library.
    """

    positions: Array
    confidence: Array
    reliability: Array
    twists: LimbTwists | None


class LiveReconstructor:
    """`reconstruct` with the setting `causal`, one frame after another.

    Each frame takes some milliseconds, whatever came before. Results are those of `reconstruct`
    for a take with the same actor, except for joints that are not observed in the first frame.

    Parameters
    ----------
    actor : LiveActor
        From `measure_actor`.
    """

    def __init__(self, actor: LiveActor) -> None:
        self._actor = actor
        rate, settings = actor.frame_rate, actor.settings
        self._completion = posture_settings(settings)
        self._correction = correction_settings(settings, actor.is_known_sensor)
        self._reliability = reliability_settings(settings)
        self._frames: deque[ObservedFrame] = deque(
            maxlen=memory_frames(rate, self._reliability)
        )
        self._last_observed = np.full((len(actor.names), 3), np.nan)
        self._path = CausalSmoother(POSITION_SMOOTHING_S * rate)
        self._observed_heading = PostureNormalizer(rate)
        self._residuals = ResidualFilter(
            1.0 / rate, actor.library.errors.size, self._completion.memory
        )
        self._smooth_path = CausalSmoother(float(actor.prior.smoothing) * rate)
        self._smooth_heading = PostureNormalizer(rate)
        self._trajectories = TrajectoryFilter(settings.smoothing * rate)

    def update(self, observed: ObservedFrame) -> LivePose:
        """Return the pose of the next frame.

        Parameters
        ----------
        observed : ObservedFrame
            One frame period after the last one. A frame that was dropped is all NaN.
        """
        self._frames.append(observed)
        frames = self._recording()
        measured = measure_reliability(
            frames, settings=self._reliability, reference=self._actor.segment_lengths
        )
        frame = frames.slice(frames.n_frames - 1, frames.n_frames)
        reliability = measured.combined[-1:]
        rebuilt = self._complete(frame, reliability)
        distance = self._distance_from_path(frame, rebuilt.tracks.positions)
        replacement = replacement_weights(frame.tracks.visible, reliability, distance)
        completed = blend_rebuilt(frame, rebuilt, reliability, replacement)
        positions, confidence = self._correct(completed)
        return LivePose(
            positions[0],
            np.minimum(confidence, completed.confidence)[0],
            reliability[0],
            rebuilt.twists,
        )

    def _recording(self) -> JointRecording:
        """Return the frames in memory as a recording."""
        actor, frames = self._actor, self._frames
        confidence = _stack([frame.confidence for frame in frames])
        positions = np.stack([frame.positions for frame in frames])
        tracks = Tracks(actor.names, positions, actor.frame_rate, confidence)
        states = _stack([frame.tracking_state for frame in frames])
        return JointRecording(tracks, states, actor.sensor)

    def _complete(self, frame: JointRecording, reliability: Array) -> CompletedJoints:
        """Complete unreliable and missing joints as `complete_joints` does."""
        actor, positions = self._actor, posture_positions(frame)
        weights = np.where(
            np.isfinite(positions).all(axis=-1), posture_reliability(frame, reliability), 0.0
        )
        body = self._observed_heading.update(positions, weights)
        take = ObservedTake(body.postures, weights, actor.frame_rate, actor.bone_lengths)
        completed = complete_from_fitted(
            take, actor.library, self._completion, self._residuals, unwatched
        )
        tracks = frame.tracks
        joints = positions_from_postures(
            tracks.names,
            tracks.positions,
            reliability,
            positions,
            body.to_world(completed.postures),
            actor.observed_offsets,
        )
        anchors = find_anchors(tracks.names)
        return CompletedJoints(
            tracks.with_positions(joints), completed.confidence[:, anchors],
            completed.deviation[:, anchors], completed.method, completed.twists,
            actor.bone_lengths, actor.library, actor.observed_offsets,
        )  # fmt: skip

    def _distance_from_path(self, frame: JointRecording, rebuilt: Array) -> Array:
        """Return the distance of rebuilt joints from the smoothed path, (1, n_joints), meters.

        0 for joints that were not observed yet.
        """
        visible = frame.tracks.visible[0][:, None]
        self._last_observed = np.where(visible, frame.tracks.positions[0], self._last_observed)
        smooth = self._path.update(self._last_observed)
        distance: Array = np.linalg.norm(rebuilt - smooth, axis=-1)
        return np.nan_to_num(distance)

    def _correct(self, completed: CompletedTake) -> tuple[Array, Array]:
        """Subtract the sensor's errors and smooth, as `correct_postures` does."""
        actor, recording = self._actor, completed.recording
        weights = posture_reliability(recording, completed.reliability)
        smooth = self._smooth_path.update(posture_positions(recording)[0])[None]
        normalized = self._smooth_heading.update(smooth, weights)
        features = normalized.postures * ADULT_BONE_LENGTHS_M.sum() / actor.size
        inputs = SmoothedPostures(smooth, normalized, features, actor.frame_rate)
        corrected = subtract_offsets(
            inputs,
            actor.prior.predict(inputs, causal=True),
            actor.sensor_offsets,
            weights,
            actor.prior,
            self._correction,
            self._trajectories.update,
        )
        terms = Reliability(*[completed.reliability] * 4)
        result = assemble_correction(
            recording,
            actor.prior,
            terms,
            corrected,
            joint_offsets=actor.corrected_offsets,
            level=actor.variance_level,
        )
        return result.tracks.positions, result.confidence


def _stack(values: Sequence[NDArray[Scalar] | None]) -> NDArray[Scalar] | None:
    """Return the values of several frames, or None if a frame has none."""
    known = [value for value in values if value is not None]
    return np.stack(known) if len(known) == len(values) else None
