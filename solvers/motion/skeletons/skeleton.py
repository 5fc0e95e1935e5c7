"""A tree of named joints with its rest pose."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError

MAX_DISTANCE_M = 1e9
"""No capture is larger: a larger value has a wrong unit, and its square may overflow. It guards
against damaged files."""
MIN_BONE_M = 1e-3
"""Meters: a shorter bone has no direction. It guards joints at one position up to the rounding
of a file or a device (`test_coincident_joints_define_no_direction`)."""


@dataclass(frozen=True, eq=False)
class Skeleton:
    """Named joints, their hierarchy, and their offsets in the rest pose.

    Rest-pose axes of every joint are the world's: Z up, right-handed; the character faces -Y.

    Attributes
    ----------
    names : tuple of str, length n_joints, all different
    parents : tuple of int, length n_joints
        Index of each joint's parent, which comes before it; -1 for the root, which is joint 0
        and the only one without a parent.
    offsets : float array, shape (n_joints, 3), meters
        From the parent's joint center to the joint's, in the rest pose. The root's is its rest
        position.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    offsets: NDArray[np.float64]

    def __post_init__(self) -> None:
        object.__setattr__(self, "names", tuple(self.names))
        object.__setattr__(self, "parents", tuple(int(parent) for parent in self.parents))
        object.__setattr__(self, "offsets", np.array(self.offsets, dtype=np.float64))
        if faults := self._faults():
            raise InvalidMotionError(" ".join(faults))

    def _faults(self) -> list[str]:
        n_joints = len(self.names)
        if not n_joints:
            return ["A skeleton needs at least one joint."]
        faults = []
        duplicates = sorted(name for name, count in Counter(self.names).items() if count > 1)
        if duplicates:
            faults.append(f"Joint names must be unique; duplicates: {', '.join(duplicates)}.")
        if len(self.parents) != n_joints or self.offsets.shape != (n_joints, 3):
            faults.append(
                f"A skeleton of {n_joints} joints needs as many parents"
                f" (not {len(self.parents)}) and offsets of shape ({n_joints}, 3)"
                f" (not {self.offsets.shape})."
            )
        elif not np.isfinite(self.offsets).all():
            faults.append("The rest pose has offsets that are not finite numbers.")
        elif np.abs(self.offsets).max() > MAX_DISTANCE_M:
            faults.append(
                f"The rest pose has a bone of {np.abs(self.offsets).max():.3g} m; set the"
                " scale of the file, or correct that bone."
            )
        if self.parents and self.parents[0] != -1:
            faults.append("The first joint must be the root (parent -1).")
        misordered = [
            name
            for joint, (name, parent) in enumerate(zip(self.names, self.parents, strict=False))
            if joint and not 0 <= parent < joint
        ]
        if misordered:
            faults.append(f"A parent must come before its children: {', '.join(misordered)}.")
        return faults

    @property
    def n_joints(self) -> int:
        """Number of joints, end sites included."""
        return len(self.names)

    @cached_property
    def children(self) -> tuple[tuple[int, ...], ...]:
        """Indices of each joint's children."""
        result: list[list[int]] = [[] for _ in self.names]
        for joint, parent in enumerate(self.parents):
            if parent >= 0:
                result[parent].append(joint)
        return tuple(tuple(joints) for joints in result)

    @cached_property
    def depths(self) -> NDArray[np.intp]:
        """Number of joints above each joint, shape (n_joints,)."""
        depths = np.zeros(self.n_joints, dtype=np.intp)
        for joint, parent in enumerate(self.parents[1:], start=1):
            depths[joint] = depths[parent] + 1
        return depths

    @cached_property
    def rest_positions(self) -> NDArray[np.float64]:
        """Joint centers in the rest pose, shape (n_joints, 3), meters."""
        positions = self.offsets.copy()
        for joint, parent in enumerate(self.parents[1:], start=1):
            positions[joint] += positions[parent]
        return positions

    @property
    def height(self) -> float:
        """Vertical extent of the rest pose, meters."""
        return float(np.ptp(self.rest_positions[:, 2]))

    @property
    def extent(self) -> float:
        """Longest side of the box around the rest pose, meters; 1 for a single point."""
        return float(np.ptp(self.rest_positions, axis=0).max()) or 1.0

    def index(self, name: str) -> int:
        """Return the joint called `name`; raises InvalidMotionError where there is none."""
        try:
            return self.names.index(name)
        except ValueError:
            raise InvalidMotionError(
                f"There is no joint {name}; the skeleton has {', '.join(self.names)}."
            ) from None

    def ancestors(self, joint: int) -> list[int]:
        """Return the joints above `joint`, nearest first."""
        result = []
        while (joint := self.parents[joint]) >= 0:
            result.append(joint)
        return result

    def subtree(self, joint: int) -> list[int]:
        """Return `joint` and all joints below it, in order of index."""
        inside = {joint}
        for later in range(joint + 1, self.n_joints):
            if self.parents[later] in inside:
                inside.add(later)
        return sorted(inside)

    def is_end_site(self, joint: int) -> bool:
        """Whether the joint is an end site (named `<parent>_end`), which never rotates."""
        return self.names[joint].endswith("_end") and not self.children[joint]

    def same_joints(self, other: "Skeleton") -> bool:
        """Whether both have the same names in the same tree (lengths may differ)."""
        return self.names == other.names and self.parents == other.parents

    def select(self, joints: Sequence[int]) -> "Skeleton":
        """Return the skeleton of these joints; the root must be among them.

        A joint whose parent is left out becomes a child of its nearest selected ancestor.
        """
        new_index = {joint: index for index, joint in enumerate(joints)}
        parents, offsets = [], []
        for joint in joints:
            kept = next((up for up in self.ancestors(joint) if up in new_index), -1)
            parents.append(new_index.get(kept, -1))
            start = self.rest_positions[kept] if kept >= 0 else np.zeros(3)
            offsets.append(self.rest_positions[joint] - start)
        names = tuple(self.names[joint] for joint in joints)
        return Skeleton(names, tuple(parents), np.array(offsets))
