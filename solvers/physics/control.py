"""What drives a simulated body: bounded proportional-derivative control towards a target."""

from dataclasses import dataclass
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from .body import PhysicsBody
from .target import States
from .world import GRAVITY, World

Array = NDArray[np.float64]
BASE = slice(0, 6)
HARDEST, HARDEST_TURN = 1.0, 30.0
"""Of the base: at most so much acceleration corrects an error, in g and in 1/s^2."""

SWEEPS = 8
RIDGE = 1e-3
"""Share by which a contact's force is held small, so that neighbours share the load."""

RELUCTANCE = 100.0
"""How much smaller it is held for arms and head: legs carry the body where they can."""

HELPING_LEVER = 1.0
LEVER = 1.0
"""Metres, for legs of 0.9 m: by it, torques on the base are weighed against forces."""


@dataclass(frozen=True, eq=False)
class Controller:
    """How hard a body is pulled towards its target.

    Attributes
    ----------
    stiffness, damping : float
        Acceleration per error (1/s^2) and per error of velocity (1/s): critically damped, and
        the same for all joints, for the mass that each moves is reckoned with.
    weight : float, newtons
    force, torque : float, newtons and newton metres
        At most so much helps the base from outside.
    strengths : shape (n_joints - 1,), newton metres
        At most so much turns each joint.
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


def controller(
    body: PhysicsBody, response: float, support: float, friction: float
) -> Controller:
    """Return the control of `response` hertz, helped by a share `support` of the weight."""
    omega = 2 * np.pi * response
    weight = body.mass * GRAVITY
    return Controller(
        stiffness=omega**2,
        damping=2 * omega,
        weight=weight,
        force=support * weight,
        torque=support * weight * HELPING_LEVER * body.size,
        strengths=body.strengths,
        friction=friction,
        size=body.size,
    )


def drive(
    engine: ModuleType,
    world: World,
    control: Controller,
    target: States,
) -> float:
    """Set the forces of one step; return that from outside as a share of the weight.

    The wanted acceleration follows equations 16 and 17 of [SHJT13], each error times a gain,
    and that of the target itself. Where the paper pulls every part of the body by an outside
    force, here joints turn by torques of their own, as muscles do; they are reckoned by inverse
    dynamics of a body whose base nothing drives but the ground under its feet, and a bounded
    help. What the help cannot give, the base does not get: the body falls, or tips.
    """
    model, data = world.model, world.data
    error, slip = np.empty(model.nv), target.velocities - data.qvel
    engine.mj_differentiatePos(model, error, 1.0, data.qpos, target.places)
    correction = control.damping * slip + control.stiffness * error
    correction[:3] = _at_most(correction[:3], HARDEST * GRAVITY)
    correction[3:6] = _at_most(correction[3:6], HARDEST_TURN)
    wanted = target.accelerations + correction
    inertia = np.empty((model.nv, model.nv))
    engine.mj_fullM(model, inertia, data.qM)
    contacts, burdens = _contacts(world)
    on_base = inertia[BASE] @ wanted + data.qfrc_bias[BASE]
    pushes = _ground_forces(contacts[:, BASE], burdens, on_base, control)
    from_ground = contacts.T @ pushes
    help_ = _bounded_help(on_base - from_ground[BASE], control)
    given = help_ + from_ground[BASE] - data.qfrc_bias[BASE]
    wanted[BASE] = np.linalg.solve(inertia[BASE, BASE], given - inertia[BASE, 6:] @ wanted[6:])
    torques = (inertia @ wanted + data.qfrc_bias - from_ground)[6:].reshape(-1, 3)
    norms = np.linalg.norm(torques, axis=1)
    torques *= np.minimum(1.0, control.strengths / np.maximum(norms, 1e-9))[:, None]
    data.qfrc_applied[BASE] = help_
    data.qfrc_applied[6:] = torques.ravel()
    return float(np.linalg.norm(help_[:3]) / control.weight)


def _contacts(world: World) -> tuple[Array, Array]:
    """Return Jacobians of the contacts, rows in threes, along the normal first, shape
    (3 n_contacts, n_velocities); and how reluctantly each row bears the body.
    """
    data = world.data
    weak = world.weak[data.contact.geom[data.contact.efc_address >= 0]].any(axis=1)
    burdens = np.repeat(np.where(weak, RELUCTANCE, 1.0), 3)
    return data.efc_J.reshape(-1, world.model.nv), burdens


def _ground_forces(
    contacts: Array, burdens: Array, wanted: Array, control: Controller
) -> Array:
    """Return the forces of contacts that would drive the base as wanted, as far as friction
    and the ground, which does not pull, allow: the least ones, shape (3 n_contacts,).

    Projected gradient descent from the solution without bounds.
    """
    if not len(contacts):
        return np.zeros(0)
    scale = np.repeat([1.0, 1.0 / (LEVER * control.size)], 3)
    A = (contacts * scale).T
    gram, wish = A.T @ A, A.T @ (wanted * scale)
    gram[np.diag_indices_from(gram)] += RIDGE * np.trace(gram) * burdens
    forces = _in_cones(np.linalg.solve(gram, wish), control.friction)
    step = 1.0 / np.sqrt((gram * gram).sum())
    for _ in range(SWEEPS):
        forces = _in_cones(forces - step * (gram @ forces - wish), control.friction)
    return forces


def _in_cones(forces: Array, friction: float) -> Array:
    """Return forces that neither pull nor hold sideways more than friction allows."""
    inside = forces.reshape(-1, 3).copy()
    normal = np.maximum(inside[:, 0], 0.0, out=inside[:, 0])
    sideways = np.hypot(inside[:, 1], inside[:, 2])
    inside[:, 1:] *= np.minimum(1.0, friction * normal / np.maximum(sideways, 1e-9))[:, None]
    return inside.ravel()


def _at_most(vector: Array, bound: float) -> Array:
    """Return a vector no longer than `bound`."""
    return vector * min(1.0, bound / max(float(np.linalg.norm(vector)), 1e-9))


def _bounded_help(wanted: Array, control: Controller) -> Array:
    return np.concatenate([
        _at_most(wanted[:3], control.force),
        _at_most(wanted[3:], control.torque),
    ])
