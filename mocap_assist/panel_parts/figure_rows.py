"""Texts of panels about a result."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

FIGURES = (
    ("Jitter (°)", "mean_rotation_noise_deg", 1.0, ".2f"),
    ("Jitter (mm)", "mean_position_noise_mm", 1.0, ".1f"),
    ("Spikes", "spikes", 1.0, ".0f"),
    ("Missing (%)", "missing_share", 100.0, ".1f"),
    ("Longest Slide (cm)", "longest_foot_slide_cm", 1.0, ".1f"),
)
UNKNOWN = "–"


class FigureRow(NamedTuple):
    """One figure of a result."""

    label: str
    before: str
    after: str


def figure_rows(entries: Sequence[Mapping[str, Any]]) -> list[FigureRow]:
    """Return the figures of the raw action and of its last result, from an action's history."""
    cleaned = [entry for entry in entries if "before" in entry and "after" in entry]
    if not cleaned:
        return []
    before, after = cleaned[0]["before"], cleaned[-1]["after"]
    has_rotations = before.get("mean_rotation_noise_deg") is not None
    hidden = "mean_position_noise_mm" if has_rotations else "mean_rotation_noise_deg"
    return [
        FigureRow(label, *(_figure(each.get(key), factor, form) for each in (before, after)))
        for label, key, factor, form in FIGURES
        if key != hidden and (key in before or key in after)
    ]


def frames_text(start: float, stop: float) -> str:
    """Return the frames of an issue: 12, or 12 – 15."""
    first, last = f"{start:g}", f"{stop:g}"
    return first if first == last else f"{first} – {last}"


def frame_text(frame: float) -> str:
    """Return the nearest frame, for a column of a sidebar of the default width."""
    return str(round(frame))


def _figure(value: float | None, factor: float, form: str) -> str:
    return UNKNOWN if value is None else format(factor * value, form)
