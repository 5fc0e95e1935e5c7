"""Undo exchanges of left and right, which trackers make for some frames."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...motion import JointRecording
from ...motion.humanoid import SIDES, joints_of_names
from .terms import vector_lengths

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Pairs = NDArray[np.intp]

MAX_SWAP_S = 1.0
"""Seconds. What lasts longer is left alone: nobody knows which of both is right."""
MAX_GAP_S = 0.25
"""Seconds: beyond, nothing is known of where a joint comes back."""
MAX_STEP_RATIO = 0.5
"""Steps into the other's place are at most this share of those that joints seem to make."""
MIN_GAIN_M = 0.08
"""Metres that the joints of a pair must seem to step farther, on the mean."""
LIMBS = ("UpperArm", "LowerArm", "UpperLeg", "LowerLeg")
SIDE_WORDS = (("Left", "Right"), ("left", "right"), ("LEFT", "RIGHT"))


def fix_left_right_swaps(recording: JointRecording) -> JointRecording:
    """Give left and right joints back that a tracker exchanged for up to a second.

    The whole body, both arms or both legs, or what is below elbows or knees. All of it jumps
    into the other side's place, and back, though it would else have gone on smoothly. Where
    left and right stay exchanged to the end, or longer than a second, nothing is changed.

    Parameters
    ----------
    recording : JointRecording

    Returns
    -------
    JointRecording
        With the tracker's word and confidence exchanged along; the same where nothing is.
    """
    order = np.tile(np.arange(recording.n_joints), (recording.n_frames, 1))
    positions = recording.tracks.positions.copy()
    for pairs, first in _swap_groups(recording):
        edges = _swap_edges(positions, pairs, first, recording.frame_rate)
        frames = _swapped_frames(edges, MAX_SWAP_S * recording.frame_rate)
        if frames.any():
            _swap_columns(positions, frames, pairs)
            _swap_columns(order, frames, pairs)
    if (order == np.arange(recording.n_joints)).all():
        return recording
    tracks, state = recording.tracks, recording.tracking_state
    confidence = tracks.confidence
    if confidence is not None:
        confidence = np.take_along_axis(confidence, order, axis=1)
    return replace(
        recording,
        tracks=replace(tracks, positions=positions, confidence=confidence),
        tracking_state=None if state is None else np.take_along_axis(state, order, axis=1),
    )


def _swap_groups(recording: JointRecording) -> Iterator[tuple[Pairs, Pairs]]:
    """Yield what is exchanged together, the largest first: all pairs, and those at its root.

    Pairs are columns, shape (n_pairs, 2). Those at the root hardly ever meet: all of them must
    be seen to jump.
    """
    names, parents = recording.names, recording.parents
    roles = joints_of_names(names)
    pairs = _pairs(names, roles)
    ends = {
        limb: (roles[SIDES[0] + limb], roles[SIDES[1] + limb])
        for limb in LIMBS
        if all(side + limb in roles for side in SIDES)
    }
    if {"UpperArm", "UpperLeg"} <= ends.keys():
        yield np.array(pairs), np.array([ends["UpperArm"], ends["UpperLeg"]])
    for root in ends.values():
        below = [pair for pair in pairs if _is_below(pair[0], root[0], parents)]
        if len(below) > 1:
            yield np.array(below), np.array([root])


def _pairs(names: Sequence[str], roles: dict[str, int]) -> list[tuple[int, int]]:
    """Return the columns of left joints and their counterparts, by roles and by names."""
    found = {
        place: roles[SIDES[1] + role.removeprefix(SIDES[0])]
        for role, place in roles.items()
        if role.startswith(SIDES[0]) and SIDES[1] + role.removeprefix(SIDES[0]) in roles
    }
    places = {name: place for place, name in enumerate(names)}
    for name, place in places.items():
        for left, right in SIDE_WORDS:
            other = places.get(name.replace(left, right)) if left in name else None
            if other is not None:
                found.setdefault(place, other)
    return sorted(found.items())


def _is_below(joint: int, root: int, parents: Sequence[int]) -> bool:
    while joint not in (-1, root):
        joint = parents[joint]
    return joint == root


def _swap_edges(positions: Array, pairs: Pairs, first: Pairs, frame_rate: float) -> Array:
    """Return how much farther than needed joints seem to step into each frame, (n_frames,).

    The mean over pairs, in metres; 0 where they do not all step into each other's place.
    """
    kept, turned = _step_lengths(positions, pairs, max(1.0, MAX_GAP_S * frame_rate))
    total, least = np.nansum(kept, axis=1), np.nansum(turned, axis=1)
    n_known = np.isfinite(kept).sum(axis=1)
    gain = (total - least) / np.maximum(2 * n_known, 1)
    at_root = [int(np.flatnonzero((pairs == pair).all(axis=1))[0]) for pair in first]
    jumps = (turned[:, at_root] < MAX_STEP_RATIO * kept[:, at_root]).all(axis=1)
    jumps &= (least < MAX_STEP_RATIO * total) & (gain > MIN_GAIN_M)
    jumps &= 2 * n_known > len(pairs)
    return np.where(jumps, gain, 0.0)


def _step_lengths(positions: Array, pairs: Pairs, longest: float) -> tuple[Array, Array]:
    """Return how far pairs step if they stay, and if they change sides, (n_frames, n_pairs).

    From the last frame in which both were seen; NaN where that is none, or too long ago.
    """
    known = np.isfinite(positions[:, pairs]).all(axis=(2, 3))
    frames = np.arange(len(positions))[:, None]
    last = np.maximum.accumulate(np.where(known, frames, -1), axis=0)
    last = np.concatenate([np.full((1, len(pairs)), -1), last[:-1]])
    reached = known & (last >= 0) & (frames - last <= longest)
    now = positions[:, pairs]
    before = now[np.maximum(last, 0), np.arange(len(pairs))]
    kept = vector_lengths(now - before).sum(axis=-1)
    turned = vector_lengths(now - before[:, :, ::-1]).sum(axis=-1)
    return np.where(reached, kept, np.nan), np.where(reached, turned, np.nan)


def _swapped_frames(edges: Array, longest: float) -> Flags:
    """Tell in which frames sides are exchanged: between one edge and the next, if soon after.

    Edges that follow each other soon belong together; of an odd number the least is no edge,
    or the first or last frames are exchanged.
    """
    frames = np.zeros(len(edges), bool)
    found = np.flatnonzero(edges)
    for run in np.split(found, np.flatnonzero(np.diff(found) > longest) + 1):
        ends = [int(edge) for edge in run]
        if len(ends) % 2:
            to_start, to_end = ends[0], len(edges) - ends[-1]
            if min(to_start, to_end) > min(longest, len(edges) / 3.0):
                ends.remove(min(ends, key=lambda edge: float(edges[edge])))
            elif to_start <= to_end:
                ends.insert(0, 0)
            else:
                ends.append(len(edges))
        for start, stop in zip(ends[::2], ends[1::2], strict=True):
            frames[start:stop] = True
    return frames


def _swap_columns(values: NDArray[np.generic], frames: Flags, pairs: Pairs) -> None:
    """Exchange the columns of pairs in some frames, in place."""
    rows = np.flatnonzero(frames)[:, None]
    left, right = values[rows, pairs[:, 0]], values[rows, pairs[:, 1]]
    values[rows, pairs[:, 0]], values[rows, pairs[:, 1]] = right, left
