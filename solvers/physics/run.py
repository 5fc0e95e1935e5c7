"""Let a body follow its target through time, and notice when it does not."""

from collections.abc import Callable
from dataclasses import dataclass
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from .control import Controller, drive
from .loads import add_loads
from .target import States, Target
from .world import World

Array = NDArray[np.float64]
FAR, PATIENCE = 0.35, 0.2
"""Metres, for legs of 0.9 m, and seconds: a body whose joints are on average farther from
their targets, for longer, is lost. For a moment it may be the target that is wrong."""

LOST = 1.0
"""Metres, for legs of 0.9 m: a body that is farther off is lost at once."""

FASTEST = 1e4
"""Metres or radians per second: nothing turns so fast but in a simulation that explodes."""

STRAYING = 0.15
"""Metres, for legs of 0.9 m: from here on, a body that is lost in the end was so before."""

HAIR = 0.001
"""Metres over the ground at which a body starts, lest rounding decides whether it touches."""


@dataclass(frozen=True, eq=False)
class Course:
    """What a simulated body did.

    Attributes
    ----------
    places : shape (n_frames, 3 + 4 n_joints)
        In the coordinates of `States.places`.
    support : shape (n_frames,)
        Force from outside, as a share of the weight.
    loads : shape (n_frames, n_ends)
        What the ground pushes up with at each end of `PhysicsBody.grounded`, likewise.
    followed : bool, shape (n_frames,)
        Where the body was near its target.
    n_lost : int
        How often it had to be put back there.
    """

    places: Array
    support: Array
    loads: Array
    followed: NDArray[np.bool_]
    n_lost: int


def follow(
    engine: ModuleType,
    world: World,
    control: Controller,
    target: Target,
    grips: Array,
    n_steps: int,
    n_ends: int,
    *,
    tell: Callable[[int], None],
) -> Course:
    """Simulate all frames; a body that is lost is put back onto its target and goes on.

    `tell` is called with the number of each frame.
    """
    n_frames = target.n_frames
    places = np.empty((n_frames, world.model.nq))
    support, apart, lost = np.zeros(n_frames), np.zeros(n_frames), []
    loads = np.zeros((n_frames, n_ends))
    far = 0
    for frame in range(n_frames):
        tell(frame)
        states = target.between(frame, n_steps)
        _grip(world, control, grips[frame])
        engine.mj_step1(world.model, world.data)
        apart[frame] = _apart(engine, world, states.places[0])
        far = far + 1 if apart[frame] > FAR * control.size else 0
        if frame == 0 or far * target.dt > PATIENCE or not apart[frame] <= LOST * control.size:
            far = 0
            _put(engine, world, states)
            lost += [frame] if frame else []
        places[frame] = world.data.qpos
        if frame < n_frames - 1:
            support[frame] = np.mean(_steps(engine, world, control, states, loads[frame]))
    support[-1], loads[-1] = support[max(n_frames - 2, 0)], loads[max(n_frames - 2, 0)]
    followed = _followed(apart, lost, STRAYING * control.size)
    return Course(places, support, loads, followed, len(lost))


def _followed(apart: Array, lost: list[int], near: float) -> NDArray[np.bool_]:
    """Return False for the frames in which the body was lost, and for those just before in
    which it strayed.
    """
    followed = np.ones(len(apart), dtype=np.bool_)
    for frame in lost:
        followed[frame] = False
        while frame > 0 and not apart[frame - 1] <= near:
            frame -= 1
            followed[frame] = False
    return followed


def _steps(
    engine: ModuleType, world: World, control: Controller, states: States, loads: Array
) -> list[float]:
    """Go from one frame to the next; return how much help each step used.

    Where the engine gave up, there is nothing left to drive; `_apart` will say so.
    """
    used: list[float] = []
    for step, moment in enumerate(zip(*states, strict=True)):
        if step:
            engine.mj_step1(world.model, world.data)
        if not _goes(world):
            return [*used, 0.0]
        used.append(drive(engine, world, control, States(*moment)))
        engine.mj_step2(world.model, world.data)
        if _goes(world):
            add_loads(world, loads, 1.0 / (control.weight * len(states.places)))
    return used


def _goes(world: World) -> bool:
    """Tell whether the engine has not given up."""
    return bool(np.abs(world.data.qvel).max() < FASTEST)


def _apart(engine: ModuleType, world: World, wanted: Array) -> float:
    """Return how far joints are on average from where they should be; infinite where the
    engine gave up.
    """
    data = world.data
    if not (_goes(world) and np.isfinite(data.qpos).all()) or np.any(data.warning.number):
        return np.inf
    world.ghost.qpos[:] = wanted
    engine.mj_kinematics(world.model, world.ghost)
    apart = data.xpos[world.bodies] - world.ghost.xpos[world.bodies]
    return float(np.linalg.norm(apart, axis=1).mean())


def _put(engine: ModuleType, world: World, states: States) -> None:
    """Put the body onto its target, just so high that nothing is under the ground."""
    model, data = world.model, world.data
    engine.mj_resetData(model, data)
    data.qpos[:], data.qvel[:] = states.places[0], states.velocities[0]
    engine.mj_kinematics(model, data)
    # A capsule reaches from its middle as far down as its axis leans, and its radius.
    down = model.geom_size[:, 0] + model.geom_size[:, 1] * np.abs(data.geom_xmat[:, 8])
    bottoms = (data.geom_xpos[:, 2] - down)[model.geom_contype > 0]
    data.qpos[2] += max(0.0, world.ground + HAIR - bottoms.min(initial=np.inf))
    engine.mj_step1(model, data)


def _grip(world: World, control: Controller, grips: Array) -> None:
    """Let each foot hold the ground as firmly as its target does."""
    for foot, grip in zip(world.feet.T, grips, strict=True):
        world.model.geom_friction[foot, 0] = max(control.friction * grip, 1e-5)
