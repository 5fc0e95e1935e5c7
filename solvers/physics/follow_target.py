"""Simulate a body that follows its target, and detect when it does not."""

from collections.abc import Callable
from dataclasses import dataclass
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from .contact_loads import add_loads
from .control import Controller, apply_control
from .target import BodyStates, TargetCurve
from .world import World

MAX_MEAN_DISTANCE_M, MAX_DISTANCE_S = 0.35, 0.2
"""A body is lost if the mean distance of its joints from their targets exceeds this, for legs
of 0.9 m, for longer than these seconds. Briefly, the target itself may be wrong. They guard
takes that no body can follow (`test_frames_not_followed_are_those_of_the_take`)."""

DRIFT_DISTANCE_M = 0.15
"""Meters, for legs of 0.9 m: frames just before a loss count as lost from this distance on. It
guards takes that no body can follow (`test_frames_not_followed_are_those_of_the_take`)."""

START_CLEARANCE_M = 0.001
"""Meters above the ground at which a body starts, so that rounding does not decide contact.
Half and twice gain less than 1 % (`make sensitivity`)."""


@dataclass(frozen=True, eq=False)
class SimulatedTrajectory:
    """Trajectory of a simulated body.

    Attributes
    ----------
    coordinates : shape (n_frames, 3 + 4 n_joints)
        As in `BodyStates.coordinates`.
    support : shape (n_frames,)
        External force, as a fraction of the weight.
    loads : shape (n_frames, n_ends)
        Upward ground force at each end of `PhysicsBody.ground_capsules`, likewise.
    followed : bool, shape (n_frames,)
        Frames in which the body was near its target.
    n_resets : int
        Number of resets to the target.
    """

    coordinates: Array
    support: Array
    loads: Array
    followed: NDArray[np.bool_]
    n_resets: int


def follow_target(
    engine: ModuleType,
    world: World,
    control: Controller,
    target: TargetCurve,
    friction_factors: Array,
    n_steps: int,
    n_ends: int,
    *,
    report_frame: Callable[[int], None],
) -> SimulatedTrajectory:
    """Simulate all frames; reset a lost body to its target and continue.

    `report_frame` is called with the index of each frame. `friction_factors` has the shape
    (n_frames, n_feet).
    """
    n_frames = target.n_frames
    coordinates = np.empty((n_frames, world.model.nq))
    support, distances, reset_frames = np.zeros(n_frames), np.zeros(n_frames), []
    loads = np.zeros((n_frames, n_ends))
    n_far = 0
    for frame in range(n_frames):
        report_frame(frame)
        states = target.between(frame, n_steps)
        _set_friction(world, control, friction_factors[frame])
        engine.mj_step1(world.model, world.data)
        distances[frame] = _mean_distance(engine, world, states.coordinates[0])
        n_far = n_far + 1 if distances[frame] > MAX_MEAN_DISTANCE_M * control.size else 0
        is_reset = n_far * target.dt > MAX_DISTANCE_S or np.isinf(distances[frame])
        if frame == 0 or is_reset:
            n_far = 0
            _reset_to_target(engine, world, states)
            reset_frames += [frame] if frame else []
        coordinates[frame] = world.data.qpos
        if frame < n_frames - 1:
            support[frame] = np.mean(
                _simulate_frame(engine, world, control, states, loads[frame])
            )
    support[-1], loads[-1] = support[max(n_frames - 2, 0)], loads[max(n_frames - 2, 0)]
    followed = _followed_frames(distances, reset_frames, DRIFT_DISTANCE_M * control.size)
    return SimulatedTrajectory(coordinates, support, loads, followed, len(reset_frames))


def _followed_frames(
    distances: Array, reset_frames: list[int], max_distance: float
) -> NDArray[np.bool_]:
    """Return False for the frames of a loss, and for those just before with a large
    distance."""
    followed = np.ones(len(distances), dtype=np.bool_)
    for frame in reset_frames:
        followed[frame] = False
        while frame > 0 and not distances[frame - 1] <= max_distance:
            frame -= 1
            followed[frame] = False
    return followed


def _simulate_frame(
    engine: ModuleType, world: World, control: Controller, states: BodyStates, loads: Array
) -> list[float]:
    """Simulate the steps to the next frame; return the external force of each.

    An unstable simulation stops here; `_mean_distance` then reports the loss.
    """
    external_forces: list[float] = []
    for step, state in enumerate(zip(*states, strict=True)):
        if step:
            engine.mj_step1(world.model, world.data)
        if not _is_stable(world):
            return [*external_forces, 0.0]
        external_forces.append(apply_control(engine, world, control, BodyStates(*state)))
        engine.mj_step2(world.model, world.data)
        if _is_stable(world):
            add_loads(world, loads, 1.0 / (control.weight * len(states.coordinates)))
    return external_forces


def _is_stable(world: World) -> bool:
    """Return whether the engine is stable."""
    return bool(np.isfinite(world.data.qvel).all())


def _mean_distance(engine: ModuleType, world: World, target_coordinates: Array) -> float:
    """Return the mean distance of joints from their targets; infinite if unstable."""
    data = world.data
    if not (_is_stable(world) and np.isfinite(data.qpos).all()) or np.any(data.warning.number):
        return np.inf
    world.ghost.qpos[:] = target_coordinates
    engine.mj_kinematics(world.model, world.ghost)
    offsets = data.xpos[world.bodies] - world.ghost.xpos[world.bodies]
    return float(np.linalg.norm(offsets, axis=1).mean())


def _reset_to_target(engine: ModuleType, world: World, states: BodyStates) -> None:
    """Place the body on its target, raised just above the ground."""
    model, data = world.model, world.data
    engine.mj_resetData(model, data)
    data.qpos[:], data.qvel[:] = states.coordinates[0], states.velocities[0]
    engine.mj_kinematics(model, data)
    # A capsule reaches from its middle as far down as its axis leans, and its radius.
    down = model.geom_size[:, 0] + model.geom_size[:, 1] * np.abs(data.geom_xmat[:, 8])
    lowest_points = (data.geom_xpos[:, 2] - down)[model.geom_contype > 0]
    data.qpos[2] += max(
        0.0, world.ground + START_CLEARANCE_M - lowest_points.min(initial=np.inf)
    )
    engine.mj_step1(model, data)


def _set_friction(world: World, control: Controller, friction_factors: Array) -> None:
    """Set the friction of each foot from its target's factor."""
    for foot, factor in zip(world.feet.T, friction_factors, strict=True):
        world.model.geom_friction[foot, 0] = max(control.friction * factor, 1e-5)
