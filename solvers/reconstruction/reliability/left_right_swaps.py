"""Correct left-right swaps, which trackers make for some frames."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Flags, Integers
from ...motion import JointRecording
from ...motion.humanoid import SIDES, posture_joint_indices
from .terms import vector_lengths

MAX_SWAP_S = 1.0
"""Maximum duration (s) of a swap. It guards an actor who turned around while he was lost: after
a longer time nothing shows which side is correct
(`test_sides_that_stay_swapped_for_longer_than_a_second_are_left_alone`)."""
MAX_GAP_S = 0.25
"""Maximum gap (s) across which a step of a joint is measured. It guards an actor who turns
while his body is lost: without it his sides are swapped
(`test_turn_of_an_occluded_body_is_no_swap`)."""
MAX_STEP_RATIO = 0.5
"""Maximum ratio of the steps with sides swapped to the steps as tracked. Chosen by hand;
`make sensitivity` varies it."""
MIN_GAIN_M = 0.08
"""Minimum reduction (m) of the mean step by swapping sides. It guards limbs side by side, whose
steps say nothing (`test_legs_side_by_side_are_not_swapped`)."""
LIMBS = ("UpperArm", "LowerArm", "UpperLeg", "LowerLeg")
SIDE_WORDS = (("Left", "Right"), SIDES, ("LEFT", "RIGHT"))


def fix_left_right_swaps(recording: JointRecording) -> JointRecording:
    """Correct left and right joints that a tracker swapped for up to a second.

    Swaps of the complete body, of both arms or legs, and of the parts below elbows or knees are
    corrected. All joints of the group must jump to the other side's position and back. Swaps
    longer than one second or up to the end of the take are left unchanged.

    Parameters
    ----------
    recording : JointRecording

    Returns
    -------
    JointRecording
        With tracking states and confidences swapped too; the same object without swaps.
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


def _swap_groups(recording: JointRecording) -> Iterator[tuple[Integers, Integers]]:
    """Yield joints that swap together, largest group first: all pairs, and pairs at the root.

    Pairs are columns, shape (n_pairs, 2). Pairs at the root of a group are far apart, so all of
    them must jump.
    """
    names, parents = recording.names, recording.parents
    roles = posture_joint_indices(names)
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
    counterparts = {
        column: roles[SIDES[1] + role.removeprefix(SIDES[0])]
        for role, column in roles.items()
        if role.startswith(SIDES[0]) and SIDES[1] + role.removeprefix(SIDES[0]) in roles
    }
    columns = {name: column for column, name in enumerate(names)}
    for name, column in columns.items():
        for left, right in SIDE_WORDS:
            other = columns.get(name.replace(left, right)) if left in name else None
            if other is not None:
                counterparts.setdefault(column, other)
    return sorted(counterparts.items())


def _is_below(joint: int, root: int, parents: Sequence[int]) -> bool:
    while joint not in (-1, root):
        joint = parents[joint]
    return joint == root


def _swap_edges(positions: Array, pairs: Integers, first: Integers, frame_rate: float) -> Array:
    """Return the excess step length into each frame of a swap, shape (n_frames,), meters.

    The mean over pairs; 0 where not all of them step to the other side's position.
    """
    unswapped, swapped = _step_lengths(positions, pairs, max(1.0, MAX_GAP_S * frame_rate))
    unswapped_total, swapped_total = np.nansum(unswapped, axis=1), np.nansum(swapped, axis=1)
    n_known = np.isfinite(unswapped).sum(axis=1)
    gain = (unswapped_total - swapped_total) / np.maximum(2 * n_known, 1)
    at_root = [int(np.flatnonzero((pairs == pair).all(axis=1))[0]) for pair in first]
    jumps = (swapped[:, at_root] < MAX_STEP_RATIO * unswapped[:, at_root]).all(axis=1)
    jumps &= (swapped_total < MAX_STEP_RATIO * unswapped_total) & (gain > MIN_GAIN_M)
    jumps &= 2 * n_known > len(pairs)
    return np.where(jumps, gain, 0.0)


def _step_lengths(positions: Array, pairs: Integers, longest: float) -> tuple[Array, Array]:
    """Return step lengths with sides unswapped and swapped, each (n_frames, n_pairs).

    Steps start at the last frame with both joints observed; NaN without one within `longest`.
    """
    known = np.isfinite(positions[:, pairs]).all(axis=(2, 3))
    frames = np.arange(len(positions))[:, None]
    last = np.maximum.accumulate(np.where(known, frames, -1), axis=0)
    last = np.concatenate([np.full((1, len(pairs)), -1), last[:-1]])
    reached = known & (last >= 0) & (frames - last <= longest)
    now = positions[:, pairs]
    before = now[np.maximum(last, 0), np.arange(len(pairs))]
    unswapped = vector_lengths(now - before).sum(axis=-1)
    swapped = vector_lengths(now - before[:, :, ::-1]).sum(axis=-1)
    return np.where(reached, unswapped, np.nan), np.where(reached, swapped, np.nan)


def _swapped_frames(edges: Array, longest: float) -> Flags:
    """Return the frames between one edge and the next, if these are close enough in time.

    Nearby edges belong together. In an odd number of edges, the weakest one is dropped, or the
    swap reaches the first or last frame.
    """
    frames = np.zeros(len(edges), bool)
    edge_frames = np.flatnonzero(edges)
    for run in np.split(edge_frames, np.flatnonzero(np.diff(edge_frames) > longest) + 1):
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


def _swap_columns(values: NDArray[np.generic], frames: Flags, pairs: Integers) -> None:
    """Swap the columns of pairs in some frames, in place."""
    rows = np.flatnonzero(frames)[:, None]
    left, right = values[rows, pairs[:, 0]], values[rows, pairs[:, 1]]
    values[rows, pairs[:, 0]], values[rows, pairs[:, 1]] = right, left
