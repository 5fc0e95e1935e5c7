"""Detect foot contacts with the ground."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...settings import Settings, setting
from ...signals import smooth_gaussian
from ..skeletons import Motion, Skeleton, forward_kinematics, linear_velocities
from .roles import HumanoidMap, find_humanoid_map

HUMAN_LEG_LENGTH_M = 0.9
"""Leg length, hip to ankle, for which the settings are defined; they scale with the leg. By
definition."""

GROUND_PERCENTILE = 5.0
"""Percentile of the heights of slow frames that is the ground; lower ones are noise. It guards
feet that a sensor places below the ground for some frames."""

GROUND_WINDOW_S = 1.0
"""Seconds before and after a frame from which the height of its ground is estimated. It guards
sloping floors, and sensors whose floor drifts."""

MAX_GROUND_DRIFT_M = 0.1
"""Maximum difference between the ground of a frame and that of the complete clip. It guards
feet that hang or rest in the air for longer than the window."""

MIN_SLOW_FRACTION = 0.02
"""Fraction of slow frames from which the ground is estimated from these alone. It guards feet
that slide, and are slow only where they hang in the air."""


@dataclass(frozen=True, kw_only=True)
class ContactSettings(Settings):
    """Thresholds of foot contact. Lengths and speeds are for a leg of 0.9 m."""

    height: float = setting(
        0.05, "Height below which a foot may be planted; higher finds more contacts",
        unit="m", minimum=1e-3, maximum=1.0,
    )  # fmt: skip
    speed: float = setting(
        0.3, "Speed below which a foot may be planted; higher finds more and longer contacts",
        unit="m/s", minimum=1e-3, maximum=10.0,
    )  # fmt: skip
    release: float = setting(
        1.5, "Release a planted foot above height and speed times this; higher holds longer",
        minimum=1.0, maximum=10.0, advanced=True,
    )  # fmt: skip
    minimum_duration: float = setting(
        0.1, "Ignore shorter contacts and close gaps of half this length",
        unit="s", minimum=0.0, maximum=10.0, advanced=True,
    )  # fmt: skip
    smoothing: float = setting(
        0.03,
        "Smooth foot motion before detection; higher ignores more jitter but blurs contact"
        " starts", unit="s", minimum=0.0, maximum=1.0, advanced=True,
    )  # fmt: skip


def detect_contacts(
    motion: Motion,
    humanoid_map: HumanoidMap | None = None,
    settings: ContactSettings = ContactSettings(),
) -> NDArray[np.bool_]:
    """Return when the left and the right foot are in contact with level ground.

    A foot is in contact while its ankle or its toes are low and slow. The feet are smoothed
    first. The height of the ground is that of the lowest slow frames of both feet within a
    second. A contact begins where height and speed are within the settings and lasts while
    they are within `release` times the settings (hysteresis). Stairs are not level ground.

    Parameters
    ----------
    motion : Motion
    humanoid_map : HumanoidMap, optional
        By default from `find_humanoid_map`.
    settings : ContactSettings

    Returns
    -------
    NDArray of bool, shape (n_frames, 2)
        Left foot, right foot. False where the foot is missing.

    Raises
    ------
    InvalidMotionError
        The skeleton does not have two feet.
    """
    humanoid = humanoid_map or find_humanoid_map(motion.skeleton)
    feet = foot_points(motion.skeleton, humanoid)
    positions = forward_kinematics(motion).positions[:, feet]
    size = leg_length(motion.skeleton, humanoid) / HUMAN_LEG_LENGTH_M
    return contacts_of_points(positions, motion.frame_rate, size, settings)


def contacts_of_points(
    positions: NDArray[np.float64],
    frame_rate: float,
    size: float = 1.0,
    settings: ContactSettings = ContactSettings(),
) -> NDArray[np.bool_]:
    """Return foot contacts from positions alone; see `detect_contacts`.

    Parameters
    ----------
    positions : shape (n_frames, 2, 2, 3), meters
        Left and right, ankle and toes (the same point twice if there is only one).
    frame_rate : float, hertz
    size : float
        Length of a leg over 0.9 m.
    settings : ContactSettings

    Returns
    -------
    NDArray of bool, shape (n_frames, 2)
        Left foot, right foot. False where the foot is missing.
    """
    positions = _smoothed(positions, settings.smoothing * frame_rate)
    speeds = np.linalg.norm(linear_velocities(positions, frame_rate), axis=-1)
    slow = speeds <= settings.speed * size
    ground = [
        _ground(positions[:, :, point, 2], slow[:, :, point], frame_rate, size)
        for point in range(2)
    ]
    heights = positions[..., 2] - np.stack(ground, axis=-1)[:, None]
    # 1 is the edge of what the settings call low and slow.
    exceedance = np.maximum(heights / settings.height, speeds / settings.speed) / size
    exceedance = np.where(np.isfinite(exceedance), exceedance, np.inf).min(axis=2)
    min_frames = settings.minimum_duration * frame_rate
    return np.stack(
        [
            _sustained(foot <= 1.0, foot <= settings.release, min_frames)
            for foot in exceedance.T
        ],
        axis=-1,
    )


def foot_points(skeleton: Skeleton, humanoid: HumanoidMap) -> NDArray[np.intp]:
    """Return the joints of foot contact: rows left and right, columns ankle and toes.

    Without a toe joint, the end site of the foot replaces it, or else the ankle.

    Raises
    ------
    InvalidMotionError
        A foot is missing.
    """
    joints = humanoid.indices(skeleton)
    missing = [role for role in ("leftFoot", "rightFoot") if role not in joints]
    if missing:
        raise InvalidMotionError(
            f"No joint has the humanoid role {' or '.join(missing)}. Choose one in the map."
        )
    rows = []
    for side in ("left", "right"):
        foot = joints[f"{side}Foot"]
        rows.append([foot, joints.get(f"{side}Toes", (*skeleton.children[foot], foot)[0])])
    return np.array(rows)


def leg_length(skeleton: Skeleton, humanoid: HumanoidMap) -> float:
    """Return the mean length of both legs from hip to ankle along the bones, in meters.

    Legs without hip or knee get a length of 0.9 m.
    """
    joints = humanoid.indices(skeleton)
    lengths = []
    for side in ("left", "right"):
        roles = [f"{side}UpperLeg", f"{side}LowerLeg", f"{side}Foot"]
        if all(role in joints for role in roles):
            leg = skeleton.rest_positions[[joints[role] for role in roles]]
            lengths.append(np.linalg.norm(np.diff(leg, axis=0), axis=-1).sum())
    return float(np.mean(lengths)) if lengths and min(lengths) > 0.0 else HUMAN_LEG_LENGTH_M


def _smoothed(positions: NDArray[np.float64], sigma: float) -> NDArray[np.float64]:
    """Smooth observed frames over time; gaps stay gaps."""
    if sigma <= 0.0:
        return positions
    observed = np.isfinite(positions)
    total = smooth_gaussian(np.where(observed, positions, 0.0), sigma)
    weight = smooth_gaussian(observed.astype(float), sigma)
    return np.asarray(np.where(observed, total / np.maximum(weight, 1e-12), np.nan))


def _ground(
    heights: NDArray[np.float64], slow: NDArray[np.bool_], frame_rate: float, size: float
) -> NDArray[np.float64]:
    """Return the height of ankles (or toes) in contact in each frame, shape (n_frames,).

    It is estimated from slow frames of both feet within a second, since captured floors are
    seldom level, and interpolated where there are none. It stays near the ground of the clip,
    so that a foot in the air is not classified as standing.
    """
    observed = np.isfinite(heights)
    selected = (
        observed & slow
        if (observed & slow).sum() >= MIN_SLOW_FRACTION * slow.size
        else observed
    )
    if not selected.any():
        return np.full(len(heights), np.nan)
    overall = np.percentile(heights[selected], GROUND_PERCENTILE)
    half_window = int(np.ceil(GROUND_WINDOW_S * frame_rate))
    knots, levels = [], []
    for knot in range(0, len(heights), max(half_window // 4, 1)):
        window = slice(max(knot - half_window, 0), knot + half_window + 1)
        if selected[window].any():
            knots.append(knot)
            levels.append(np.percentile(heights[window][selected[window]], GROUND_PERCENTILE))
    level = np.interp(np.arange(len(heights)), knots, levels)
    drift = MAX_GROUND_DRIFT_M * size
    return np.clip(level, overall - drift, overall + drift)


def _sustained(
    certain: NDArray[np.bool_], sustained: NDArray[np.bool_], min_frames: float
) -> NDArray[np.bool_]:
    """Return the runs of `sustained` with a `certain` frame, without short gaps and runs."""
    from scipy.ndimage import label  # slow to import: only when needed

    labels, _ = label(sustained)
    contact = np.isin(labels, np.unique(labels[certain])) & sustained
    contact = ~without_short_runs(~contact, min_frames / 2.0)
    return without_short_runs(contact, min_frames)


def without_short_runs(flags: NDArray[np.bool_], min_frames: float) -> NDArray[np.bool_]:
    """Clear shorter runs of True, except at the ends of the clip, where they may continue.

    `flags` have shape (n_frames,).
    """
    from scipy.ndimage import label  # slow to import: only when needed

    labels, n_runs = label(flags)
    lengths = np.bincount(labels, minlength=n_runs + 1)
    is_short = lengths < min_frames
    is_short[0] = False
    is_short[labels[[0, -1]]] = False
    return np.asarray(flags & ~is_short[labels])
