"""List gaps: where joints are missing, and where a tracker repeated what it had lost."""

from collections import Counter
from collections.abc import Iterator

import numpy as np

from ...signals import find_runs, merge_runs
from .issue import Issue
from .measure import Quality

LONG_GAP_S = 0.25
"""Seconds that an animator can still bridge by eye: severity 1, by definition."""

_Run = tuple[int, int]


def gap_issues(quality: Quality, pause: int) -> Iterator[Issue]:
    """Return an issue for each gap of a joint, or of a limb whose joints are lost together.

    Parameters
    ----------
    quality : Quality
    pause : int, frames
        Gaps of the entire body, or of the same highest joint, that are closer in time are one
        issue, which states their time in sum.
    """
    body = np.zeros(quality.n_frames, dtype=np.bool_)
    if quality.body_held is not None:
        body = quality.body_held
    for start, stop in merge_runs(find_runs(body), pause):
        seconds = float(body[start:stop].sum()) / quality.frame_rate
        sentence = f"The entire body repeats a pose for {seconds:.2f} s before it moves on."
        yield Issue(quality.names[0], start, stop, "gap", seconds / LONG_GAP_S, sentence)
    missing = [(each.joint, find_runs(each.gaps & ~each.held)) for each in quality.signals]
    for joint, n_more, n_frames, (start, stop) in _lost_together(quality, missing, pause):
        seconds = n_frames / quality.frame_rate
        if n_frames == quality.n_frames:
            sentence = (
                f"{joint} and {n_more} more are never observed."
                if n_more
                else f"{joint} is never observed."
            )
        else:
            sentence = (
                f"{joint} and {n_more} more are missing for {seconds:.2f} s."
                if n_more
                else f"{joint} is missing for {seconds:.2f} s."
            )
        yield Issue(joint, start, stop, "gap", seconds / LONG_GAP_S, sentence)
    held = [(each.joint, find_runs(each.held & ~body)) for each in quality.signals]
    for joint, n_more, n_frames, (start, stop) in _lost_together(quality, held, pause):
        seconds = n_frames / quality.frame_rate
        sentence = (
            f"{joint} and {n_more} more stand still for {seconds:.2f} s and then jump."
            if n_more
            else f"{joint} stands still for {seconds:.2f} s and then jumps."
        )
        yield Issue(joint, start, stop, "gap", seconds / LONG_GAP_S, sentence)


def _lost_together(
    quality: Quality, runs: list[tuple[str, list[_Run]]], pause: int
) -> Iterator[tuple[str, int, int, _Run]]:
    """Return the highest joint of each part of the body, and what was lost with it.

    That is how many joints below it at most, in how many frames, and the first and last of
    these.
    """
    index = {name: number for number, name in enumerate(quality.names)}
    joints: dict[_Run, set[int]] = {}
    for name, of_joint in runs:
        for run in of_joint:
            joints.setdefault(run, set()).add(index[name])
    parts: dict[int, dict[_Run, int]] = {}
    for run, together in joints.items():
        for top, n_joints in Counter(
            _highest(each, together, quality) for each in together
        ).items():
            parts.setdefault(top, {})[run] = n_joints - 1
    for top, n_more in parts.items():
        lost = np.zeros(quality.n_frames, dtype=np.bool_)
        for first, last in n_more:
            lost[first:last] = True
        for start, stop in merge_runs(find_runs(lost), pause):
            most = max(n for (first, _), n in n_more.items() if start <= first < stop)
            yield quality.names[top], most, int(lost[start:stop].sum()), (start, stop)


def _highest(joint: int, together: set[int], quality: Quality) -> int:
    """Return the highest ancestor that is reached through joints of the set alone.

    Points of tracks have no parents: each is its own, unless all are lost.
    """
    if not quality.parents:
        return 0 if len(together) == len(quality.names) else joint
    while quality.parents[joint] in together:
        joint = quality.parents[joint]
    return joint
