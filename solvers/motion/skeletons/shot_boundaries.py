"""Find where a take is cut: where one frame has nothing to do with the frame before."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...rotations import unroll
from .motion import Motion
from .tracks import Tracks

Array = NDArray[np.float64]

AROUND = 8
"""Frames to either side from which it is known how fast each joint moves there."""
HALF_OF_THEM, MOST_OF_THEM = 0.5, 0.7
"""Shares of the joints that have to jump."""
FAR, NOT_NEAR = 2.5, 1.5
"""Times the usual step of a joint that half, and most, of the joints jump at a cut. The first
frames of CMU's recordings, T-poses, have 5.6 and 3.0 at 30 Hz, and more at 120 Hz; hops, kicks
and jumps, however noisy or full of outliers, have at most 2.0 and 1.35."""
SMALLEST_TURN = np.radians(1.0)
SMALLEST_MOVE = 0.04
"""Radians and metres that any joint is taken to move from frame to frame: a camera that loses
a frame moves all points of a body at once by a few centimetres."""
FEWEST_JOINTS = 6
"""Of fewer it cannot be said that nearly all jump together."""
MOVES = 1e-6
SHORTEST = 0.25
"""Seconds: a shorter piece shows no movement that could be told from noise."""
BLOCK = 512
"""Steps looked at at a time: this bounds the memory, however long the take."""


def find_shot_boundaries(recording: Motion | Tracks) -> tuple[int, ...]:
    """Return the first frame of every piece of a take but the first; none is the rule.

    Many recordings begin with a T-pose of one frame; others were joined, or their sensor was
    started again. At a cut nearly all joints jump at once, much farther than they move from
    frame to frame around it, and stay there. A joint that is lost and found does not make a
    cut, nor does a body that jumps away for less than a quarter of a second and comes back;
    nor does one that is moved as a whole in the same pose (of tracks it does).
    """
    smallest = SMALLEST_MOVE if isinstance(recording, Tracks) else SMALLEST_TURN
    steps = _all_steps(recording)
    moving = np.nanmax(steps, axis=0, initial=0.0) > MOVES
    if moving.sum() < FEWEST_JOINTS:
        return ()
    # A frame that repeats the one before says nothing of how fast the body moves.
    steps[np.nanmax(steps, axis=1, initial=0.0) == 0.0] = np.nan
    cuts = [int(step) + 1 for step in _jumps(steps[:, moving], smallest)]
    place = 0
    while place + 1 < len(cuts):
        start, stop = cuts[place : place + 2]
        brief = is_short_shot(stop - start, recording.frame_rate)
        before, after = max(start - 2 * AROUND, 0), stop + 2 * AROUND
        if brief and _comes_back(
            _course(recording, slice(before, after))[:, moving],
            slice(start - before, stop - before),
            smallest,
        ):
            del cuts[place : place + 2]
        else:
            place += 1
    return tuple(cuts)


def shot_ranges(recording: Motion | Tracks, cuts: tuple[int, ...]) -> Iterator[tuple[int, int]]:
    """Yield the first frame of every piece and the first after it."""
    yield from pairwise((0, *cuts, recording.n_frames))


def is_short_shot(n_frames: int, frame_rate: float) -> bool:
    """Tell whether a piece of a take is too short to be cleaned."""
    return n_frames < SHORTEST * frame_rate


def describe_shots(recording: Motion | Tracks, cuts: tuple[int, ...]) -> str:
    """Return a sentence for the animator, with frames counted from 1; empty without cuts."""
    if not cuts:
        return ""
    kept, cleaned_from = [], []
    for start, stop in shot_ranges(recording, cuts):
        if not is_short_shot(stop - start, recording.frame_rate):
            cleaned_from.append(str(start + 1))
        elif stop - start == 1:
            kept.append(f"frame {start + 1}")
        else:
            kept.append(f"frames {start + 1} to {stop}")
    said = []
    if len(cleaned_from) > 1:
        starts = _listed(cleaned_from[1:])
        said.append(f"The take is cut before frame {starts}; its pieces were cleaned apart.")
    if kept:
        whole = _listed(kept)
        one = len(kept) == 1 and whole.startswith("frame ")
        rest = "is a pose apart and was" if one else "are poses apart and were"
        said.append(f"{whole.capitalize()} {rest} kept as recorded.")
    return " ".join(said)


def _listed(names: list[str]) -> str:
    return " and ".join([", ".join(names[:-1]), names[-1]] if names[:-1] else names)


def _course(recording: Motion | Tracks, frames: slice) -> Array:
    """Return what jumps, in some of the frames, shape (n_frames, n_joints, n_components)."""
    if isinstance(recording, Tracks):
        return recording.positions[frames]
    skeleton = recording.skeleton
    joints = [joint for joint in range(skeleton.n_joints) if not skeleton.is_end_site(joint)]
    # Twice the quaternion: neighbouring ones are then as far apart as their angle in radians.
    return 2.0 * unroll(recording.rotations[frames][:, joints])


def _all_steps(recording: Motion | Tracks) -> Array:
    n_steps = recording.n_frames - 1
    n_joints = _course(recording, slice(1)).shape[1]
    steps = np.empty((n_steps, n_joints))
    for start in range(0, n_steps, BLOCK):
        steps[start : start + BLOCK] = _steps(
            _course(recording, slice(start, start + BLOCK + 1))
        )
    return steps


def _steps(course: Array) -> Array:
    """Return how far each joint goes from frame to frame, shape (n_frames - 1, n_joints)."""
    return np.asarray(np.linalg.norm(np.diff(course, axis=0), axis=-1))


def _jumps(steps: Array, smallest: float) -> NDArray[np.intp]:
    """Return the steps, from frame i to i + 1, at which nearly all joints jump."""
    usual = np.fmax([_median(joint, 0) for joint in steps.T], smallest)
    found = [np.empty(0, dtype=np.intp)]
    for start in range(0, len(steps), BLOCK):
        # `_ratios` compares with no less than this: whatever it may find is among these.
        ratios = steps[start : start + BLOCK] / usual
        some = start + np.flatnonzero(_share(ratios, HALF_OF_THEM) >= FAR)
        found.append(some[_is_cut(_ratios(steps, usual, some))])
    return np.concatenate(found)


def _comes_back(course: Array, brief: slice, smallest: float) -> bool:
    """Tell whether without the brief part a body goes no farther than in that time it can."""
    sizes = _steps(np.delete(course, brief, axis=0))
    usual = np.fmax(_median(sizes, 0), smallest)
    ratios = _ratios(sizes, usual, np.array([brief.start - 1]))
    return not _is_cut(ratios, max(FAR, brief.stop - brief.start + 1.0))[0]


def _ratios(sizes: Array, usual: Array, at: NDArray[np.intp]) -> Array:
    """Return how many times its usual step each joint jumps at these steps, (n, n_joints).

    NaN where it is not observed.
    """
    n_steps = len(sizes)
    offsets = np.arange(1, AROUND + 1)
    before, after = (
        _median(_taken(sizes, at[:, None] + way * offsets, n_steps), 1) for way in (-1, 1)
    )
    usual = np.fmax(np.fmax(before, after), usual)
    return np.asarray(sizes[at] / usual)


def _is_cut(ratios: Array, far: float = FAR) -> NDArray[np.bool_]:
    seen = np.isfinite(ratios).sum(axis=1)
    return np.asarray(
        (_share(ratios, HALF_OF_THEM) >= far)
        & (_share(ratios, MOST_OF_THEM) >= NOT_NEAR)
        & (seen >= FEWEST_JOINTS)
        & (seen >= HALF_OF_THEM * ratios.shape[1])
    )


def _taken(values: Array, places: NDArray[np.intp], length: int) -> Array:
    """Return the values at these places; NaN before the first and after the last."""
    inside = (places >= 0) & (places < length)
    found = values[np.clip(places, 0, length - 1)]
    found[~inside] = np.nan
    return np.asarray(found)


def _share(ratios: Array, share: float) -> Array:
    """Return what this share of the joints in sight reach or exceed, shape (n_steps,)."""
    ordered = np.sort(np.where(np.isnan(ratios), -1.0, ratios), axis=1)[:, ::-1]
    seen = (ordered >= 0.0).sum(axis=1)
    place = np.clip(np.ceil(share * seen).astype(int) - 1, 0, ratios.shape[1] - 1)
    return np.take_along_axis(ordered, place[:, None], axis=1)[:, 0]


def _median(values: Array, axis: int) -> Array:
    """Return the median without NaN; NaN where there is nothing else."""
    ordered = np.sort(values, axis=axis)
    count = np.isfinite(values).sum(axis=axis, keepdims=True)
    low = np.take_along_axis(ordered, np.maximum((count - 1) // 2, 0), axis=axis)
    high = np.take_along_axis(
        ordered, np.minimum(count // 2, values.shape[axis] - 1), axis=axis
    )
    return np.asarray(np.squeeze(0.5 * (low + high), axis=axis))
