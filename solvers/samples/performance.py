"""Simulate an actor in front of a depth camera who makes known gestures at known times."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..errors import InvalidSettingError
from ..motion import SENSOR_JOINTS, JointRecording, Sensor, Tracks
from ..settings import Settings, setting

Position = tuple[float, float, float]

ARM_LENGTHS_M = (0.28, 0.25)
"""Lengths of upper arm and forearm."""
HAND_LENGTH_M = 0.09
SHOULDER_M = 0.18
"""Distance from the middle to each shoulder."""
BODY_POSITIONS = {  # meters from the hips to the actor's right, forward, up
    "HipCenter": (0.0, 0.0, 0.0), "Spine": (0.0, 0.0, 0.22), "ShoulderCenter": (0.0, 0.0, 0.48),
    "Head": (0.0, 0.0, 0.70),
    "ShoulderLeft": (-SHOULDER_M, 0.0, 0.44), "ShoulderRight": (SHOULDER_M, 0.0, 0.44),
    "HipLeft": (-0.09, 0.0, -0.06), "KneeLeft": (-0.09, 0.02, -0.46),
    "AnkleLeft": (-0.09, 0.0, -0.86), "FootLeft": (-0.09, 0.12, -0.92),
    "HipRight": (0.09, 0.0, -0.06), "KneeRight": (0.09, 0.02, -0.46),
    "AnkleRight": (0.09, 0.0, -0.86), "FootRight": (0.09, 0.12, -0.92),
}  # fmt: skip
HIPS_HEIGHT_M = 0.95
ELBOW_DIRECTION = np.array([0.3, 0.0, -1.0])
"""Direction of the right arm's elbow."""
OCCLUDED_CONFIDENCE = 0.1
"""Confidence of an occluded joint."""
OCCLUSION_S = (0.05, 0.2)
"""Minimum and maximum duration of an occlusion, seconds."""

REST: Position = (0.05, 0.05, -0.96)
HIGH: Position = (0.25, 0.15, 0.85)
WAVING: Position = (0.25, 0.4, 0.4)
CLAP_READY: Position = (0.3, 0.6, -0.4)
CLAPPED: Position = (-0.3, 0.7, -0.3)
NEAR: Position = (-0.05, 0.6, -0.3)
FAR: Position = (0.3, 0.6, -0.3)
ASIDE: Position = (0.7, 0.66, 0.0)
AHEAD: Position = (0.0, 0.96, 0.0)

# Time to get there (s), right wrist and left wrist from their shoulders, in arm lengths: to the
# outside, forward, up; None: the gesture is done once it is reached.
GESTURES: dict[str, tuple[tuple[float, Position, Position] | None, ...]] = {
    "rest": ((1.0, REST, REST),),
    "hand up": ((0.7, HIGH, REST), None, (1.2, HIGH, REST)),
    "left hand up": ((0.7, REST, HIGH), None, (1.2, REST, HIGH)),
    "wave right": (
        (0.5, WAVING, REST), (0.3, (0.05, 0.5, 0.4), REST), (0.35, (0.8, 0.35, 0.4), REST),
        None, (0.5, WAVING, REST),
    ),
    "wave left": (
        (0.5, WAVING, REST), (0.3, (0.4, 0.5, 0.4), REST), (0.35, (-0.45, 0.6, 0.4), REST),
        None, (0.5, WAVING, REST),
    ),
    "clap": (
        (0.5, CLAP_READY, CLAP_READY), (0.25, CLAPPED, CLAPPED), (0.1, CLAPPED, CLAPPED),
        (0.3, CLAP_READY, CLAP_READY), None, (0.6, REST, REST), (0.4, REST, REST),
    ),
    "zoom in": (
        (0.7, NEAR, NEAR), (1.0, NEAR, NEAR), (1.0, FAR, FAR), None, (0.3, FAR, FAR),
        (0.6, REST, REST),
    ),
    "zoom out": (
        (0.7, FAR, FAR), (1.0, FAR, FAR), (1.0, NEAR, NEAR), None, (0.3, NEAR, NEAR),
        (0.6, REST, REST),
    ),
    "turn": (
        (0.7, ASIDE, REST), (1.0, ASIDE, REST), (1.2, AHEAD, REST), None, (0.3, AHEAD, REST),
        (0.6, REST, REST),
    ),
}  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class PerformanceSettings(Settings):
    """Parameters of the simulated sensor."""

    frame_rate: float = setting(30.0, "Frames per second", unit="Hz", minimum=5.0, maximum=240)
    noise: float = setting(
        0.0, "Standard deviation of each coordinate", unit="m", minimum=0.0, maximum=0.2
    )
    hidden: float = setting(
        0.0, "Occlusions of each joint per second", minimum=0.0, maximum=10.0
    )
    dropped: float = setting(0.0, "Fraction of dropped frames", minimum=0.0, maximum=0.9)
    lateness: float = setting(
        0.0, "Standard deviation of the time stamps", unit="s", minimum=0.0, maximum=0.05
    )
    heading: float = setting(
        0.0, "Heading of the actor; 0 faces the camera", unit="rad", minimum=-3.2, maximum=3.2
    )
    size: float = setting(1.0, "Size of the actor; 1 is an adult", minimum=0.3, maximum=2.0)
    seed: int = setting(
        0, "Random seed; a different seed gives different noise", minimum=0, maximum=2**31
    )


