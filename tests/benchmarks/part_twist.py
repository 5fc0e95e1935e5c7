"""How far upper arms and thighs are twisted, from positions of joints alone.

Clips of optical systems whose rotations are known: actor dg of HDM05, whom no library that
ships knows, and actors of CMU, each with the library made anew without him. Their joints are
given as they were, or with the errors that a Kinect v2 made in takes of UI-PRMD (mean offsets taken
out, in the actor's heading). Makers' hinges are turned about limbs by a constant (30 degrees in
CMU's and HDM05's arms), which is measured where limbs bend and taken out of the truth.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from solvers.motion import (
    JointRecording,
    Motion,
    find_humanoid_map,
    forward_kinematics,
)
from solvers.motion.canonical import t_pose_alignment
from solvers.motion.posture_heading import normalise, turned
from solvers.motion.posture_joints import POSTURE_JOINTS, motion_postures
from solvers.motion.rotations import (
    multiply,
    quaternion_from_rotation_vector,
    rotate,
)
from solvers.reconstruction.trunk_twist import TWISTED, TwistedLimb
from solvers.workflows.reconstruct_motion import postures_recording

from .kinect_folds import pairs, seen_of, truth_of

Array = NDArray[np.float64]

STRAIGHT = np.radians(15.0)
"""Bends below this are those of straight limbs."""
BENT = np.radians(30.0)
"""Bends from which on a maker's hinge is measured."""


@dataclass(frozen=True, eq=False)
class Case:
    """A clip whose rotations are known, and its joints as they were seen."""

    name: str
    motion: Motion
    recording: JointRecording
    bends: Array
    """Radians, (n_frames, 4)."""
    truth: Array
    """World rotations of `TWISTED` from a T-pose whose elbows bend forward, (n_frames, 4, 4).
    """
    lower: Array
    """The same of forearms and shins."""


def true_rotations(motions: list[Motion]) -> list[tuple[Array, Array, Array]]:
    """Return bends, and world rotations of upper and lower limbs, of clips of one rig."""
    plain = [_plain(motion) for motion in motions]
    off = np.zeros(len(TWISTED), complex)
    for bends, upper, _, normals in plain:
        for place, limb in enumerate(TWISTED):
            bent = bends[:, place] > BENT
            axis, hinge = (
                rotate(upper[bent, place], each) for each in (limb.along, limb.hinge)
            )
            normal = normals[bent, place]
            sin = np.einsum("fi,fi->f", np.cross(hinge, normal), axis)
            cos = np.einsum("fi,fi->f", hinge, normal)
            off[place] += ((cos + 1j * sin) / np.hypot(cos, sin)).sum()
    turns = np.stack([
        quaternion_from_rotation_vector(np.angle(each) * np.array(limb.along))
        for limb, each in zip(TWISTED, off, strict=True)
    ])
    return [
        (bends, multiply(upper, turns), multiply(lower, turns))
        for bends, upper, lower, _ in plain
    ]


def _plain(motion: Motion) -> tuple[Array, Array, Array, Array]:
    humanoid = find_humanoid_map(motion.skeleton)
    joints = humanoid.indices(motion.skeleton)
    alignment = t_pose_alignment(motion.skeleton, humanoid)
    world = multiply(forward_kinematics(motion).rotations, alignment)
    postures = motion_postures(motion)
    ways = [_directions(postures, limb) for limb in TWISTED]
    normals = np.stack([np.cross(*each) for each in ways], axis=1)
    cos = np.stack([np.einsum("fi,fi->f", *each) for each in ways], axis=1)
    bends = np.arctan2(np.linalg.norm(normals, axis=-1), cos)
    upper, lower = (
        world[:, [joints[POSTURE_JOINTS[limb[part]]] for limb in TWISTED]] for part in (0, 1)
    )
    return bends, upper, lower, normals


def _directions(postures: Array, limb: TwistedLimb) -> tuple[Array, Array]:
    first = postures[:, limb.lower] - postures[:, limb.upper]
    second = postures[:, limb.end] - postures[:, limb.lower]
    return tuple(
        each / np.linalg.norm(each, axis=-1, keepdims=True) for each in (first, second)
    )


@cache
def kinect_errors() -> tuple[Array, ...]:
    """Errors of whole takes, in the actor's heading, beside their means, (n_frames, 20, 3)."""
    found = []
    for pair in pairs()[::7]:
        heading = normalise(truth_of(pair), pair.truth.frame_rate).headings
        off = turned(seen_of(pair) - truth_of(pair), -heading)
        off -= np.nanmean(off, axis=0) if np.isfinite(off).any() else 0.0
        if pair.matched and np.isfinite(np.delete(off, (7, 11), axis=1)).all():
            off[:, (7, 11)] = off[:, (6, 10)]
            found.append(off)
    return tuple(found)


def as_a_kinect_sees(motion: Motion, random: np.random.Generator) -> Array:
    """Add the errors of a take that was drawn, to and fro, to the joints of postures."""
    postures = motion_postures(motion)
    heading = normalise(postures, motion.frame_rate).headings
    errors = kinect_errors()
    off = errors[random.integers(len(errors))]
    there_and_back = np.concatenate([off, off[::-1]])
    places = (random.integers(len(off)) + np.arange(len(postures))) % len(there_and_back)
    return postures + turned(there_and_back[places], heading)


def cases(clips: dict[str, Motion], noisy: bool) -> Iterator[Case]:
    """Yield clips of one rig."""
    random = np.random.default_rng(4)
    told = true_rotations(list(clips.values()))
    for (name, motion), (bends, upper, lower) in zip(clips.items(), told, strict=True):
        recording = postures_recording(motion)
        if noisy:
            known = np.isfinite(motion_postures(motion)).all(axis=-1).any(axis=0)
            seen = as_a_kinect_sees(motion, random)[:, known]
            recording = replace(recording, tracks=recording.tracks.with_positions(seen))
        yield Case(name, motion, recording, bends, upper, lower)
