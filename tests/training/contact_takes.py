"""Made feet whose contacts are known, with random parameters, to learn their detection from.

Gaits are those of the samples; all other feet are an ankle on a planned path, and toes in front
of it. None has the parameters of a take in `tests/benchmarks/contacts`.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from solvers.arrays import Array, Flags
from solvers.motion import find_humanoid_map, forward_kinematics
from solvers.motion.humanoid import foot_points
from solvers.samples import GaitSettings, walking_gait
from solvers.samples.footsteps import TOE_OFF
from solvers.samples.gait import HEADING_STD_RAD, MAX_STEP_M
from solvers.samples.walk_plan import plan_walk
from solvers.samples.walker import ANKLE_HEIGHT_M

DURATION_S = 6.0
GRAVITY = 9.81
FIRST_SEED = 1000
"""Seeds below are those of scored gaits."""
TOES_M = np.array([0.0, -0.14, -0.06])
"""From the ankle of a flat foot."""


class Feet(NamedTuple):
    """Ankles (n_frames, 2, 3) in meters, pitch (n_frames, 2) in radians, contacts."""

    ankles: Array
    pitch: Array
    contacts: Flags


def made_feet(kind: str, rate: float, rng: np.random.Generator) -> tuple[Array, Flags]:
    """Return ankles and toes (n_frames, 2, 2, 3), and contacts (n_frames, 2)."""
    if kind == "walk":
        return _walk(rate, rng)
    time = np.arange(round(DURATION_S * rate)) / rate
    ankles, pitch, contacts = PLANS[kind](time, rng)
    _, y, z = TOES_M
    toes = ankles.copy()
    toes[..., 1] += y * np.cos(pitch) - z * np.sin(pitch)
    toes[..., 2] += y * np.sin(pitch) + z * np.cos(pitch)
    return np.stack([ankles, toes], axis=2), contacts


def _walk(rate: float, rng: np.random.Generator) -> tuple[Array, Flags]:
    cadence = float(rng.uniform(80.0, 135.0))
    speed = float(rng.uniform(0.5, min(1.75, 0.98 * MAX_STEP_M * cadence / 60.0)))
    seed = FIRST_SEED + int(rng.integers(FIRST_SEED))
    gait = GaitSettings(
        duration=DURATION_S, frame_rate=rate, speed=speed, cadence=cadence, seed=seed
    )
    motion = walking_gait(gait)
    time = np.arange(motion.n_frames) / rate
    plan = plan_walk(time, DURATION_S, speed, 60.0 / cadence, HEADING_STD_RAD, seed)
    feet = foot_points(motion.skeleton, find_humanoid_map(motion.skeleton))
    contacts = np.stack([foot.phase < TOE_OFF for foot in plan.feet], axis=1)
    return forward_kinematics(motion).positions[:, feet], contacts


def _stand(time: Array, rng: np.random.Generator) -> Feet:
    ankles = np.zeros((len(time), 2, 3))
    ankles[..., 0] = rng.uniform(0.05, 0.2) * np.array([1.0, -1.0])
    ankles[..., 2] = ANKLE_HEIGHT_M
    return Feet(ankles, np.zeros((len(time), 2)), np.ones((len(time), 2), np.bool_))


def _hop(time: Array, rng: np.random.Generator) -> Feet:
    """Hop in place or forward, on both feet or with one held up."""
    stance, flight, speed = rng.uniform(0.12, 0.35), rng.uniform(0.2, 0.45), rng.uniform(0, 1.5)
    cycle, phase = np.divmod(time + rng.uniform(), stance + flight)
    in_air = phase >= stance
    flown = np.where(in_air, phase - stance, 0.0)
    ankles, pitch, contacts = _stand(time, rng)
    ankles[..., 1] -= (speed * (stance + flight) * (cycle + flown / flight))[:, None]
    ankles[..., 2] += (0.5 * GRAVITY * flown * (flight - flown))[:, None]
    pitch += (rng.uniform(0.0, 0.7) * np.sin(np.pi * flown / flight))[:, None]
    contacts &= ~in_air[:, None]
    if rng.random() < 0.5:
        held = rng.integers(2)
        ankles[:, held, 2] += rng.uniform(0.15, 0.5)
        ankles[:, held, 1] = -speed * time
        contacts[:, held] = False
    return Feet(ankles, pitch, contacts)


def _run(time: Array, rng: np.random.Generator) -> Feet:
    speed, period, lift = rng.uniform(2, 4.5), rng.uniform(0.6, 0.8), rng.uniform(0.15, 0.5)
    stance = rng.uniform(0.2, 0.4) * period
    ankles, pitch, contacts = _stand(time, rng)
    for foot, lag in enumerate((0.0, 0.5 * period)):
        cycle, phase = np.divmod(time + lag, period)
        swing = np.clip((phase - stance) / (period - stance), 0.0, 1.0)
        ankles[:, foot, 1] = -speed * (period * (cycle + smooth_step(swing)) - lag)
        ankles[:, foot, 2] += lift * np.sin(np.pi * swing) ** 2
        pitch[:, foot] = rng.uniform() * np.sin(np.pi * swing)
        contacts[:, foot] = phase < stance
    return Feet(ankles, pitch, contacts)


def _steps(time: Array, rng: np.random.Generator) -> Feet:
    """Step in any direction."""
    period = rng.uniform(0.8, 1.6)
    swing_s, start = rng.uniform(0.25, 0.45) * period, rng.uniform() * period
    length, direction = rng.uniform(0.1, 0.6), rng.uniform(0.0, 2.0 * np.pi)
    lift = rng.uniform(0.03, 0.15)
    ankles, pitch, contacts = _stand(time, rng)
    for foot in range(2):
        cycle, phase = np.divmod(time + start - 0.5 * foot * period, period)
        swing = np.clip(phase / swing_s, 0.0, 1.0)
        gone = cycle + smooth_step(swing)
        ankles[:, foot, 0] += length * np.cos(direction) * gone
        ankles[:, foot, 1] += length * np.sin(direction) * gone
        ankles[:, foot, 2] += lift * np.sin(np.pi * swing) ** 2
        contacts[:, foot] = phase >= swing_s
    return Feet(ankles, pitch, contacts)


def _box(time: Array, rng: np.random.Generator) -> Feet:
    """Step onto a box with both feet."""
    height, swing_s = rng.uniform(0.1, 0.3), rng.uniform(0.4, 0.9)
    first, pause = rng.uniform(0.5, 1.5), rng.uniform(0.6, 1.5)
    ankles, pitch, contacts = _stand(time, rng)
    for foot, start in zip(rng.permutation(2), (first, first + pause), strict=True):
        swing = np.clip((time - start) / swing_s, 0.0, 1.0)
        ankles[:, foot, 1] -= 0.35 * smooth_step(swing)
        ankles[:, foot, 2] += height * smooth_step(swing)
        ankles[:, foot, 2] += rng.uniform(0.08, 0.15) * np.sin(np.pi * swing) ** 2
        contacts[:, foot] = (swing <= 0.0) | (swing >= 1.0)
    return Feet(ankles, pitch, contacts)


def _one_leg(time: Array, rng: np.random.Generator) -> Feet:
    """Hold one foot in the air for some seconds."""
    lift_s, start, stop = rng.uniform(0.4, 0.8), rng.uniform(0.3, 2.0), rng.uniform(3.0, 5.5)
    ankles, pitch, contacts = _stand(time, rng)
    foot = rng.integers(2)
    up = smooth_step((time - start) / lift_s) - smooth_step((time - stop + lift_s) / lift_s)
    ankles[:, foot, 1] += rng.uniform(-0.3, 0.3) * up
    ankles[:, foot, 2] += rng.uniform(0.1, 0.5) * up
    ankles[:, foot] += up[:, None] * wander(time, rng, rng.uniform(0.0, 0.04))
    pitch[:, foot] = rng.uniform(0.0, 0.6) * up
    contacts[:, foot] = (time <= start) | (time >= stop)
    return Feet(ankles, pitch, contacts)


def _kick(time: Array, rng: np.random.Generator) -> Feet:
    ankles, pitch, contacts = _stand(time, rng)
    foot = rng.integers(2)
    swing = np.clip((time - rng.uniform(1.0, 3.0)) / rng.uniform(0.5, 1.0), 0.0, 1.0)
    ankles[:, foot, 1] -= rng.uniform(0.2, 0.8) * np.sin(np.pi * swing) ** 2
    ankles[:, foot, 2] += rng.uniform(0.3, 1.0) * np.sin(np.pi * swing) ** 2
    contacts[:, foot] = (swing <= 0.0) | (swing >= 1.0)
    return Feet(ankles, pitch, contacts)


def _hang(time: Array, rng: np.random.Generator) -> Feet:
    """Swing as a pendulum, from the first frame or after standing."""
    length, angle = rng.uniform(0.5, 2.2), rng.uniform(0.1, 0.45)
    rate = np.sqrt(GRAVITY / length) * rng.uniform(0.8, 1.2)
    start, phase = rng.uniform(0.0, 2.0 * np.pi), rng.uniform(0.0, np.pi) * rng.integers(2)
    floor, pitch, contacts = _stand(time, rng)
    ankles = floor.copy()
    for foot in range(2):
        swing = angle * np.sin(rate * time + start + foot * phase)
        ankles[:, foot, 1] += length * np.sin(swing)
        ankles[:, foot, 2] += length * (1.0 - np.cos(swing))
        ankles[:, foot] += wander(time, rng, rng.uniform(0.005, 0.04))
    contacts[:] = False
    if rng.random() < 0.4:
        lift = rng.uniform(1.0, 3.0)
        ankles[..., 2] += rng.uniform(0.3, 1.0)
        up = smooth_step((time - lift) / 0.5)[:, None, None]
        ankles = (1.0 - up) * floor + up * ankles
        contacts[time <= lift] = True
    return Feet(ankles, pitch, contacts)


PLANS: dict[str, Callable[[Array, np.random.Generator], Feet]] = {
    "stand": _stand, "hop": _hop, "run": _run, "steps": _steps, "box": _box,
    "one leg": _one_leg, "kick": _kick, "hang": _hang,
}  # fmt: skip
KINDS = ("walk", *PLANS)


def wander(time: Array, rng: np.random.Generator, distance: float) -> Array:
    """Return a slow path of about a distance in meters, (n_frames, 3)."""
    waves = [
        np.sin(2.0 * np.pi * hertz * time[:, None] + rng.uniform(0.0, 6.3, 3))
        * rng.normal(size=3)
        for hertz in (0.3, 0.7, 1.1)
    ]
    return np.asarray(distance * np.sum(waves, axis=0) / np.sqrt(len(waves)))


def smooth_step(ratio: Array) -> Array:
    """Go from 0 to 1 with minimum jerk (Flash and Hogan 1985)."""
    ratio = np.clip(ratio, 0.0, 1.0)
    return np.asarray(ratio**3 * (10.0 - 15.0 * ratio + 6.0 * ratio**2))
