"""Clips with true rotations, as joint positions: true, with Kinect errors, and missing.

Elbow and knee axes of some makers are rotated about the limb by a constant (30 degrees
in the arms of CMU and HDM05). It is measured where limbs bend and taken out of the truth.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import NamedTuple

import numpy as np

from solvers.arrays import Array, Flags
from solvers.motion import JointRecording, Motion, find_humanoid_map, forward_kinematics
from solvers.motion.humanoid.canonical import t_pose_alignment
from solvers.motion.humanoid.posture_heading import normalize_postures, rotate_about_vertical
from solvers.motion.humanoid.posture_joints import POSTURE_JOINTS, postures_from_motion
from solvers.reconstruction.joint_rotations.trunk_twist import TWISTED_LIMBS, TwistedLimb
from solvers.rotations.representations import multiply, quaternion_from_rotation_vector, rotate
from solvers.workflows.reconstruct_motion import postures_recording
from solvers.workflows.standard_joints import KINECT_V1

from .kinect_folds import observed_postures, pairs, truth_of

TRUE, KINECT, LIMB_MISSING = "optical capture", "Kinect errors", "limb missing 1.5 s"
BENT = np.radians(30.0)
"""Bends from which on a maker's hinge is measured."""
HAND_ENDS, HANDS = (7, 11), (6, 10)
"""What UI-PRMD does not tell errs as the hand does."""
TAKE_STEP = 7
"""Takes from one of UI-PRMD whose errors are used to the next."""
SECONDS = 1.5
"""How long a limb is missing, seconds."""
MARGIN = 4
"""Frames at both ends of a clip without missing joints."""


class Truth(NamedTuple):
    """Bends in radians, (n_frames, 4), and rotations of `TWISTED_LIMBS`, (n_frames, 4, 4).

    Rotations are in the world, from a T-pose whose elbows bend forward.
    """

    bends: Array
    rotations: Array


@dataclass(frozen=True, eq=False)
class Case:
    """A clip, its observed joints, and which limbs in which frames are scored."""

    recording: JointRecording
    truth: Truth
    scored: Flags


def true_rotations(motions: Sequence[Motion]) -> list[Truth]:
    """Return the axial rotations of limbs in clips of one rig."""
    plain = [_as_made(motion) for motion in motions]
    off = np.zeros(len(TWISTED_LIMBS), complex)
    for (bends, rotations), normals in plain:
        for index, limb in enumerate(TWISTED_LIMBS):
            flexed = bends[:, index] > BENT
            world, normal = rotations[flexed, index], normals[flexed, index]
            axis, hinge = rotate(world, np.array(limb.along)), rotate(world, limb.hinge)
            sin = np.einsum("fi,fi->f", np.cross(hinge, normal), axis)
            cos = np.einsum("fi,fi->f", hinge, normal)
            off[index] += ((cos + 1j * sin) / np.hypot(cos, sin)).sum()
    corrections = quaternion_from_rotation_vector(
        np.angle(off)[:, None] * np.array([limb.along for limb in TWISTED_LIMBS])
    )
    return [Truth(made.bends, multiply(made.rotations, corrections)) for made, _ in plain]


def _as_made(motion: Motion) -> tuple[Truth, Array]:
    """Return what the maker says, and the normals of bends, (n_frames, 4, 3)."""
    humanoid = find_humanoid_map(motion.skeleton)
    joints = humanoid.indices(motion.skeleton)
    alignment = t_pose_alignment(motion.skeleton, humanoid)
    world = multiply(forward_kinematics(motion).rotations, alignment)
    postures = postures_from_motion(motion)
    directions = [_bone_directions(postures, limb) for limb in TWISTED_LIMBS]
    normals = np.stack([np.cross(*each) for each in directions], axis=1)
    cos = np.stack([np.einsum("fi,fi->f", *each) for each in directions], axis=1)
    bends = np.arctan2(np.linalg.norm(normals, axis=-1), cos)
    own = [joints[POSTURE_JOINTS[limb.upper]] for limb in TWISTED_LIMBS]
    return Truth(bends, world[:, own]), normals


def _bone_directions(postures: Array, limb: TwistedLimb) -> tuple[Array, Array]:
    first = postures[:, limb.lower] - postures[:, limb.upper]
    second = postures[:, limb.end] - postures[:, limb.lower]
    first /= np.linalg.norm(first, axis=-1, keepdims=True)
    return first, second / np.linalg.norm(second, axis=-1, keepdims=True)


@cache
def kinect_errors() -> tuple[Array, ...]:
    """Errors of complete takes less their means, in the actor's heading, (n_frames, 20, 3)."""
    found = []
    for pair in pairs()[::TAKE_STEP]:
        heading = normalize_postures(truth_of(pair), pair.truth.frame_rate).headings
        off = rotate_about_vertical(observed_postures(pair) - truth_of(pair), -heading)
        off[:, HAND_ENDS] = off[:, HANDS]
        if pair.matched and np.isfinite(off).all():
            found.append(off - off.mean(axis=0))
    return tuple(found)


def as_a_kinect_errs(motion: Motion, random: np.random.Generator) -> Array:
    """Add the errors of a take that is drawn, to and fro, to the joints of postures."""
    postures = postures_from_motion(motion)
    heading = normalize_postures(postures, motion.frame_rate).headings
    errors = kinect_errors()
    off = errors[random.integers(len(errors))]
    there_and_back = np.concatenate([off, off[::-1]])
    indices = (random.integers(len(off)) + np.arange(len(postures))) % len(there_and_back)
    return postures + rotate_about_vertical(there_and_back[indices], heading)


def cases(motions: Sequence[Motion], source: str) -> Iterator[Case]:
    """Yield the clips of one rig with one of the three inputs."""
    random = np.random.default_rng(4)
    for motion, truth in zip(motions, true_rotations(motions), strict=True):
        recording = postures_recording(motion)
        scored = np.ones(truth.bends.shape, bool)
        if source != TRUE:
            is_known = np.isfinite(postures_from_motion(motion)).all(axis=-1).any(axis=0)
            positions = as_a_kinect_errs(motion, random)[:, is_known]
            if source == LIMB_MISSING:
                scored = _remove_limbs(recording, positions, random)
            recording = replace(recording, tracks=recording.tracks.with_positions(positions))
        yield Case(recording, truth, scored)


def _remove_limbs(
    recording: JointRecording, positions: Array, random: np.random.Generator
) -> Flags:
    """Take out what is below one elbow and one knee, for a while; say which limbs and when."""
    n_frames = len(positions)
    length = min(round(SECONDS * recording.frame_rate), n_frames - 2 * MARGIN)
    missing = np.zeros((n_frames, len(TWISTED_LIMBS)), bool)
    for pair in ((0, 1), (2, 3)):
        index = int(random.choice(pair))
        start = int(random.integers(MARGIN, n_frames - length - MARGIN + 1))
        missing[start : start + length, index] = True
        limb = TWISTED_LIMBS[index]
        below = [limb.lower, limb.end, limb.end + 1]
        names = {KINECT_V1[POSTURE_JOINTS[joint]] for joint in below} & set(recording.names)
        for name in names:
            positions[start : start + length, recording.names.index(name)] = np.nan
    return missing
