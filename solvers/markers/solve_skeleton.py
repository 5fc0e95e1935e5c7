"""Solve a skeleton's motion from the labeled markers of an optical take."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..errors import InvalidMotionError
from ..motion import Motion, Skeleton, Tracks
from ..progress import Progress, unwatched, within
from ..rotations import quaternion_from_matrix, unroll
from ..settings import Settings, setting
from .body import MarkerBody, Poses
from .build_body import build_body
from .determined_joints import find_determined_joints
from .fit_body import fit_body
from .fit_poses import fit_poses
from .joint_centers import joint_centers
from .marker_sets import PELVIS, MarkerSet, find_marker_set
from .vectors import median_or_zero

MIN_MARKER_FRACTION = 0.95
"""Fraction of the largest number of markers that a frame needs for the fit of the body. Chosen
by hand; `make sensitivity` varies it."""
MAX_ERROR_FACTOR = 3.0
"""Multiple of the median error above which a pose is fitted again. Chosen by hand; `make
sensitivity` varies it."""


@dataclass(frozen=True, kw_only=True)
class SolveSettings(Settings):
    """Settings of the solve of a skeleton from markers."""

    subject: str = setting(
        "",
        "Subject of the markers in a take of several people: Anna for Anna:LFHD",
    )
    measured_frames: int = setting(
        80, "Frames used to measure the body; more is slower and covers more poses",
        minimum=10, maximum=1000, advanced=True, label="Body Frames",
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class SolvedSkeleton:
    """The solved motion of the actor's body."""

    motion: Motion
    """Joints have VRM's humanoid role names; the rest pose is the T-pose, facing -Y."""
    joint_centers: Tracks
    """World positions of all joints, with the same names; NaN where undetermined."""
    error: Array
    """Distance of each marker from that of the body, shape (n_frames, n_markers), meters; NaN
    where the marker is missing."""
    markers: tuple[str, ...]
    """Names of the markers of `error` in the take."""
    marker_set: MarkerSet
    """Assignment of the take's markers."""


def solve_skeleton(
    tracks: Tracks,
    *,
    settings: SolveSettings = SolveSettings(),
    progress: Progress = unwatched,
) -> SolvedSkeleton:
    """Solve joint centers and rotations from labeled markers.

    A mean body is scaled by regressions, then its joint and marker offsets are fitted to frames
    of the take, so that joints become centers of rotation (`fit_body`). Then every frame is
    solved independently (`fit_poses`), without the missing markers. The feet are level where
    heel and toe markers are lowest. Toes do not rotate.

    Parameters
    ----------
    tracks : Tracks
        Markers of a supported set (`find_marker_set`); others are ignored. Correct swapped
        markers first (`unswap_markers`).
    settings : SolveSettings
    progress : Progress

    Returns
    -------
    SolvedSkeleton
        Body parts without markers are left out. A joint is NaN in frames that do not determine
        it.

    Raises
    ------
    InvalidMotionError
        Markers of the pelvis or the legs are missing, or never observed together.
    SolveCancelled
        Raised by `progress`.
    """
    found = find_marker_set(tracks.names, settings.subject or None)
    landmarks = _landmark_positions(tracks, found)
    progress(0.02, "Estimating joint centers")
    centers = joint_centers(landmarks)
    body, rotations = build_body(centers, landmarks)
    observed = np.stack([landmarks[marker.landmark] for marker in body.markers], axis=1)
    initial_poses = _extend_to_all_frames(rotations, centers.positions["hips"], observed)
    progress(0.1, "Measuring the body")
    body = _fit_dimensions(body, observed, initial_poses, settings, within(progress, 0.1, 0.4))
    poses = fit_poses(body, observed, initial_poses, progress=within(progress, 0.4, 0.9))
    poses = _refit_outliers(body, observed, poses)
    progress(0.95, "Finding determined joints")
    solved = _build_result(body, observed, poses, tracks, found)
    progress(1.0, "Finding determined joints")
    return solved


def _landmark_positions(tracks: Tracks, found: MarkerSet) -> dict[str, Array]:
    """Return the marker positions by landmark, without markers that were never observed."""
    index = {name: index for index, name in enumerate(tracks.names)}
    positions = {
        landmark: tracks.positions[:, index[name]] for landmark, name in found.markers.items()
    }
    pelvis = [
        _is_observed(positions[landmark]) for landmark in PELVIS[:2] if landmark in positions
    ]
    together = np.logical_and.reduce([np.ones(tracks.n_frames, dtype=bool), *pelvis])
    landmarks = {
        landmark: track
        for landmark, track in positions.items()
        if (_is_observed(track) & together).any()
    }
    missing = MarkerSet(
        found.name, dict.fromkeys(landmarks, ""), found.score
    ).missing_landmarks()
    if missing:
        hint = f" It looks like {found.name}." if found.name else ""
        raise InvalidMotionError(
            "A skeleton needs the labeled markers of pelvis and legs of the Plug-in-Gait or"
            " CMU set; missing or never observed together with the pelvis:"
            f" {', '.join(missing)}.{hint} Label them first."
        )
    _refuse_if_never_together(landmarks)
    return landmarks


