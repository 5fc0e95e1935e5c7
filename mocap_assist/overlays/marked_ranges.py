"""Ranges of frames that the strip below the keys marks, and the colors of marks."""

from collections.abc import Iterable, Mapping
from enum import Enum
from typing import NamedTuple

import numpy as np

from ...solvers.arrays import Array
from .confidence_colors import COLORS as CONFIDENCE_COLORS
from .view_drawing import Color

MAX_STEPS_BETWEEN = 1.5
"""Frames from one key to the next, relative to the frames between samples, that belong to one
range. By definition between 1, neighbors, and 2, one frame between them."""
LOW_CONFIDENCE, HIGH_CONFIDENCE = 0.5, 0.75
"""Confidence below which a joint is rather wrong than right, and, halfway from there to
certainty, above which it is reliable."""


class StripRow(Enum):
    """Row of the strip, from top to bottom; its value is the label in panels and drawings."""

    CONFIDENCE = "Confidence"
    SPIKES = "Spikes"
    JUMPS = "Jumps"
    GAPS = "Gaps"
    JITTER = "Jitter"
    FOOT_SLIDES = "Foot Slides"
    LIMITS = "Joint Limits"
    CUTS = "Cuts"
    FILLED = "Filled"
    CORRECTED = "Corrected"
    LEFT_FOOT = "Left Foot"
    RIGHT_FOOT = "Right Foot"
    LEFT_HAND = "Left Hand"
    RIGHT_HAND = "Right Hand"
    LEFT_KNEE = "Left Knee"
    RIGHT_KNEE = "Right Knee"
    HIPS = "Hips"
    ISSUES = "Issues"
    CHANGED = "Changed"
    CONTACTS = "Contacts"


class Mark(Enum):
    """Color of a range; its value is its label in the legend."""

    LOW = "Low"
    MEDIUM = "Medium"
    HIGH = "High"
    ISSUE = "Issues"
    FILLED = "Filled"
    CORRECTED = "Corrected"
    LEFT = "Left Contact"
    RIGHT = "Right Contact"
    HIPS = "Hips Contact"


COLORS: Mapping[Mark, Color] = {
    Mark.LOW: tuple(CONFIDENCE_COLORS[0].tolist()),
    Mark.MEDIUM: tuple(CONFIDENCE_COLORS[1].tolist()),
    Mark.HIGH: tuple(CONFIDENCE_COLORS[2].tolist()),
    Mark.ISSUE: (1.0, 0.36, 0.18, 0.75),
    Mark.FILLED: (0.70, 0.45, 0.95, 1.0),
    Mark.CORRECTED: (0.95, 0.85, 0.45, 1.0),
    Mark.LEFT: (0.35, 0.80, 0.45, 1.0),
    Mark.RIGHT: (0.20, 0.70, 0.75, 1.0),
    Mark.HIPS: (0.30, 0.75, 0.60, 1.0),
}
ISSUE_ROWS: Mapping[str, StripRow] = {
    "spike": StripRow.SPIKES,
    "jump": StripRow.JUMPS,
    "gap": StripRow.GAPS,
    "jitter": StripRow.JITTER,
    "foot slide": StripRow.FOOT_SLIDES,
    "limit": StripRow.LIMITS,
    "cut": StripRow.CUTS,
}
"""By kind of an issue."""
CONTACT_ROWS = (
    (StripRow.LEFT_FOOT, Mark.LEFT),
    (StripRow.RIGHT_FOOT, Mark.RIGHT),
    (StripRow.LEFT_HAND, Mark.LEFT),
    (StripRow.RIGHT_HAND, Mark.RIGHT),
    (StripRow.LEFT_KNEE, Mark.LEFT),
    (StripRow.RIGHT_KNEE, Mark.RIGHT),
    (StripRow.HIPS, Mark.HIPS),
)
"""In the order of the contact keys."""
MARKS: Mapping[StripRow, tuple[Mark, ...]] = {
    StripRow.CONFIDENCE: (Mark.LOW, Mark.MEDIUM, Mark.HIGH),
    **dict.fromkeys(ISSUE_ROWS.values(), (Mark.ISSUE,)),
    StripRow.FILLED: (Mark.FILLED,),
    StripRow.CORRECTED: (Mark.CORRECTED,),
    **{row: (mark,) for row, mark in CONTACT_ROWS},
}