@dataclass(frozen=True, eq=False)
class Performance:
    """Joints of the first Kinect, and the gestures performed.

    Attributes
    ----------
    times : shape (n_frames,), seconds, uneven with `lateness`
    positions : shape (n_frames, 20, 3), meters, Z up
    confidence : shape (n_frames, 20), 0 to 1
    made : tuple of (name of the gesture, seconds at its end)
    """

    times: Array
    positions: Array
    confidence: Array
    made: tuple[tuple[str, float], ...]

    def recording(self) -> JointRecording:
        """Return the frames as an evenly sampled recording."""
        rate = (len(self.times) - 1) / (self.times[-1] - self.times[0])
        names = SENSOR_JOINTS[Sensor.KINECT_V1]
        tracks = Tracks(names, self.positions, rate, self.confidence)
        return JointRecording(tracks, None, Sensor.KINECT_V1)


def perform_gestures(
    gestures: Sequence[str], settings: PerformanceSettings = PerformanceSettings()
) -> Performance:
    """Perform gestures in order, connected by smooth movements.

    Parameters
    ----------
    gestures : sequence of str
        Of `GESTURES`.
    settings : PerformanceSettings

    Raises
    ------
    InvalidSettingError
        A gesture is unknown.
    """
    if unknown := [name for name in gestures if name not in GESTURES]:
        raise InvalidSettingError(
            f"{', '.join(unknown)}: not a gesture of {', '.join(GESTURES)}."
        )
    keys: list[tuple[float, Position, Position]] = [
        (0.0, REST, REST),
        (0.5, REST, REST),
    ]
    made = []
    for name in gestures:
        for step in GESTURES[name]:
            if step is None:
                made.append((name, keys[-1][0]))
            else:
                keys.append((keys[-1][0] + step[0], *step[1:]))
    times = np.arange(0.0, keys[-1][0], 1.0 / settings.frame_rate)
    rng = np.random.default_rng(settings.seed)
    positions = settings.size * _body(keys, times)
    positions[..., 2] += settings.size * HIPS_HEIGHT_M
    cos, sin = np.cos(settings.heading), np.sin(settings.heading)
    positions = positions @ np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
    positions += rng.normal(scale=settings.noise, size=positions.shape)
    confidence = _confidence(times, settings, rng)
    positions[confidence < 0.5] += rng.normal(
        scale=0.15, size=(int((confidence < 0.5).sum()), 3)
    )
    time_stamps = np.sort(times + rng.normal(scale=settings.lateness, size=len(times)))
    is_received = rng.random(len(times)) >= settings.dropped
    return Performance(
        time_stamps[is_received], positions[is_received], confidence[is_received], tuple(made)
    )


def _body(keys: Sequence[tuple[float, Position, Position]], times: Array) -> Array:
    """Return joints relative to the hips, shape (n_frames, 20, 3), facing -Y."""
    names = SENSOR_JOINTS[Sensor.KINECT_V1]
    positions = np.zeros((len(times), len(names), 3))
    for name, position in BODY_POSITIONS.items():
        positions[:, names.index(name)] = position
    for side, sign, column in (("Right", 1.0, 0), ("Left", -1.0, 1)):
        wrists = _minimum_jerk_path(
            [key[0] for key in keys], [key[1:][column] for key in keys], times
        )
        elbow, wrist, hand = _arm(wrists * sum(ARM_LENGTHS_M))
        shoulder = np.array(BODY_POSITIONS[f"Shoulder{side}"])
        for name, offset in (("Elbow", elbow), ("Wrist", wrist), ("Hand", hand)):
            positions[:, names.index(name + side)] = shoulder + offset * (sign, 1.0, 1.0)
    return positions * (-1.0, -1.0, 1.0)


def _minimum_jerk_path(
    key_times: Sequence[float], positions: Sequence[Position], times: Array
) -> Array:
    """Interpolate positions with minimum jerk (Flash and Hogan 1985)."""
    key_array, key_array_times = np.asarray(positions), np.asarray(key_times)
    before = np.clip(
        np.searchsorted(key_array_times, times, side="right") - 1, 0, len(key_array_times) - 2
    )
    fractions = (times - key_array_times[before]) / (
        key_array_times[before + 1] - key_array_times[before]
    )
    fractions = fractions**3 * (10.0 - 15.0 * fractions + 6.0 * fractions**2)
    return np.asarray(
        key_array[before] + fractions[:, None] * (key_array[before + 1] - key_array[before])
    )


def _arm(wrists: Array) -> tuple[Array, Array, Array]:
    """Return elbow, wrist and hand of a right arm relative to its shoulder."""
    upper, fore = ARM_LENGTHS_M
    distances = np.linalg.norm(wrists, axis=-1, keepdims=True)
    directions = wrists / distances
    distances = np.minimum(distances, 0.999 * (upper + fore))
    elbow_distances = (distances**2 + upper**2 - fore**2) / (2.0 * distances)
    normals = ELBOW_DIRECTION - (directions @ ELBOW_DIRECTION)[:, None] * directions
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    elbow = (
        elbow_distances * directions
        + np.sqrt(np.maximum(upper**2 - elbow_distances**2, 0.0)) * normals
    )
    wrist = distances * directions
    pointing = wrist - elbow
    hand = wrist + HAND_LENGTH_M * pointing / np.linalg.norm(pointing, axis=-1, keepdims=True)
    return elbow, wrist, hand


def _confidence(times: Array, settings: PerformanceSettings, rng: np.random.Generator) -> Array:
    """Simulate short occlusions of joints."""
    n_joints = len(SENSOR_JOINTS[Sensor.KINECT_V1])
    confidence = np.ones((len(times), n_joints))
    for joint in range(n_joints):
        for start in rng.uniform(0.0, times[-1], rng.poisson(settings.hidden * times[-1])):
            end = start + rng.uniform(*OCCLUSION_S)
            confidence[(times >= start) & (times < end), joint] = OCCLUDED_CONFIDENCE
    return confidence