def _is_observed(positions: Array) -> NDArray[np.bool_]:
    return np.asarray(np.isfinite(positions).all(axis=-1))


def _refuse_if_never_together(landmarks: Mapping[str, Array]) -> None:
    """Raise if no frame shows the pelvis together with a complete leg."""
    pelvis = [landmark for landmark in PELVIS if landmark in landmarks]
    if {"LPSI", "RPSI"} <= set(pelvis):
        pelvis = list(PELVIS[:4])
    for side in "LR":
        needed = [*pelvis, *(side + landmark for landmark in ("KNE", "ANK", "TOE"))]
        if not np.logical_and.reduce([
            _is_observed(landmarks[landmark]) for landmark in needed
        ]).any():
            raise InvalidMotionError(
                f"No frame shows all of {', '.join(needed)}; fill their gaps first."
            )


def _extend_to_all_frames(rotations: Array, roots: Array, observed: Array) -> Poses:
    """Return initial poses of all frames; missing ones are those of the nearest valid frame.

    The root is moved by the median displacement of the markers in both frames.
    """
    valid = np.flatnonzero(np.isfinite(roots).all(axis=-1))
    rotations, roots = rotations.copy(), roots.copy()
    for frame in np.flatnonzero(~np.isfinite(roots).all(axis=-1)):
        nearest = valid[np.abs(valid - frame).argmin()]
        roots[frame] = roots[nearest] + median_or_zero(observed[frame] - observed[nearest])
        rotations[frame] = rotations[nearest]
    return Poses(rotations, roots)


def _fit_dimensions(
    body: MarkerBody,
    observed: Array,
    initial_poses: Poses,
    settings: SolveSettings,
    progress: Progress,
) -> MarkerBody:
    """Return the body fitted to frames with most markers, evenly spaced over time."""
    count = np.isfinite(observed).all(axis=-1).sum(axis=1)
    complete = np.flatnonzero(count >= MIN_MARKER_FRACTION * count.max())
    n_frames = min(settings.measured_frames, len(complete))
    frames = complete[np.linspace(0, len(complete) - 1, n_frames).round().astype(int)]
    initial = Poses(initial_poses.rotations[frames], initial_poses.roots[frames])
    fitted = fit_poses(body, observed[frames], initial)
    return fit_body(body, observed[frames], fitted, progress=progress)[0]


def _refit_outliers(body: MarkerBody, observed: Array, poses: Poses) -> Poses:
    """Fit outlier poses again from the nearest good pose, and use the better result."""
    error = _mean_error(body, observed, poses)
    error[~np.isfinite(observed).all(axis=-1).any(axis=1)] = np.nan
    bad = error > MAX_ERROR_FACTOR * float(np.nanmedian(error))
    good = np.flatnonzero(error <= np.nanmedian(error))
    if not bad.any() or not len(good):
        return poses
    frames = np.flatnonzero(bad)
    nearest = good[np.rint(np.interp(frames, good, np.arange(len(good)))).astype(np.intp)]
    shift = median_or_zero((observed[frames] - observed[nearest]).swapaxes(0, 1))
    candidate = fit_poses(
        body, observed[frames], Poses(poses.rotations[nearest], poses.roots[nearest] + shift)
    )
    better = frames[_mean_error(body, observed[frames], candidate) < error[frames]]
    improved = np.isin(frames, better)
    rotations, roots = poses.rotations.copy(), poses.roots.copy()
    rotations[better], roots[better] = candidate.rotations[improved], candidate.roots[improved]
    return Poses(rotations, roots)


def _mean_error(body: MarkerBody, observed: Array, poses: Poses) -> Array:
    """Return the mean distance of the observed markers, shape (n_frames,); 0 without any."""
    distances = np.linalg.norm(body.body_in_pose(poses).markers - observed, axis=-1)
    is_valid = np.isfinite(distances)
    return np.asarray(
        np.where(is_valid, distances, 0.0).sum(axis=1) / is_valid.sum(axis=1).clip(min=1)
    )


def _build_result(
    body: MarkerBody, observed: Array, poses: Poses, tracks: Tracks, found: MarkerSet
) -> SolvedSkeleton:
    """Build the result; undetermined joints become NaN."""
    world = body.body_in_pose(poses)
    valid = find_determined_joints(body, observed, poses)
    skeleton = Skeleton(tuple(joint.name for joint in body.joints), body.parents, body.offsets)
    rotations = unroll(quaternion_from_matrix(poses.rotations))
    motion = Motion(
        skeleton,
        np.where(valid[..., None], rotations, np.nan),
        np.where(valid[:, :1], poses.roots, np.nan),
        tracks.frame_rate,
    )
    chain_valid = np.stack(
        [valid[:, body.path(j)[1:]].all(axis=1) for j in range(len(body.joints))], 1
    )
    chain_valid[:, 0] = valid[:, 0]
    return SolvedSkeleton(
        motion,
        Tracks(
            skeleton.names,
            np.where(chain_valid[..., None], world.joints, np.nan),
            tracks.frame_rate,
        ),
        np.linalg.norm(world.markers - observed, axis=-1),
        tuple(found.markers[marker.landmark] for marker in body.markers),
        found,
    )
