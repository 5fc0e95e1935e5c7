"""Result of Clean, and how those of the segments of a take are joined."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Flags
from ..motion import Motion, Tracks
from ..motion.skeletons import describe_shots
from .edge_poses import EdgePose, describe_edge_poses
from .observed_samples import observed_mask


@dataclass(frozen=True, eq=False)
class Denoised:
    """A clean recording with the confidence of each joint."""

    recording: Motion | Tracks
    """Same joints or points, same frames. NaN remains only for points that neither the take nor
    the examples show."""
    outliers: Flags
    """True for samples of the input classified as spikes, shape (n_frames, n_joints)."""
    held: Flags
    """True for samples of the input that repeat the one before although the body moves on,
    shape (n_frames, n_joints). They are treated as missing (`find_held_samples`)."""
    confidence: Array
    """0 (a guess) to 1 (certain) for each cleaned joint, shape (n_frames, n_joints). It is
    one half where the standard deviation is 5 degrees or centimeters."""
    iterations: int
    converged: bool
    prior_used: str
    """Patterns that guided the estimate, and the reason; also what counts as a gap."""
    cuts: tuple[int, ...] = ()
    """First frame of each segment of a joined take, except the first segment."""
    edge_poses: tuple[EdgePose, ...] = ()
    """Limbs that were kept as recorded at the ends of the take."""

    def report(self, frames: Sequence[float] | None = None) -> str:
        """Return `prior_used`, and where poses were kept as recorded.

        Parameters
        ----------
        frames : sequence of float, length n_frames
            Numbers of the frames, such as those of a timeline; by default they count from 1.
        """
        return f"{self.prior_used} {self.describe_separate_poses(frames)}".strip()

    def describe_separate_poses(self, frames: Sequence[float] | None = None) -> str:
        """Return where the take was cut, and which poses were kept as recorded."""
        if frames is None:
            frames = range(1, self.recording.n_frames + 1)
        shots = describe_shots(self.recording, self.cuts, frames)
        return f"{shots} {describe_edge_poses(self.edge_poses, frames)}".strip()


def keep_as_recorded(segment: Motion | Tracks) -> Denoised:
    """Return the result of a segment that is kept as recorded."""
    none = np.zeros(observed_mask(segment).shape, dtype=np.bool_)
    return Denoised(segment, none, none, 1.0 - none, 0, True, "")


def join_segments(
    recording: Motion | Tracks, results: Sequence[Denoised], cuts: tuple[int, ...]
) -> Denoised:
    """Join the cleaned segments; the longest one reports which patterns were used."""
    cleaned = [part.recording for part in results]
    complete: Motion | Tracks
    if isinstance(recording, Motion):
        motions = [item for item in cleaned if isinstance(item, Motion)]
        complete = recording.with_poses(
            np.concatenate([motion.rotations for motion in motions]),
            np.concatenate([motion.root_positions for motion in motions]),
        )
    else:
        tracks = [item for item in cleaned if isinstance(item, Tracks)]
        complete = recording.with_positions(np.concatenate([item.positions for item in tracks]))
    longest_segment = max(
        results, key=lambda part: part.recording.n_frames * bool(part.prior_used)
    )
    return Denoised(
        complete,
        np.concatenate([part.outliers for part in results]),
        np.concatenate([part.held for part in results]),
        np.concatenate([part.confidence for part in results]),
        max(part.iterations for part in results),
        all(part.converged for part in results),
        longest_segment.prior_used,
        cuts,
    )
