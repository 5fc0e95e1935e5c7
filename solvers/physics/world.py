"""A body of capsules on level ground, as a model of the engine MuJoCo."""

from collections.abc import Collection, Mapping
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..motion.humanoid import ARM_ROLES, SIDES
from .body import Capsule, PhysicsBody

GRAVITY = 9.81
"""Meters per second squared, by definition."""
WEAK_ROLES = {"neck", "head", *(side + part for side in SIDES for part in ARM_ROLES)}
CONTACT_TIME_S = 0.01
"""Seconds in which the ground pushes out a penetrating body. Half and twice gain less than 1 %
(`make sensitivity`)."""

SOLIMP = "0.95 0.995 0.002 0.5 2"
"""The engine's `solimp`: a foot is light, and the push of its leg must not sink it."""

ROTOR_INERTIA = 0.001
"""Rotor inertia of a joint per strength, in seconds squared, as of a geared motor. Without it,
feet are so light that a small error of the ground's force would rotate them. Chosen by hand;
`make sensitivity` varies it."""


class World(NamedTuple):
    """A model, its state, and the indices of joints in it."""

    model: Any
    data: Any
    ghost: Any
    """Another state, for the pose of the target."""
    bodies: NDArray[np.intp]
    """Index of each moving joint's body, in the order of `PhysicsBody.joints`."""
    feet: NDArray[np.bool_]
    """Whether each geometry belongs to the left and the right foot, shape (n_geometries, 2)."""
    weak: NDArray[np.bool_]
    """Whether each geometry belongs to an arm or the head, shape (n_geometries,)."""
    first_ends: NDArray[np.intp]
    """Index of each geometry's first end among those of `PhysicsBody.ground_capsules`, shape
    (n_geometries,)."""
    ground: float


def build_world(
    engine: ModuleType, body: PhysicsBody, ground: float, friction: float, timestep: float
) -> World:
    """Build the model: ball joints, and capsules that collide with the ground only."""
    sliding, contact_time = max(friction, 1e-5), max(CONTACT_TIME_S, 2 * timestep)
    names = {id(capsule): f"capsule{n}" for n, capsule in enumerate(body.capsules)}
    lines = [
        "<mujoco><compiler angle='radian' autolimits='false' boundmass='1e-9'"
        " boundinertia='1e-12'/>",
        f"<option timestep='{timestep!r}' integrator='implicitfast' cone='elliptic'"
        f" jacobian='dense' impratio='10' iterations='50' gravity='0 0 {-GRAVITY}'>"
        "<flag autoreset='disable'/></option>",
        f"<default><geom condim='3' priority='1' friction='{sliding!r} 0.005 0.0001'"
        f" solref='{contact_time!r} 1' solimp='{SOLIMP}'/><joint type='ball'/></default>",
        f"<worldbody><geom type='plane' size='0 0 1' priority='0' pos='0 0 {float(ground)!r}'"
        " contype='0' conaffinity='1'/>",
        _body_element(body, body.joints[0], names),
        "</worldbody></mujoco>",
    ]
    model = engine.MjModel.from_xml_string("".join(lines))
    bodies = np.array([model.body(f"joint{joint}").id for joint in body.joints])
    feet = [
        _geometries_of_roles(model, body, bodies, {f"{side}Foot", f"{side}Toes"})
        for side in SIDES
    ]
    weak = _geometries_of_roles(model, body, bodies, WEAK_ROLES)
    first_ends = np.zeros(model.ngeom, dtype=np.intp)
    for index, capsule in enumerate(body.ground_capsules):
        first_ends[model.geom(names[id(capsule)]).id] = 2 * index
    data, ghost = engine.MjData(model), engine.MjData(model)
    return World(model, data, ghost, bodies, np.stack(feet, axis=-1), weak, first_ends, ground)


def _body_element(body: PhysicsBody, joint: int, names: Mapping[int, str]) -> str:
    """Return the XML element of a joint's body with all its descendants."""
    is_base = joint == body.joints[0]
    frame = body.frames[joint]
    capsules = [capsule for capsule in body.capsules if capsule.joint == joint]
    below = [other for other in body.joints if body.frames[other].above == joint]
    return "".join([
        f"<body name='joint{joint}' pos='{_format_vector(frame.position)}'"
        f" quat='{_format_vector(frame.rotation)}'>",
        "<freejoint/>" if is_base else _joint_element(body, joint),
        *(_geometry_element(capsule, names[id(capsule)]) for capsule in capsules),
        *(_body_element(body, other, names) for other in below),
        "</body>",
    ])


def _joint_element(body: PhysicsBody, joint: int) -> str:
    strength = float(body.strengths[body.joints.index(joint) - 1])
    return f"<joint armature='{ROTOR_INERTIA * strength!r}'/>"


def _geometry_element(capsule: Capsule, name: str) -> str:
    meets = f"contype='{int(capsule.touches)}' conaffinity='0'"
    start, stop = capsule.ends
    common = (
        f"name='{name}' size='{float(capsule.radius)!r}' mass='{float(capsule.mass)!r}' {meets}"
    )
    if np.array_equal(start, stop):
        return f"<geom type='sphere' pos='{_format_vector(start)}' {common}/>"
    ends = f"{_format_vector(start)} {_format_vector(stop)}"
    return f"<geom type='capsule' fromto='{ends}' {common}/>"


def _format_vector(vector: NDArray[np.float64]) -> str:
    return " ".join(repr(float(value)) for value in vector)


def _geometries_of_roles(
    model: Any, body: PhysicsBody, bodies: NDArray[np.intp], roles: Collection[str]
) -> NDArray[np.bool_]:
    """Return which geometries belong to joints with these roles, shape (n_geometries,)."""
    indices = [
        index for index, joint in enumerate(body.joints) if body.roles.get(joint) in roles
    ]
    return np.isin(model.geom_bodyid, bodies[indices])
