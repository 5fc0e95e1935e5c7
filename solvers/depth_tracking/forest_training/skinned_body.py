"""Skinned bodies: a mesh that follows a skeleton by linear blend skinning."""

import zipfile
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...errors import InvalidFileError, InvalidMotionError
from ...files import open_regular
from ...motion import (
    HumanoidMap,
    Motion,
    Skeleton,
    canonical_rotations,
    find_humanoid_map,
    from_canonical,
    world_poses,
)
from ...motion.humanoid import SIDES
from ...npz_members import READABLE, integers, numbers, read_members, words
from ...rotations import IDENTITY, matrix_from_quaternion
from ..forest import PARTS, SPLIT_SEGMENTS, parts_of_joints

MEMBERS = {
    "vertices": numbers("vertices", 3),
    "triangles": integers("triangles", 3),
    "weights": numbers("vertices", "joints", minimum=0.0),
    "joint_names": words("joints"),
    "parents": integers("joints", minimum=-1),
    "joint_heads": numbers("joints", 3),
}
"""Members of an archive with a skinned body."""


@dataclass(frozen=True, eq=False)
class SkinnedBody:
    """A mesh in the rest pose of its skeleton, Z up, facing -Y, meters.

    Attributes
    ----------
    skeleton : Skeleton
    vertices : shape (n_vertices, 3)
    triangles : int array, shape (n_triangles, 3)
        Counter-clockwise as seen from outside.
    weights : shape (n_vertices, n_joints)
        Skinning weight of each vertex and joint; sums to one per vertex.
    name : str
    """

    skeleton: Skeleton
    vertices: Array
    triangles: NDArray[np.int64]
    weights: Array
    name: str = ""

    def __post_init__(self) -> None:
        if fault := self._fault():
            raise InvalidMotionError(f"This skinned body cannot be used: {fault}.")
        sums = self.weights.sum(axis=1, keepdims=True)
        object.__setattr__(self, "weights", self.weights / sums)

    def _fault(self) -> str:
        n_vertices = len(self.vertices)
        if self.vertices.shape != (n_vertices, 3) or not np.isfinite(self.vertices).all():
            return "its vertices are not points"
        if self.weights.shape != (n_vertices, self.skeleton.n_joints):
            return "its weights do not fit its vertices and joints"
        if not (np.isfinite(self.weights).all() and (self.weights.sum(axis=1) > 0.0).all()):
            return "a vertex follows no joint"
        corners = self.triangles
        if corners.ndim != 2 or corners.shape[1] != 3 or not len(corners):
            return "it has no triangles"
        missing = corners.min() < 0 or corners.max() >= n_vertices
        return "corners of triangles are missing" if missing else ""

    @cached_property
    def humanoid(self) -> HumanoidMap:
        """Humanoid roles of the joints."""
        return find_humanoid_map(self.skeleton)

    @cached_property
    def vertex_parts(self) -> NDArray[np.uint8]:
        """Part of each vertex as index in `PARTS`, shape (n_vertices,)."""
        joints = self.humanoid.indices(self.skeleton)
        roles = {joint: role for role, joint in joints.items()}
        parts = parts_of_joints(roles, self.skeleton.parents)
        found: NDArray[np.uint8] = parts[self.weights.argmax(axis=1)]
        rest = self.skeleton.rest_positions
        for side in SIDES:
            for segment, end in zip(SPLIT_SEGMENTS, ("LowerLeg", "Foot"), strict=True):
                if f"{side}{segment}" not in joints or f"{side}{end}" not in joints:
                    continue
                head, tail = rest[joints[f"{side}{segment}"]], rest[joints[f"{side}{end}"]]
                outer = (self.vertices - (head + tail) / 2.0) @ (tail - head) > 0.0
                inner_part = PARTS.index(f"{side}{segment}")
                found[outer & (found == inner_part)] = PARTS.index(f"{side}{segment}End")
        return found

    @cached_property
    def vertex_normals(self) -> Array:
        """Outward unit normal of each vertex, shape (n_vertices, 3)."""
        a, b, c = self.vertices[self.triangles.T]
        faces = np.cross(b - a, c - a)
        normals = np.zeros_like(self.vertices)
        for corner in self.triangles.T:
            np.add.at(normals, corner, faces)
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
        return np.asarray(normals / np.maximum(lengths, 1e-12))

    def pose(self, rotations: Array, root: Array) -> tuple[Array, Array]:
        """Return vertices (n_vertices, 3) and joints (n_joints, 3) in one pose.

        Linear blend skinning moves each vertex by the weighted mean of its joint transforms.
        `rotations` are local, shape (n_joints, 4); `root` is the root position, meters.
        """
        orientations, positions = world_poses(self.skeleton, rotations, root)
        matrices = matrix_from_quaternion(orientations)
        shifts = positions - np.einsum("jab,jb->ja", matrices, self.skeleton.rest_positions)
        moves = np.concatenate([matrices, shifts[:, :, None]], axis=2).reshape(-1, 12)
        blended = (self.weights @ moves).reshape(-1, 3, 4)
        rotated = np.einsum("vab,vb->va", blended[:, :, :3], self.vertices)
        return rotated + blended[:, :, 3], positions

    def rotations_of(self, motion: Motion) -> Array:
        """Return this body's local rotations in the poses of any humanoid, (F, n_joints, 4).

        Joints are matched by humanoid role, and rest poses by the T-pose; joints that the
        motion lacks, and rotations that were not observed, are as in the T-pose.
        """
        theirs = find_humanoid_map(motion.skeleton)
        columns = theirs.indices(motion.skeleton)
        posed = canonical_rotations(motion, theirs)
        poses = np.tile(IDENTITY, (motion.n_frames, self.skeleton.n_joints, 1))
        for role, joint in self.humanoid.indices(self.skeleton).items():
            if role in columns:
                observed = np.isfinite(posed[:, columns[role]]).all(axis=-1)
                poses[observed, joint] = posed[observed, columns[role]]
        return from_canonical(poses, self.skeleton, self.humanoid)


def load_skinned_body(path: Path | str) -> SkinnedBody:
    """Read a skinned body from npz: vertices, triangles, weights, joint names, parents, heads.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or holds no skinned body.
    """
    try:
        with open_regular(path) as file, zipfile.ZipFile(file) as archive:
            arrays = read_members(archive, MEMBERS)
        heads = arrays["joint_heads"].astype(np.float64)
        parents = tuple(arrays["parents"].tolist())
        above = np.array([
            heads[parent] if parent >= 0 else 0.0 * heads[0] for parent in parents
        ])
        return SkinnedBody(
            Skeleton(tuple(arrays["joint_names"].tolist()), parents, heads - above),
            arrays["vertices"].astype(np.float64),
            arrays["triangles"].astype(np.int64),
            arrays["weights"].astype(np.float64),
            Path(path).stem,
        )
    except FileNotFoundError:
        raise InvalidFileError(f"There is no file {path}.") from None
    except READABLE as error:
        raise InvalidFileError(f"{path} holds no skinned body ({error}).") from None
