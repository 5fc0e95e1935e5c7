"""A body of capsules on level ground, as a model of the engine MuJoCo."""

from collections.abc import Collection, Mapping
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .body import Capsule, PhysicsBody
from .tables import ARM

GRAVITY = 9.81
SIDES = ("left", "right")
WEAK = {"neck", "head", *(side + part for side in SIDES for part in ARM)}
SOFTNESS = 0.01
"""Seconds in which the ground pushes out what sinks into it."""

HARDNESS = "0.95 0.995 0.002 0.5 2"
"""The engine's `solimp`: a foot is light, and what its leg pushes with must not sink it."""

ROTOR = 0.001
"""Seconds squared: by it and its strength, a joint has inertia of its own, as a geared motor
has. Without it, feet are so light that a small error of the ground's force would turn them."""


class World(NamedTuple):
    """A model, its state, and which number each joint has in it."""

    model: Any
    data: Any
    ghost: Any
    """Another state, to see where the target is."""
    bodies: NDArray[np.intp]
    """Number of each moving joint's body, in the order of `PhysicsBody.joints`."""
    feet: NDArray[np.bool_]
    """Whether each geometry is of the left foot, of the right foot, shape (n_geometries, 2)."""
    weak: NDArray[np.bool_]
    """Whether each geometry is of an arm or of the head, shape (n_geometries,)."""
    first_ends: NDArray[np.intp]
    """Number of each geometry's first end among those of `PhysicsBody.grounded`, shape
    (n_geometries,)."""
    ground: float


def build_world(
    engine: ModuleType, body: PhysicsBody, ground: float, friction: float, timestep: float
) -> World:
    """Build the model: ball joints, capsules that meet the ground but not each other."""
    rub, softness = max(friction, 1e-5), max(SOFTNESS, 2 * timestep)
    names = {id(capsule): f"capsule{n}" for n, capsule in enumerate(body.capsules)}
    lines = [
        "<mujoco><compiler angle='radian' autolimits='false' boundmass='1e-9'"
        " boundinertia='1e-12'/>",
        f"<option timestep='{timestep!r}' integrator='implicitfast' cone='elliptic'"
        f" jacobian='dense' impratio='10' iterations='50' gravity='0 0 {-GRAVITY}'>"
        "<flag autoreset='disable'/></option>",
        f"<default><geom condim='3' priority='1' friction='{rub!r} 0.005 0.0001'"
        f" solref='{softness!r} 1' solimp='{HARDNESS}'/><joint type='ball'/></default>",
        f"<worldbody><geom type='plane' size='0 0 1' priority='0' pos='0 0 {float(ground)!r}'"
        " contype='0' conaffinity='1'/>",
        _nested(body, body.joints[0], names),
        "</worldbody></mujoco>",
    ]
    model = engine.MjModel.from_xml_string("".join(lines))
    bodies = np.array([model.body(f"joint{joint}").id for joint in body.joints])
    feet = [_of_parts(model, body, bodies, {f"{side}Foot", f"{side}Toes"}) for side in SIDES]
    weak = _of_parts(model, body, bodies, WEAK)
    first_ends = np.zeros(model.ngeom, dtype=np.intp)
    for place, capsule in enumerate(body.grounded):
        first_ends[model.geom(names[id(capsule)]).id] = 2 * place
    data, ghost = engine.MjData(model), engine.MjData(model)
    return World(model, data, ghost, bodies, np.stack(feet, axis=-1), weak, first_ends, ground)


def _nested(body: PhysicsBody, joint: int, names: Mapping[int, str]) -> str:
    """Return the element of a joint's body with all that hang on it."""
    is_base = joint == body.joints[0]
    frame = body.frames[joint]
    capsules = [capsule for capsule in body.capsules if capsule.joint == joint]
    below = [other for other in body.joints if body.frames[other].above == joint]
    return "".join([
        f"<body name='joint{joint}' pos='{_words(frame.place)}'"
        f" quat='{_words(frame.rotation)}'>",
        "<freejoint/>" if is_base else _ball(body, joint),
        *(_geometry(capsule, names[id(capsule)]) for capsule in capsules),
        *(_nested(body, other, names) for other in below),
        "</body>",
    ])


def _ball(body: PhysicsBody, joint: int) -> str:
    strength = float(body.strengths[body.joints.index(joint) - 1])
    return f"<joint armature='{ROTOR * strength!r}'/>"


def _geometry(capsule: Capsule, name: str) -> str:
    meets = f"contype='{int(capsule.touches)}' conaffinity='0'"
    start, stop = capsule.ends
    common = (
        f"name='{name}' size='{float(capsule.radius)!r}' mass='{float(capsule.mass)!r}' {meets}"
    )
    if np.array_equal(start, stop):
        return f"<geom type='sphere' pos='{_words(start)}' {common}/>"
    return f"<geom type='capsule' fromto='{_words(start)} {_words(stop)}' {common}/>"


def _words(vector: NDArray[np.float64]) -> str:
    return " ".join(repr(float(value)) for value in vector)


def _of_parts(
    model: Any, body: PhysicsBody, bodies: NDArray[np.intp], roles: Collection[str]
) -> NDArray[np.bool_]:
    """Tell which geometries are of joints with these roles, shape (n_geometries,)."""
    places = [
        place for place, joint in enumerate(body.joints) if body.roles.get(joint) in roles
    ]
    return np.isin(model.geom_bodyid, bodies[places])
