"""Takes in which one foot is dragged over the floor: both feet are in contact."""

from functools import partial

import numpy as np

from solvers.arrays import Array

from .made_takes import MadeTake, Plan, pose_plan, smooth_step, still

DURATION_S = 8.0
DRAGS = {
    "30 cm at 0.1 m/s": (0.3, 0.1),
    "20 cm at 0.2 m/s": (0.2, 0.2),
    "30 cm at 0.3 m/s": (0.3, 0.3),
    "12 cm at 0.3 m/s": (0.12, 0.3),
    "30 cm at 0.5 m/s": (0.3, 0.5),
}
"""Distance in meters and mean speed in meters per second."""


def made_drags(frame_rate: float) -> dict[str, MadeTake]:
    """Return all takes at a frame rate. Their contacts are those of feet that stand."""
    time = np.arange(round(DURATION_S * frame_rate)) / frame_rate
    plans = {name: partial(_drags, *drag) for name, drag in DRAGS.items()}
    return {name: pose_plan(plan(time), frame_rate) for name, plan in plans.items()}


def _drags(distance: float, speed: float, time: Array) -> Plan:
    """Drag the left foot forward, then the right one after it, and both back again."""
    hips, ankles = still(time)
    hips[:, 2] -= 0.06
    contacts = np.ones((len(time), 2), np.bool_)
    for index, (foot, sign) in enumerate(((0, -1.0), (1, -1.0), (0, 1.0), (1, 1.0))):
        start, length = 0.5 + 1.9 * index, min(distance / speed, 1.7)
        part = (time - start) / length
        ankles[:, foot, 1] += sign * speed * length * _uniform_step(part)
        hips[:, 1] += 0.5 * sign * speed * length * smooth_step(part)
        contacts[:, foot] &= (part <= 0.0) | (part >= 1.0)
    return Plan(hips, ankles, contacts)


def _uniform_step(part: Array) -> Array:
    """Go from 0 to 1 at constant speed, but for the first and the last tenth."""
    part = np.clip(part, 0.0, 1.0)
    ease = 0.1
    middle = part - 0.5 * ease
    start, end = part**2 / (2.0 * ease), 1.0 - ease - (1.0 - part) ** 2 / (2.0 * ease)
    path = np.where(part < ease, start, np.where(part > 1.0 - ease, end, middle))
    return np.asarray(path / (1.0 - ease))
