"""An actor before a depth camera who makes known gestures at known times."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidSettingError
from ..motion import JOINTS, JointRecording, Sensor, Tracks
from ..settings import Settings, setting

Array = NDArray[np.float64]
Place = tuple[float, float, float]

ARM = (0.28, 0.25)
"""Metres of upper arm and forearm."""
HAND = 0.09
SHOULDERS = 0.18
"""Metres from the middle to each shoulder."""
BODY = {  # metres from the hips to the actor's right, forward, up
    "HipCenter": (0.0, 0.0, 0.0), "Spine": (0.0, 0.0, 0.22), "ShoulderCenter": (0.0, 0.0, 0.48),
    "Head": (0.0, 0.0, 0.70),
    "ShoulderLeft": (-SHOULDERS, 0.0, 0.44), "ShoulderRight": (SHOULDERS, 0.0, 0.44),
    "HipLeft": (-0.09, 0.0, -0.06), "KneeLeft": (-0.09, 0.02, -0.46),
    "AnkleLeft": (-0.09, 0.0, -0.86), "FootLeft": (-0.09, 0.12, -0.92),
    "HipRight": (0.09, 0.0, -0.06), "KneeRight": (0.09, 0.02, -0.46),
    "AnkleRight": (0.09, 0.0, -0.86), "FootRight": (0.09, 0.12, -0.92),
}  # fmt: skip
HIPS_HEIGHT = 0.95
DOWN_AND_OUT = np.array([0.3, 0.0, -1.0])
"""Where the elbow of the right arm points."""
HIDDEN = 0.1
"""Confidence in a joint that is hidden."""
HIDDEN_FOR = (0.05, 0.2)
"""Seconds, least and most."""

REST: Place = (0.05, 0.05, -0.96)
HIGH: Place = (0.25, 0.15, 0.85)
WAVING: Place = (0.25, 0.4, 0.4)
CLAP_READY: Place = (0.3, 0.6, -0.4)
CLAPPED: Place = (-0.3, 0.7, -0.3)
NEAR: Place = (-0.05, 0.6, -0.3)
FAR: Place = (0.3, 0.6, -0.3)
ASIDE: Place = (0.7, 0.66, 0.0)
AHEAD: Place = (0.0, 0.96, 0.0)

# Time to get there (s), right wrist and left wrist from their shoulders, in arm lengths: to the
# outside, forward, up; None: the gesture is done once it is reached.
GESTURES: dict[str, tuple[tuple[float, Place, Place] | None, ...]] = {
    "rest": ((1.0, REST, REST),),
    "hand up": ((0.7, HIGH, REST), None, (1.2, HIGH, REST)),
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
    """How the camera sees it."""

    frame_rate: float = setting(30.0, "Frames per second", unit="Hz", minimum=5.0, maximum=240)
    noise: float = setting(
        0.0, "Standard deviation of each coordinate", unit="m", minimum=0.0, maximum=0.2
    )
    hidden: float = setting(
        0.0, "How often a second each joint is hidden for a moment", minimum=0.0, maximum=10.0
    )
    lost: float = setting(0.0, "Share of frames that are lost", minimum=0.0, maximum=0.9)
    lateness: float = setting(
        0.0, "Standard deviation of the time stamps", unit="s", minimum=0.0, maximum=0.05
    )
    heading: float = setting(
        0.0, "Turn of the actor; 0 faces the camera", unit="rad", minimum=-3.2, maximum=3.2
    )
    size: float = setting(1.0, "Size of the actor; 1 is an adult", minimum=0.3, maximum=2.0)
    seed: int = setting(0, "Another one gives other noise", minimum=0, maximum=2**31)


@dataclass(frozen=True, eq=False)
class Performance:
    """Joints of the first Kinect, and what was performed.

    Attributes
    ----------
    times : shape (n_frames,), seconds, uneven where they were made so
    positions : shape (n_frames, 20, 3), metres, Z up
    confidence : shape (n_frames, 20), 0 to 1
    made : tuple of (name of the gesture, seconds when it was done)
    """

    times: Array
    positions: Array
    confidence: Array
    made: tuple[tuple[str, float], ...]

    def recording(self) -> JointRecording:
        """Return the frames as if they had come evenly."""
        rate = (len(self.times) - 1) / (self.times[-1] - self.times[0])
        names = JOINTS[Sensor.KINECT_V1]
        tracks = Tracks(names, self.positions, rate, self.confidence)
        return JointRecording(tracks, None, Sensor.KINECT_V1)


def perform_gestures(
    gestures: Sequence[str], settings: PerformanceSettings = PerformanceSettings()
) -> Performance:
    """Make gestures one after the other, with smooth ways between them.

    Parameters
    ----------
    gestures : sequence of str
        Of `GESTURES`.
    settings : PerformanceSettings

    Raises
    ------
    InvalidSettingError
        A gesture is not known.
    """
    if unknown := [name for name in gestures if name not in GESTURES]:
        raise InvalidSettingError(
            f"{', '.join(unknown)}: not a gesture of {', '.join(GESTURES)}."
        )
    keys: list[tuple[float, Place, Place]] = [(0.0, REST, REST), (0.5, REST, REST)]
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
    positions[..., 2] += settings.size * HIPS_HEIGHT
    cos, sin = np.cos(settings.heading), np.sin(settings.heading)
    positions = positions @ np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
    positions += rng.normal(scale=settings.noise, size=positions.shape)
    confidence = _confidence(times, settings, rng)
    positions[confidence < 0.5] += rng.normal(
        scale=0.15, size=(int((confidence < 0.5).sum()), 3)
    )
    stamps = np.sort(times + rng.normal(scale=settings.lateness, size=len(times)))
    kept = rng.random(len(times)) >= settings.lost
    return Performance(stamps[kept], positions[kept], confidence[kept], tuple(made))


def _body(keys: Sequence[tuple[float, Place, Place]], times: Array) -> Array:
    """Return joints from the hips, shape (n_frames, 20, 3), facing -Y."""
    names = JOINTS[Sensor.KINECT_V1]
    seen = np.zeros((len(times), len(names), 3))
    for name, place in BODY.items():
        seen[:, names.index(name)] = place
    for side, sign, column in (("Right", 1.0, 0), ("Left", -1.0, 1)):
        wrists = _between([key[0] for key in keys], [key[1:][column] for key in keys], times)
        elbow, wrist, hand = _arm(wrists * sum(ARM))
        shoulder = np.array(BODY[f"Shoulder{side}"])
        for name, where in (("Elbow", elbow), ("Wrist", wrist), ("Hand", hand)):
            seen[:, names.index(name + side)] = shoulder + where * (sign, 1.0, 1.0)
    return seen * (-1.0, -1.0, 1.0)


def _between(moments: Sequence[float], places: Sequence[Place], times: Array) -> Array:
    """Go from place to place with the least jerk (Flash and Hogan 1985)."""
    at, stops = np.asarray(places), np.asarray(moments)
    before = np.clip(np.searchsorted(stops, times, side="right") - 1, 0, len(stops) - 2)
    share = (times - stops[before]) / (stops[before + 1] - stops[before])
    share = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    return np.asarray(at[before] + share[:, None] * (at[before + 1] - at[before]))


def _arm(wrists: Array) -> tuple[Array, Array, Array]:
    """Return elbow, wrist and hand of a right arm from its shoulder."""
    upper, fore = ARM
    far = np.linalg.norm(wrists, axis=-1, keepdims=True)
    way = wrists / far
    far = np.minimum(far, 0.999 * (upper + fore))
    along = (far**2 + upper**2 - fore**2) / (2.0 * far)
    aside = DOWN_AND_OUT - (way @ DOWN_AND_OUT)[:, None] * way
    aside /= np.linalg.norm(aside, axis=-1, keepdims=True)
    elbow = along * way + np.sqrt(np.maximum(upper**2 - along**2, 0.0)) * aside
    wrist = far * way
    pointing = wrist - elbow
    hand = wrist + HAND * pointing / np.linalg.norm(pointing, axis=-1, keepdims=True)
    return elbow, wrist, hand


def _confidence(times: Array, settings: PerformanceSettings, rng: np.random.Generator) -> Array:
    """Hide joints for moments, as other limbs do."""
    n_joints = len(JOINTS[Sensor.KINECT_V1])
    confidence = np.ones((len(times), n_joints))
    for joint in range(n_joints):
        for start in rng.uniform(0.0, times[-1], rng.poisson(settings.hidden * times[-1])):
            end = start + rng.uniform(*HIDDEN_FOR)
            confidence[(times >= start) & (times < end), joint] = HIDDEN
    return confidence
