"""Format a quality measurement as a table for animators."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...signals import find_runs
from .bone_drift import MAX_POINTS
from .joint_signals import Signal

if TYPE_CHECKING:
    from .measure import Quality

UNKNOWN = "-"
COLUMNS = ("jitter", "shake", "spikes", "gaps", "missing")


def quality_report(quality: "Quality", frames: Sequence[float]) -> str:
    """Return one line per joint, then feet, bones and limits, aligned in columns.

    `frames` are the numbers of the frames.
    """
    jitter = dict(zip(quality.names, quality.jitter.tolist(), strict=True))
    rows = [_row(signal, quality, jitter[signal.joint]) for signal in quality.signals]
    seconds = quality.n_frames / quality.frame_rate
    lines = [
        f"{quality.n_frames} frames at {quality.frame_rate:g} Hz ({seconds:.1f} s),"
        f" mean jitter {_number(quality.mean_jitter)} m/s3",
        *(
            [f"cut before frame {', '.join(f'{frames[cut]:.7g}' for cut in quality.cuts)}"]
            * bool(quality.cuts)
        ),
        *(
            f"the body jumps by {100 * jump.distance:.0f} cm at frame {frames[jump.frame]:.7g}"
            for jump in quality.path_jumps
        ),
        *(
            f"{signal.joint} jumps by {np.degrees(angle):.0f} deg at frame {frames[frame]:.7g}"
            for signal, frame, angle in quality.joint_jumps
        ),
        "",
        *_aligned([("joint", *COLUMNS), *rows]),
    ]
    if quality.feet:
        lines += [
            "",
            *_aligned([("foot", "on the floor", "slides", "in all"), *_feet(quality)]),
        ]
    if quality.bones:
        lines += ["", *_aligned([("bone", "length", "drift"), *_bones(quality)])]
    if not quality.bones_searched:
        lines += [
            "",
            f"Bones are not searched among more than {MAX_POINTS} markers; check fewer of"
            " them.",
        ]
    if quality.limit_excess is not None:
        lines += ["", *_limits(quality)]
    return "\n".join(lines)


def compare_quality(before: "Quality", after: "Quality") -> str:
    """Return the overall figures of two measurements side by side."""
    rows: list[tuple[str, ...]] = [("", "before", "after")]
    for label, unit, factor, name in (
        ("jitter", "m/s3", 1.0, "mean_jitter"),
        ("foot slide", "cm/s", 100.0, "foot_slide"),
    ):
        values = (factor * getattr(quality, name) for quality in (before, after))
        rows.append((f"{label} ({unit})", *(_number(value) for value in values)))
    for is_rotation, label, factor in (
        (True, "shake (deg)", 180 / np.pi),
        (False, "shake (mm)", 1e3),
    ):
        noises = [
            [
                factor * signal.noise
                for signal in quality.signals
                if signal.is_rotation is is_rotation
            ]
            for quality in (before, after)
        ]
        if all(noises):
            rows.append((label, *(_number(float(np.mean(noise))) for noise in noises)))
    for label, name in (("spikes", "spikes"), ("gaps", "gaps")):
        counts = [
            sum(len(find_runs(getattr(signal, name))) for signal in quality.signals)
            for quality in (before, after)
        ]
        rows.append((label, *(str(count) for count in counts)))
    return "\n".join(_aligned(rows))


def _row(signal: Signal, quality: "Quality", jitter: float) -> tuple[str, ...]:
    root_moves = not signal.is_rotation and any(other.is_rotation for other in quality.signals)
    noise = (
        f"{np.degrees(signal.noise):.2f} deg"
        if signal.is_rotation
        else f"{1e3 * signal.noise:.2f} mm"
    )
    missing = signal.gaps.mean()
    return (
        f"{signal.joint} (position)" if root_moves else signal.joint,
        _number(jitter),
        noise,
        str(len(find_runs(signal.spikes)) or UNKNOWN),
        str(len(find_runs(signal.gaps)) or UNKNOWN),
        f"{missing:.0%}" if missing else UNKNOWN,
    )


def _feet(quality: "Quality") -> list[tuple[str, ...]]:
    return [
        (
            foot.joint,
            f"{foot.contact.mean():.0%}",
            f"{_number(100 * foot.mean_speed)} cm/s",
            f"{100 * foot.distance:.1f} cm",
        )
        for foot in quality.feet
    ]


def _bones(quality: "Quality") -> list[tuple[str, ...]]:
    return [
        (
            f"{bone.first} to {bone.second}",
            f"{100 * bone.length:.1f} cm",
            f"{1000 * bone.drift:.1f} mm",
        )
        for bone in sorted(quality.bones, key=lambda bone: -bone.drift)
    ]


def _limits(quality: "Quality") -> list[str]:
    excess = np.nan_to_num(np.asarray(quality.limit_excess))
    rows = [
        (name, f"{(column > 0).mean():.0%}", f"{np.degrees(column.max()):.1f} deg")
        for name, column in zip(quality.names, excess.T, strict=True)
        if column.any()
    ]
    if not rows:
        return ["No joint is beyond its limits."]
    return _aligned([("beyond its limits", "frames", "at most"), *rows])


def _number(value: float) -> str:
    return f"{value:.1f}" if np.isfinite(value) else UNKNOWN


def _aligned(rows: list[tuple[str, ...]]) -> list[str]:
    """Pad to columns: names left-aligned, figures right-aligned."""
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    return [
        "  ".join([
            row[0].ljust(widths[0]),
            *(c.rjust(w) for c, w in zip(row[1:], widths[1:], strict=True)),
        ])
        for row in rows
    ]
