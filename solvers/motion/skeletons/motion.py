"""Poses of a skeleton over time."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...arrays import row_blocks
from ...errors import InvalidMotionError
from .file_conventions import FileConventions
from .frame_rate import check_frame_rate
from .skeleton import MAX_DISTANCE_M, Skeleton

UNIT_TOLERANCE = 1e-3
"""Maximum deviation of a squared norm from 1, as a ratio, of what is a rotation. It guards
against damaged files."""
ROUNDING = 1e-14
"""Ratio to 1: norms this near to it are not normalized, so that unchanged rotations stay
identical bits. It absorbs rounding."""


@dataclass(frozen=True, eq=False)
class Motion:
    """Poses of a skeleton over time. NaN: missing.

    Attributes
    ----------
    skeleton : Skeleton
    rotations : float array, shape (n_frames, n_joints, 4), unit quaternions w x y z
        Local: rotates the parent's frame to the joint's frame; identity in the rest pose.
        Where any component is NaN, all four are.
    root_positions : float array, shape (n_frames, 3), meters, world space, Z up
    frame_rate : float, hertz
        Frame i is at time i / frame_rate.
    conventions : FileConventions or None
        How the file was interpreted that it was read from.
    """

    skeleton: Skeleton
    rotations: NDArray[np.float64]
    root_positions: NDArray[np.float64]
    frame_rate: float
    conventions: FileConventions | None = None

    def __post_init__(self) -> None:
        rotations = np.array(self.rotations, dtype=np.float64)
        root_positions = np.array(self.root_positions, dtype=np.float64)
        expected = (len(rotations), self.skeleton.n_joints, 4)
        if rotations.shape != expected or not len(rotations):
            raise InvalidMotionError(
                "A motion needs at least one frame and rotations of shape (n_frames,"
                f" {self.skeleton.n_joints}, 4), not {rotations.shape}."
            )
        if root_positions.shape != (len(rotations), 3):
            raise InvalidMotionError(
                f"A motion of {len(rotations)} frames needs root positions of shape"
                f" ({len(rotations)}, 3), not {root_positions.shape}."
            )
        check_frame_rate(self.frame_rate)
        if np.isinf(root_positions).any():
            raise InvalidMotionError("The root has infinite positions; NaN marks missing ones.")
        if (distance := np.nanmax(np.abs(root_positions), initial=0.0)) > MAX_DISTANCE_M:
            raise InvalidMotionError(
                f"The root is up to {distance:.3g} m from the origin; set the scale of the"
                " recording, or remove those frames."
            )
        self._normalize(rotations)
        object.__setattr__(self, "rotations", rotations)
        object.__setattr__(self, "root_positions", root_positions)
        object.__setattr__(self, "frame_rate", float(self.frame_rate))

    def _normalize(self, rotations: NDArray[np.float64]) -> None:
        """Normalize nearly unit rotations in place, block by block to save memory."""
        not_unit = np.zeros(self.skeleton.n_joints, dtype=np.bool_)
        for frames in row_blocks(len(rotations), rotations[:1].size):
            block = rotations[frames]
            norms = np.linalg.norm(block, axis=-1, keepdims=True)
            deviation = np.abs(norms - 1.0)
            not_unit |= (deviation > UNIT_TOLERANCE).any(axis=(0, 2))
            if not not_unit.any():
                np.divide(block, norms, out=block, where=~(deviation <= ROUNDING))
        if not_unit.any():
            names = [self.skeleton.names[joint] for joint in np.flatnonzero(not_unit)]
            raise InvalidMotionError(
                f"Rotations must be unit quaternions; these are not: {', '.join(names)}."
            )

    @property
    def n_frames(self) -> int:
        """Number of poses."""
        return len(self.rotations)

    @property
    def n_joints(self) -> int:
        """Number of joints, end sites included."""
        return self.skeleton.n_joints

    @property
    def dt(self) -> float:
        """Seconds from one frame to the next."""
        return 1.0 / self.frame_rate

    @property
    def observed(self) -> NDArray[np.bool_]:
        """Whether each joint's rotation is observed, shape (n_frames, n_joints).

        The root is observed only where its position is observed too.
        """
        observed = np.isfinite(self.rotations).all(axis=-1)
        observed[:, 0] &= np.isfinite(self.root_positions).all(axis=-1)
        return np.asarray(observed)

    def with_poses(
        self,
        rotations: NDArray[np.float64] | None = None,
        root_positions: NDArray[np.float64] | None = None,
    ) -> "Motion":
        """Return the motion with other rotations, root positions, or both."""
        return replace(
            self,
            rotations=self.rotations if rotations is None else rotations,
            root_positions=self.root_positions if root_positions is None else root_positions,
        )

    def slice(self, start: int, stop: int) -> "Motion":
        """Return frames `start` up to but without `stop`."""
        return self.with_poses(self.rotations[start:stop], self.root_positions[start:stop])
