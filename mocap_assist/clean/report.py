"""Report of Clean for the status bar, and its entry in the action's history."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...solvers.denoising import Quality
from ...solvers.signals import find_runs
from ..scene import history
from .button_settings import CleanBundle, Prior
from .solve_cleaning import Cleaned


def clean_report(
    frames: Sequence[float], cleaned: Cleaned, name: str, prior: Prior, n_modified: int = 0
) -> str:
    """Return a few sentences for the status bar; `n_modified` curves had modifiers.

    Blender cuts long ones in the middle. So the motion model is named only where the animator
    has chosen one; the history always has it.
    """
    body = cleaned.solution.denoised[0]
    before, after = map(_faults, (cleaned.before, cleaned.after))
    done = [f"spikes and gaps {before} → {after}"]
    if swaps := cleaned.solution.swaps:
        done.append(f"{len(swaps)} swapped labels")
    planted = cleaned.planted
    if planted:
        slides = (100 * planted.slide_before, 100 * planted.slide_after)
        done.append(f"slide on the floor {slides[0]:.1f} → {slides[1]:.1f} cm")
    n_frames = len(frames)
    message = [
        f"{name}: cleaned {n_frames} frames: {', '.join(done)}.",
        body.describe_separate_poses(frames) if prior is Prior.TAKE else body.report(frames),
    ]
    if n_modified:
        message.append(f"Applied the modifiers of {n_modified} curves.")
    if cleaned.keyed:
        message.append("Keys of Strength were used; switch off Use Keys to ignore them.")
    if not all(each.converged for each in cleaned.solution.denoised):
        message.append("Stopped before the result converged; try a shorter range.")
    message += [f"{remark}." for remark in (planted.remarks if planted else ())]
    if cleaned.low_confidence:
        message.append(cleaned.low_confidence)
    return " ".join(filter(None, message))


def entry_of(
    operation: str, settings: CleanBundle, cleaned: Cleaned, frames: Sequence[float]
) -> dict[str, Any]:
    """Return the entry for the action's history, JSON-ready."""
    body = cleaned.solution.denoised[0]
    return {
        "operation": operation,
        "settings": history.json_ready(*settings),
        "keyed_strengths": list(cleaned.keyed),
        "prior_used": body.report(frames),
        "iterations": body.iterations,
        "converged": body.converged,
        "before": overall_figures(cleaned.before),
        "after": overall_figures(cleaned.after),
    }


def overall_figures(quality: Quality) -> dict[str, Any]:
    """Return the overall figures of a measurement; those of single joints would be too long."""
    every = quality.figures()
    return {name: value for name, value in every.items() if isinstance(value, (int, float))}


def _faults(quality: Quality) -> int:
    """Count the spikes and gaps over all joints, as Check and the card of Fix do."""
    return sum(len(find_runs(column)) for column in np.hstack([quality.spikes, quality.gaps]).T)
