"""When each foot stands on the ground."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d, label

from ...errors import InvalidMotionError
from ...settings import Settings, setting
from ..skeletons import Motion, Skeleton, forward_kinematics, linear_velocities
from .roles import HumanoidMap, find_humanoid_map

HUMAN_LEG = 0.9
"""Metres from hip to ankle for which the settings are meant; they grow with the leg."""

GROUND_PERCENTILE = 5.0
"""The ground is where the lowest of the slow frames are; a few lower ones are noise."""

GROUND_REACH = 1.0
"""Seconds before and after a moment in which a foot shows where the ground is."""

GROUND_DRIFT = 0.1
"""Metres by which the ground of a moment may differ from that of the whole clip."""

ENOUGH_SLOW = 0.02
"""Part of all frames that must be slow to judge the ground by them alone."""


@dataclass(frozen=True, kw_only=True)
class ContactSettings(Settings):
    """When a foot counts as planted. Lengths and speeds are for a leg of 0.9 m."""

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
    """Tell when the left and the right foot stand on level ground.

    A foot stands while its ankle or its toes are both low and slow. The feet are smoothed
    first; the ground's height is that of the lowest slow frames within a second, of both feet
    together, since one may never touch it. A contact begins where height and speed are within
    the settings and lasts while they are within `release` times those. Stairs are not level
    ground.

    Parameters
    ----------
    motion : Motion
    humanoid_map : HumanoidMap, optional
        Found by `find_humanoid_map` where it is not given.
    settings : ContactSettings

    Returns
    -------
    NDArray of bool, shape (n_frames, 2)
        Left foot, right foot. False where the foot is not observed.

    Raises
    ------
    InvalidMotionError
        The skeleton has not two feet.
    """
    humanoid = humanoid_map or find_humanoid_map(motion.skeleton)
    feet = foot_points(motion.skeleton, humanoid)
    positions = forward_kinematics(motion).positions[:, feet]
    size = leg_length(motion.skeleton, humanoid) / HUMAN_LEG
    return contacts_of_points(positions, motion.frame_rate, size, settings)


def contacts_of_points(
    positions: NDArray[np.float64],
    frame_rate: float,
    size: float = 1.0,
    settings: ContactSettings = ContactSettings(),
) -> NDArray[np.bool_]:
    """Tell when feet stand of which only points are known; see `detect_contacts`.

    Parameters
    ----------
    positions : shape (n_frames, 2, 2, 3), metres
        Left and right, ankle and toes (the same point twice where there is but one).
    frame_rate : float, hertz
    size : float
        Length of a leg over 0.9 m.
    settings : ContactSettings

    Returns
    -------
    NDArray of bool, shape (n_frames, 2)
        Left foot, right foot. False where the foot is not observed.
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
    badness = np.maximum(heights / settings.height, speeds / settings.speed) / size
    badness = np.where(np.isfinite(badness), badness, np.inf).min(axis=2)
    shortest = settings.minimum_duration * frame_rate
    return np.stack(
        [_held(foot <= 1.0, foot <= settings.release, shortest) for foot in badness.T], axis=-1
    )


def foot_points(skeleton: Skeleton, humanoid: HumanoidMap) -> NDArray[np.intp]:
    """Return the joints that stand: rows left and right, columns ankle and toes.

    Without a joint for the toes, the end site of the foot stands for them, or the ankle again.

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
    """Return the mean length of both legs from hip to ankle along the bones, in metres.

    Legs without hip or knee count as human ones of 0.9 m.
    """
    joints = humanoid.indices(skeleton)
    lengths = []
    for side in ("left", "right"):
        roles = [f"{side}UpperLeg", f"{side}LowerLeg", f"{side}Foot"]
        if all(role in joints for role in roles):
            leg = skeleton.rest_positions[[joints[role] for role in roles]]
            lengths.append(np.linalg.norm(np.diff(leg, axis=0), axis=-1).sum())
    return float(np.mean(lengths)) if lengths and min(lengths) > 0.0 else HUMAN_LEG


def _smoothed(positions: NDArray[np.float64], sigma: float) -> NDArray[np.float64]:
    """Blur over time by what is observed; gaps stay gaps."""
    if sigma <= 0.0:
        return positions
    seen = np.isfinite(positions)
    total = gaussian_filter1d(np.where(seen, positions, 0.0), sigma, axis=0, mode="nearest")
    weight = gaussian_filter1d(seen.astype(float), sigma, axis=0, mode="nearest")
    return np.asarray(np.where(seen, total / np.maximum(weight, 1e-12), np.nan))


def _ground(
    heights: NDArray[np.float64], slow: NDArray[np.bool_], frame_rate: float, size: float
) -> NDArray[np.float64]:
    """Return the height at which ankles (or toes) stand, frame by frame, shape (n_frames,).

    Both feet together show it, by their slow frames within a second; captured floors are
    seldom quite level. Where no foot does, neighbours in time do; no moment's ground is far
    from the whole clip's, lest a hanging foot counts as standing.
    """
    known = np.isfinite(heights)
    chosen = known & slow if (known & slow).sum() >= ENOUGH_SLOW * slow.size else known
    if not chosen.any():
        return np.full(len(heights), np.nan)
    overall = np.percentile(heights[chosen], GROUND_PERCENTILE)
    reach = int(np.ceil(GROUND_REACH * frame_rate))
    knots, levels = [], []
    for knot in range(0, len(heights), max(reach // 4, 1)):
        near = slice(max(knot - reach, 0), knot + reach + 1)
        if chosen[near].any():
            knots.append(knot)
            levels.append(np.percentile(heights[near][chosen[near]], GROUND_PERCENTILE))
    level = np.interp(np.arange(len(heights)), knots, levels)
    drift = GROUND_DRIFT * size
    return np.clip(level, overall - drift, overall + drift)


def _held(
    sure: NDArray[np.bool_], held: NDArray[np.bool_], shortest: float
) -> NDArray[np.bool_]:
    """Return the runs of `held` with something `sure`, without short gaps and short runs."""
    runs, _ = label(held)
    keep = np.isin(runs, np.unique(runs[sure])) & held
    keep = ~_without_short(~keep, shortest / 2.0)
    return _without_short(keep, shortest)


def _without_short(flags: NDArray[np.bool_], shortest: float) -> NDArray[np.bool_]:
    """Clear the runs of True that last fewer frames; runs at the clip's ends may go on."""
    runs, n_runs = label(flags)
    lengths = np.bincount(runs, minlength=n_runs + 1)
    short = lengths < shortest
    short[0] = False
    short[runs[[0, -1]]] = False
    return np.asarray(flags & ~short[runs])
