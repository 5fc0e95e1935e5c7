"""Drive a simulated body by bounded proportional-derivative control toward a target."""

from dataclasses import dataclass
from types import ModuleType

import numpy as np

from ..arrays import Array
from .body import PhysicsBody
from .target import BodyStates
from .world import GRAVITY, World

BASE = slice(0, 6)
MAX_CORRECTION_G, MAX_ANGULAR_CORRECTION = 1.0, 30.0
"""Maximum acceleration of the base that corrects an error, in g and in 1/s^2. Chosen by hand;
`make sensitivity` varies them."""

N_ITERATIONS = 8
"""Chosen by hand; `make sensitivity` varies it."""
REGULARIZATION = 1e-3
"""Tikhonov regularization of contact forces, relative to their mean, so that neighbors share
the load. Chosen by hand; `make sensitivity` varies it."""
ARM_REGULARIZATION = 100.0
"""Factor on the regularization for arms and head: legs carry the body where they can. Sweep:
without it feet of HDM05 slide 12.7 cm/s instead of 10.9 where actors use their hands
(`test_legs_carry_the_body_where_arms_touch_too`)."""

HELP_LEVER_M = 1.0
"""Chosen by hand; `make sensitivity` varies it."""
TORQUE_LEVER_M = 1.0
"""Meters, for legs of 0.9 m: weighs torques on the base against forces. Half and twice are no
better (`make sensitivity`)."""


@dataclass(frozen=True, eq=False)
class Controller:
    """Gains and bounds of the control.

    Attributes
    ----------
    stiffness, damping : float
        Acceleration per error (1/s^2) and per velocity error (1/s). Critically damped, and the
        same for all joints, since the control includes the mass that each joint moves.
    weight : float, newtons
    force, torque : float, newtons and newton meters
        Maximum external force and torque on the base.
    strengths : shape (n_joints - 1,), newton meters
        Maximum torque of each joint.
    friction, size : float
    """

    stiffness: float
    damping: float
    weight: float
    force: float
    torque: float
    strengths: Array
    friction: float
    size: float


def build_controller(
    body: PhysicsBody, response: float, support: float, friction: float
) -> Controller:
    """Return a control of `response` hertz, supported by a fraction of the weight."""
    omega = 2 * np.pi * response
    weight = body.mass * GRAVITY
    return Controller(
        stiffness=omega**2,
        damping=2 * omega,
        weight=weight,
        force=support * weight,
        torque=support * weight * HELP_LEVER_M * body.size,
        strengths=body.strengths,
        friction=friction,
        size=body.size,
    )


def apply_control(
    engine: ModuleType,
    world: World,
    control: Controller,
    target: BodyStates,
) -> float:
    """Set the forces of one step; return the external force as a fraction of the weight.

    The desired acceleration follows equations 16 and 17 of [SHJT13], each error times a gain,
    plus the target's own acceleration. Where the paper pulls every part of the body by an
    external force, here joint torques act, as muscles do. They come from inverse dynamics of a
    body whose base is driven only by the ground under its feet and a bounded external force.
    What that force cannot supply, the base does not get: the body falls, or tips.
    """
    model, data = world.model, world.data
    error, velocity_error = np.empty(model.nv), target.velocities - data.qvel
    engine.mj_differentiatePos(model, error, 1.0, data.qpos, target.coordinates)
    correction = control.damping * velocity_error + control.stiffness * error
    correction[:3] = _limit_length(correction[:3], MAX_CORRECTION_G * GRAVITY)
    correction[3:6] = _limit_length(correction[3:6], MAX_ANGULAR_CORRECTION)
    desired_acceleration = target.accelerations + correction
    inertia = np.empty((model.nv, model.nv))
    engine.mj_fullM(model, inertia, data.qM)
    contacts, penalties = _contacts(world)
    required_force = inertia[BASE] @ desired_acceleration + data.qfrc_bias[BASE]
    contact_forces = _ground_forces(contacts[:, BASE], penalties, required_force, control)
    from_ground = contacts.T @ contact_forces
    external_force = _limit_external_force(required_force - from_ground[BASE], control)
    base_force = external_force + from_ground[BASE] - data.qfrc_bias[BASE]
    desired_acceleration[BASE] = np.linalg.solve(
        inertia[BASE, BASE], base_force - inertia[BASE, 6:] @ desired_acceleration[6:]
    )
    torques = (inertia @ desired_acceleration + data.qfrc_bias - from_ground)[6:].reshape(-1, 3)
    norms = np.linalg.norm(torques, axis=1)
    torques *= np.minimum(1.0, control.strengths / np.maximum(norms, 1e-9))[:, None]
    data.qfrc_applied[BASE] = external_force
    data.qfrc_applied[6:] = torques.ravel()
    return float(np.linalg.norm(external_force[:3]) / control.weight)


def _contacts(world: World) -> tuple[Array, Array]:
    """Return Jacobians of the contacts, rows in threes, along the normal first, shape
    (3 n_contacts, n_velocities); and the penalty on the force of each row."""
    data = world.data
    weak = world.weak[data.contact.geom[data.contact.efc_address >= 0]].any(axis=1)
    penalties = np.repeat(np.where(weak, ARM_REGULARIZATION, 1.0), 3)
    return data.efc_J.reshape(-1, world.model.nv), penalties


def _ground_forces(
    contacts: Array, penalties: Array, required_force: Array, control: Controller
) -> Array:
    """Return the smallest contact forces, (3 n_contacts,), that drive the base as required.

    Friction bounds them, and the ground does not pull. Projected gradient descent from the
    solution without bounds.
    """
    if not len(contacts):
        return np.zeros(0)
    scale = np.repeat([1.0, 1.0 / (TORQUE_LEVER_M * control.size)], 3)
    A = (contacts * scale).T
    gram, desired = A.T @ A, A.T @ (required_force * scale)
    gram[np.diag_indices_from(gram)] += REGULARIZATION * np.trace(gram) * penalties
    forces = _project_to_cones(np.linalg.solve(gram, desired), control.friction)
    step = 1.0 / np.sqrt((gram * gram).sum())
    for _ in range(N_ITERATIONS):
        forces = _project_to_cones(forces - step * (gram @ forces - desired), control.friction)
    return forces


def _project_to_cones(forces: Array, friction: float) -> Array:
    """Project forces into the friction cones: no pull, and bounded sideways force."""
    inside = forces.reshape(-1, 3).copy()
    normal = np.maximum(inside[:, 0], 0.0, out=inside[:, 0])
    sideways = np.hypot(inside[:, 1], inside[:, 2])
    inside[:, 1:] *= np.minimum(1.0, friction * normal / np.maximum(sideways, 1e-9))[:, None]
    return inside.ravel()


def _limit_length(vector: Array, bound: float) -> Array:
    """Return a vector no longer than `bound`."""
    return vector * min(1.0, bound / max(float(np.linalg.norm(vector)), 1e-9))


def _limit_external_force(required_force: Array, control: Controller) -> Array:
    return np.concatenate([
        _limit_length(required_force[:3], control.force),
        _limit_length(required_force[3:], control.torque),
    ])
