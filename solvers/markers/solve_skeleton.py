"""Solve a skeleton's motion from the labelled markers of an optical take."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..motion import Motion, Skeleton, Tracks
from ..motion.rotations import quaternion_from_matrix, unroll
from ..progress import Progress, unwatched, within
from ..settings import Settings, setting
from .body import Body, Poses
from .build_body import build_body
from .centres import joint_centres
from .fit_poses import fit_poses
from .marker_sets import MarkerSet, find_marker_set

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class SolveSettings(Settings):
    """How a skeleton is solved from markers."""

    subject: str = setting("", "Whose markers, where a take has several people (Anna of Anna:LFHD)")


@dataclass(frozen=True, eq=False)
class SolvedSkeleton:
    """A body of the actor's measures in motion."""

    motion: Motion
    """Joints carry the VRM names of humanoid roles; the rest pose is the T-pose."""
    joint_centres: Tracks
    """Of all joints in the world."""
    error: Array
    """Metres from each marker to where the body has it, shape (n_frames, n_markers)."""
    marker_set: MarkerSet
    spots: tuple[str, ...]
    """Of the markers of `error`."""


def solve_skeleton(
    tracks: Tracks,
    *,
    settings: SolveSettings = SolveSettings(),
    progress: Progress = unwatched,
) -> SolvedSkeleton:
    """Solve."""
    found = find_marker_set(tracks.names, settings.subject or None)
    if lost := found.lacks():
        raise InvalidMotionError(f"lacks {lost}")
    place = {name: index for index, name in enumerate(tracks.names)}
    spots = {spot: tracks.positions[:, place[name]] for spot, name in found.markers.items()}
    centres = joint_centres(spots)
    body, turns = build_body(centres, spots)
    seen = np.stack([spots[marker.spot] for marker in body.markers], axis=1)
    poses = fit_poses(body, seen, Poses(turns, centres.places["hips"]), progress=progress)
    placed = body.place_in(poses)
    skeleton = Skeleton(tuple(j.name for j in body.joints), body.parents, body.offsets)
    motion = Motion(skeleton, unroll(quaternion_from_matrix(poses.turns)), poses.roots, tracks.frame_rate)
    return SolvedSkeleton(
        motion,
        Tracks(skeleton.names, placed.joints, tracks.frame_rate),
        np.linalg.norm(placed.markers - seen, axis=-1),
        found,
        tuple(m.spot for m in body.markers),
    )