GROUPS: Mapping[StripRow, StripRow] = {
    **dict.fromkeys(ISSUE_ROWS.values(), StripRow.ISSUES),
    StripRow.FILLED: StripRow.CHANGED,
    StripRow.CORRECTED: StripRow.CHANGED,
    **{row: StripRow.CONTACTS for row, _ in CONTACT_ROWS},
}
"""For each row, the one that replaces it in an editor without space for all rows."""
IMPORTANCE = (StripRow.ISSUES, StripRow.CONFIDENCE, StripRow.CHANGED, StripRow.CONTACTS)
"""Of joined rows, the order in which a low editor drops them, the last ones first."""
LANES: Mapping[Mark, tuple[float, float]] = {Mark.LEFT: (0.5, 1.0), Mark.RIGHT: (0.0, 0.5)}
"""Lower and upper end of the contacts of both sides in the row that they share."""


class Range(NamedTuple):
    """First and last frame of a range, and what it marks."""

    first: float
    last: float
    mark: Mark


Rows = Mapping[StripRow, tuple[Range, ...]]


def join_related_rows(rows: Rows) -> Rows:
    """Join related rows; a row without another of its group stays as it is."""
    members: dict[StripRow, list[StripRow]] = {}
    for row in rows:
        members.setdefault(GROUPS.get(row, row), []).append(row)
    return {
        group if len(found) > 1 else found[0]: sum((rows[row] for row in found), ())
        for group, found in members.items()
    }


def most_important(rows: Rows, n_rows: int) -> Rows:
    """Leave out all but a number of joined rows, in the order that they have."""
    kept = sorted(rows, key=lambda row: IMPORTANCE.index(GROUPS.get(row, row)))[:n_rows]
    return {row: found for row, found in rows.items() if row in kept}


def ranges_of(frames: Array, step: float, mark: Mark) -> tuple[Range, ...]:
    """Join frames that are at most one sample apart; they need no order.

    Parameters
    ----------
    frames : shape (n_frames,)
    step : float
        Frames from one sample to the next.
    mark : Mark
    """
    if not len(frames):
        return ()
    ordered = np.unique(frames)
    ends = np.flatnonzero(np.diff(ordered) > MAX_STEPS_BETWEEN * step)
    firsts = ordered[np.append(0, ends + 1)]
    lasts = ordered[np.append(ends, len(ordered) - 1)]
    return tuple(
        Range(float(first), float(last), mark)
        for first, last in zip(firsts, lasts, strict=True)
    )


def confidence_mark(confidence: float) -> Mark:
    """Return the level of a confidence."""
    if confidence < LOW_CONFIDENCE:
        return Mark.LOW
    return Mark.MEDIUM if confidence < HIGH_CONFIDENCE else Mark.HIGH


def confidence_ranges(lowest: Array, frames: Array, step: float) -> tuple[Range, ...]:
    """Return the ranges of low, medium and high confidence, in order of their frames.

    Parameters
    ----------
    lowest : shape (n_frames,)
        The lowest confidence of all bones; NaN where it is unknown.
    frames : shape (n_frames,)
    step : float
        Frames from one sample to the next.
    """
    levels = {
        Mark.LOW: lowest < LOW_CONFIDENCE,
        Mark.MEDIUM: (lowest >= LOW_CONFIDENCE) & (lowest < HIGH_CONFIDENCE),
        Mark.HIGH: lowest >= HIGH_CONFIDENCE,
    }
    found = [each for mark in levels for each in ranges_of(frames[levels[mark]], step, mark)]
    return tuple(sorted(found, key=lambda each: each.first))


def issue_ranges(
    issues: Iterable[tuple[float, float, str]],
) -> dict[StripRow, tuple[Range, ...]]:
    """Return the ranges of each kind of issue, from first and last frames with their kinds."""
    rows: dict[StripRow, tuple[Range, ...]] = dict.fromkeys(ISSUE_ROWS.values(), ())
    for first, last, kind in issues:
        if row := ISSUE_ROWS.get(kind):  # files of another version may hold other kinds
            rows[row] += (Range(first, last, Mark.ISSUE),)
    return rows


def contact_ranges(keys: Array, end: float, step: float, mark: Mark) -> tuple[Range, ...]:
    """Return the frames in which a foot, hand or knee, or the hips, are down.

    Parameters
    ----------
    keys : shape (n_keys, 2)
        Frame and value of keys that hold until the next one: 1 it is down, 0 it is not.
    end : float
        Last frame of the action, until which the last key holds.
    step : float
        Frames from one sample to the next.
    mark : Mark
    """
    found: list[Range] = []
    for index, (frame, value) in enumerate(keys):
        if value <= 0.5:
            continue
        is_last = index == len(keys) - 1
        last = max(end if is_last else keys[index + 1, 0] - step, frame)
        if found and frame - found[-1].last <= MAX_STEPS_BETWEEN * step:
            found[-1] = found[-1]._replace(last=float(last))
        else:
            found.append(Range(float(frame), float(last), mark))
    return tuple(found)
