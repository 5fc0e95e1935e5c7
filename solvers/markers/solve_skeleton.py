"""Solve a skeleton's motion from the labelled markers of an optical take."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..motion import Motion, Skeleton, Tracks
from ..progress import Progress, unwatched, within
from ..rotations import quaternion_from_matrix, unroll
from ..settings import Settings, setting
from .body import Body, Poses
from .build_body import build_body
from .centres import joint_centres
from .fit_body import fit_body
from .fit_poses import fit_poses
from .known_joints import known_joints
from .marker_sets import PELVIS, MarkerSet, find_marker_set

Array = NDArray[np.float64]
NEARLY_ALL = 0.95
"""Of the markers seen at best: frames with so many may tell the body's measures."""
FAR_OFF, FAR_OFF_AT_LEAST = 3.0, 0.02
"""Times the usual error, and metres, from which on a pose is sought again."""


@dataclass(frozen=True, kw_only=True)
class SolveSettings(Settings):
    """How a skeleton is solved from markers."""

    subject: str = setting(
        "",
        "Subject of the markers in a take of several people: Anna for Anna:LFHD",
    )
    measured_frames: int = setting(
        80, "Frames used to measure the body; more is slower and covers more poses",
        minimum=10, maximum=1000, advanced=True,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class SolvedSkeleton:
    """A body of the actor's measures in motion."""

    motion: Motion
    """Joints carry VRM's names of humanoid roles; the rest pose is the T-pose, facing -Y."""
    joint_centres: Tracks
    """All joints in the world, by the same names; NaN where not known."""
    error: Array
    """From each marker to where the body has it, shape (n_frames, n_markers), metres; NaN where
    the marker is not seen."""
    markers: tuple[str, ...]
    """Names of the markers of `error` in the take."""
    marker_set: MarkerSet
    """Which markers were taken for which."""


def solve_skeleton(
    tracks: Tracks,
    *,
    settings: SolveSettings = SolveSettings(),
    progress: Progress = unwatched,
) -> SolvedSkeleton:
    """Find joint centres and joint angles from labelled markers.

    A usual body is measured by regressions, then fitted, with the seats of its markers, to
    frames of the take, so that joints come to lie where bones turn about them (`fit_body`).
    Then every frame is solved for itself (`fit_poses`), and what is not seen counts nothing.
    The feet stand level where heel and toe markers are lowest. Toes do not turn.

    Parameters
    ----------
    tracks : Tracks
        Markers of a set known here (`find_marker_set`); others are left out. Swapped markers
        should be put right before (`unswap_markers`).
    settings : SolveSettings
    progress : Progress

    Returns
    -------
    SolvedSkeleton
        Parts of the body that the set has no markers for are left out. A joint of which a
        frame shows nothing is NaN there.

    Raises
    ------
    InvalidMotionError
        Markers of the pelvis or the legs are missing, or never seen together.
    SolveCancelled
        Raised by `progress`.
    """
    found = find_marker_set(tracks.names, settings.subject or None)
    spots = _spots(tracks, found)
    progress(0.02, "Guessing joint centres")
    centres = joint_centres(spots)
    body, turns = build_body(centres, spots)
    seen = np.stack([spots[marker.spot] for marker in body.markers], axis=1)
    first = _carried_over(turns, centres.places["hips"], seen)
    progress(0.1, "Measuring the body")
    body = _measured(body, seen, first, settings, within(progress, 0.1, 0.4))
    poses = fit_poses(body, seen, first, progress=within(progress, 0.4, 0.9))
    poses = _again_where_far_off(body, seen, poses)
    progress(0.95, "Telling what is known")
    solved = _solved(body, seen, poses, tracks, found)
    progress(1.0, "Telling what is known")
    return solved


def _spots(tracks: Tracks, found: MarkerSet) -> dict[str, Array]:
    """Return the positions of the markers of a set, by spot, without those never seen."""
    place = {name: index for index, name in enumerate(tracks.names)}
    positions = {spot: tracks.positions[:, place[name]] for spot, name in found.markers.items()}
    pelvis = [_seen(positions[spot]) for spot in PELVIS[:2] if spot in positions]
    together = np.logical_and.reduce([np.ones(tracks.n_frames, dtype=bool), *pelvis])
    spots = {
        spot: track for spot, track in positions.items() if (_seen(track) & together).any()
    }
    lost = MarkerSet(found.name, dict.fromkeys(spots, ""), found.score).lacks()
    if lost:
        known = f" It looks like {found.name}." if found.name else ""
        raise InvalidMotionError(
            "A skeleton needs the labelled markers of pelvis and legs of the Plug-in-Gait or"
            f" CMU set; missing or never seen with the pelvis: {', '.join(lost)}.{known} Label"
            " them first."
        )
    _refuse_if_never_together(spots)
    return spots


def _seen(positions: Array) -> NDArray[np.bool_]:
    return np.asarray(np.isfinite(positions).all(axis=-1))


def _refuse_if_never_together(spots: Mapping[str, Array]) -> None:
    """Raise where no frame shows the pelvis along with a whole leg."""
    pelvis = [spot for spot in PELVIS if spot in spots]
    if {"LPSI", "RPSI"} <= set(pelvis):
        pelvis = list(PELVIS[:4])
    for side in "LR":
        needed = [*pelvis, *(side + spot for spot in ("KNE", "ANK", "TOE"))]
        if not np.logical_and.reduce([_seen(spots[spot]) for spot in needed]).any():
            raise InvalidMotionError(
                f"No frame shows all of {', '.join(needed)}; fill their gaps first."
            )


def _carried_over(turns: Array, roots: Array, seen: Array) -> Poses:
    """Begin where the first guess knows nothing from the nearest frame that it knows.

    The root moves on as the markers do that both frames show.
    """
    known = np.flatnonzero(np.isfinite(roots).all(axis=-1))
    turns, roots = turns.copy(), roots.copy()
    for frame in np.flatnonzero(~np.isfinite(roots).all(axis=-1)):
        nearest = known[np.abs(known - frame).argmin()]
        step = seen[frame] - seen[nearest]
        step = step[np.isfinite(step).all(axis=-1)]
        roots[frame] = roots[nearest] + (np.median(step, axis=0) if len(step) else 0.0)
        turns[frame] = turns[nearest]
    return Poses(turns, roots)


def _measured(
    body: Body, seen: Array, first: Poses, settings: SolveSettings, progress: Progress
) -> Body:
    """Return the body fitted to frames in which most markers are seen, spread over time."""
    count = np.isfinite(seen).all(axis=-1).sum(axis=1)
    whole = np.flatnonzero(count >= NEARLY_ALL * count.max())
    n_frames = min(settings.measured_frames, len(whole))
    frames = whole[np.linspace(0, len(whole) - 1, n_frames).round().astype(int)]
    begun = Poses(first.turns[frames], first.roots[frames])
    some = fit_poses(body, seen[frames], begun)
    return fit_body(body, seen[frames], some, progress=progress)[0]


def _again_where_far_off(body: Body, seen: Array, poses: Poses) -> Poses:
    """Seek poses that fit badly again from the nearest that fits, and keep the better ones."""
    error = _mean_error(body, seen, poses)
    bad = error > max(FAR_OFF_AT_LEAST, FAR_OFF * float(np.nanmedian(error)))
    good = np.flatnonzero(error <= np.nanmedian(error))
    if not bad.any() or not len(good):
        return poses
    frames = np.flatnonzero(bad)
    nearest = good[np.abs(good[:, None] - frames).argmin(axis=0)]
    shift = np.nanmedian(np.nan_to_num(seen[frames] - seen[nearest]), axis=1)
    tried = fit_poses(
        body, seen[frames], Poses(poses.turns[nearest], poses.roots[nearest] + shift)
    )
    better = frames[_mean_error(body, seen[frames], tried) < error[frames]]
    among = np.isin(frames, better)
    turns, roots = poses.turns.copy(), poses.roots.copy()
    turns[better], roots[better] = tried.turns[among], tried.roots[among]
    return Poses(turns, roots)


def _mean_error(body: Body, seen: Array, poses: Poses) -> Array:
    """Return the mean distance of the markers seen, shape (n_frames,); 0 where none is."""
    off = np.linalg.norm(body.place_in(poses).markers - seen, axis=-1)
    there = np.isfinite(off)
    return np.asarray(np.where(there, off, 0.0).sum(axis=1) / there.sum(axis=1).clip(min=1))


def _solved(
    body: Body, seen: Array, poses: Poses, tracks: Tracks, found: MarkerSet
) -> SolvedSkeleton:
    """Put the result together; what is not known becomes NaN."""
    placed = body.place_in(poses)
    known = known_joints(body, seen, poses)
    skeleton = Skeleton(tuple(joint.name for joint in body.joints), body.parents, body.offsets)
    rotations = unroll(quaternion_from_matrix(poses.turns))
    motion = Motion(
        skeleton,
        np.where(known[..., None], rotations, np.nan),
        np.where(known[:, :1], poses.roots, np.nan),
        tracks.frame_rate,
    )
    above = np.stack(
        [known[:, body.path(j)[1:]].all(axis=1) for j in range(len(body.joints))], 1
    )
    above[:, 0] = known[:, 0]
    return SolvedSkeleton(
        motion,
        Tracks(
            skeleton.names, np.where(above[..., None], placed.joints, np.nan), tracks.frame_rate
        ),
        np.linalg.norm(placed.markers - seen, axis=-1),
        tuple(found.markers[marker.spot] for marker in body.markers),
        found,
    )
