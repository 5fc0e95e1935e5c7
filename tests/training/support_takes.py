"""Made hands and knees whose contacts with the floor are known, to learn their detection from.

Two points each, such as wrist and knuckles, above a floor at height 0: on it they are as high
as a palm or knee is thick. None has the parameters of a take in `tests/benchmarks/contacts`.
"""

from collections.abc import Callable

import numpy as np

from solvers.arrays import Array, Flags

from .contact_takes import DURATION_S, smooth_step, wander

THICKNESS_M = (0.0, 0.06)
"""Meters from the ground to a wrist, knuckle or knee that bears on it; what is the lowest joint
of the body may be as high itself."""
REST_M = ((0.1, 0.2), (0.2, 0.6))
"""Meters above the ground at which a hand rests on a thigh or hangs, and a knee is bent: of a
body that lies or sits, and of others."""
SWEEP_SPEEDS = (0.1, 1.0)
"""Meters per second of what an actor drags over the floor, such as the hands of one who lies
down."""
HAND_M = 0.09
"""Meters from wrist to knuckles."""

Plan = Callable[[Array, np.random.Generator], tuple[Array, Flags]]


def made_supports(kind: str, rate: float, rng: np.random.Generator) -> tuple[Array, Flags]:
    """Return two points of left and right (n_frames, 2, 2, 3), and contacts (n_frames, 2)."""
    time = np.arange(round(DURATION_S * rate)) / rate
    path, contacts = PLANS[kind](time, rng)
    points = np.repeat(path[:, :, None], 2, axis=2)
    if rng.random() < 0.7:  # a hand; both points of a knee are the same
        points[:, :, 1, 1] -= HAND_M
        points[..., 0, 2] += rng.uniform(0.0, 0.05)
    points[..., 2] += rng.uniform(*THICKNESS_M)
    return points, contacts


def _crawl(time: Array, rng: np.random.Generator) -> tuple[Array, Flags]:
    """Lift and set down by turns, forward, sideways or in place."""
    period = rng.uniform(0.8, 2.0)
    swing_s, start = rng.uniform(0.25, 0.5) * period, rng.uniform() * period
    length, direction = rng.uniform(0.1, 0.6), rng.uniform(0.0, 2.0 * np.pi)
    lift = rng.uniform(0.02, 0.2)
    path, contacts = _lean(time, rng)
    for side in range(2):
        cycle, phase = np.divmod(time + start - 0.5 * side * period, period)
        swing = np.clip(phase / swing_s, 0.0, 1.0)
        gone = length * (cycle + smooth_step(swing))
        path[:, side, 0] += np.cos(direction) * gone
        path[:, side, 1] += np.sin(direction) * gone
        path[:, side, 2] += lift * np.sin(np.pi * swing) ** 2
        contacts[:, side] = phase >= swing_s
    return path, contacts


def _lean(time: Array, rng: np.random.Generator) -> tuple[Array, Flags]:
    """Bear on the floor all the time."""
    path = np.zeros((len(time), 2, 3))
    path[..., 0] = rng.uniform(0.1, 0.3) * np.array([1.0, -1.0])
    return path, np.ones((len(time), 2), np.bool_)


def _come_down(time: Array, rng: np.random.Generator) -> tuple[Array, Flags]:
    """Come down from the height of a standing or sitting body, and mostly lift again.

    A third comes to rest above the floor.
    """
    path, contacts = _lean(time, rng)
    for side in range(2):
        first, down_s = rng.uniform(0.3, 2.0), rng.uniform(0.3, 1.2)
        last, up_s = rng.uniform(3.0, 7.0), rng.uniform(0.3, 1.2)
        up = 1.0 - smooth_step((time - first) / down_s) + smooth_step((time - last) / up_s)
        path[:, side, 2] += rng.uniform(0.15, 0.9) * up
        path[:, side, :2] += rng.uniform(-0.5, 0.5, 2) * up[:, None]
        contacts[:, side] = (time >= first + down_s) & (time <= last)
        if rng.random() < 0.33:
            path[:, side, 2] += rng.uniform(*rng.choice(REST_M)) * (1.0 - up)
            contacts[:, side] = False
    return path, contacts


def _sweep(time: Array, rng: np.random.Generator) -> tuple[Array, Flags]:
    """Wipe or drag over the floor, back and forth."""
    path, contacts = _lean(time, rng)
    for side in range(2):
        speed, hertz = np.exp(rng.uniform(*np.log(SWEEP_SPEEDS))), rng.uniform(0.1, 1.0)
        phase, direction = rng.uniform(0.0, 6.3), rng.uniform(0.0, 6.3)
        gone = speed / (2.0 * np.pi * hertz) * np.sin(2.0 * np.pi * hertz * time + phase)
        path[:, side, :2] += gone[:, None] * (np.cos(direction), np.sin(direction))
    return path, ~contacts


def _rest(time: Array, rng: np.random.Generator) -> tuple[Array, Flags]:
    """Rest above the floor, on a thigh or in the air."""
    path, contacts = _lean(time, rng)
    for side in range(2):
        path[:, side, 2] += rng.uniform(*rng.choice(REST_M))
        path[:, side] += wander(time, rng, rng.uniform(0.0, 0.04))
    return path, ~contacts


def _pick_up(time: Array, rng: np.random.Generator) -> tuple[Array, Flags]:
    """Reach down to an object on the floor, and up again."""
    path, contacts = _lean(time, rng)
    for side in range(2):
        swing = np.clip((time - rng.uniform(0.5, 3.0)) / rng.uniform(1.0, 2.5), 0.0, 1.0)
        low, high = rng.uniform(0.11, 0.3), rng.uniform(0.6, 0.9)
        path[:, side, 2] += high - (high - low) * np.sin(np.pi * swing) ** 2
        path[:, side, 1] -= rng.uniform(0.2, 0.5) * np.sin(np.pi * swing) ** 2
    return path, ~contacts


def _swing(time: Array, rng: np.random.Generator) -> tuple[Array, Flags]:
    """Swing as an arm does in a walk or run, or closely over the floor."""
    path, contacts = _lean(time, rng)
    speed, hertz = rng.uniform(0.5, 3.0), rng.uniform(0.6, 1.4)
    low = rng.choice([rng.uniform(0.02, 0.15), rng.uniform(0.3, 0.8)])
    for side in range(2):
        angle = np.sin(2.0 * np.pi * hertz * time + side * np.pi) * rng.uniform(0.3, 0.9)
        path[:, side, 1] += 0.6 * np.sin(angle) - speed * time
        path[:, side, 2] += low + 0.6 * (1.0 - np.cos(angle))
    return path, ~contacts


PLANS: dict[str, Plan] = {
    "crawl": _crawl, "lean": _lean, "come down": _come_down, "sweep": _sweep, "rest": _rest,
    "pick up": _pick_up, "swing": _swing,
}  # fmt: skip
