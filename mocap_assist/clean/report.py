"""What Clean says about its result: in the status bar, and in the action's history."""

from typing import Any

import numpy as np

from ...solvers.denoising import Quality
from ..scene import history
from .choices import CleanSettings
from .solve_cleaning import Cleaned


def clean_report(n_frames: int, cleaned: Cleaned, name: str, n_modified: int = 0) -> str:
    """Return a few sentences for the status bar; `n_modified` curves had modifiers."""
    body = cleaned.solution.denoised[0]
    before, after = cleaned.before, cleaned.after
    said = [
        f"{name}: {n_frames} frames, shaking by {_shake(before)} before and {_shake(after)}"
        f" now, {_count(body.outliers)} spikes and {_count(before.gaps)} gaps mended."
    ]
    if cleaned.planted is not None:
        said.append(
            f"Feet slid {100 * cleaned.planted.slide_before:.1f} cm, now"
            f" {100 * cleaned.planted.slide_after:.1f} cm; legs and hips moved for that."
        )
    if swaps := cleaned.solution.swaps:
        said.append(f"{len(swaps)} swaps of labels were put right.")
    said.append(body.prior_used)
    if n_modified:
        said.append(f"The modifiers of {n_modified} curves are part of the new keys now.")
    if not all(each.converged for each in cleaned.solution.denoised):
        said.append("The estimate had not settled when it was stopped.")
    return " ".join(said)


def entry_of(operation: str, settings: CleanSettings, cleaned: Cleaned) -> dict[str, Any]:
    """Return what the action's history keeps, JSON-ready."""
    body = cleaned.solution.denoised[0]
    return {
        "operation": operation,
        "settings": history.plain(*settings),
        "prior_used": body.prior_used,
        "iterations": body.iterations,
        "converged": body.converged,
        "before": figures(cleaned.before),
        "after": figures(cleaned.after),
    }


def figures(quality: Quality) -> dict[str, Any]:
    """Return the overall figures of a measurement; those of single joints would be too long."""
    every = quality.figures()
    return {name: value for name, value in every.items() if isinstance(value, (int, float))}


def _shake(quality: Quality) -> str:
    """Return the mean noise of the rotations or, of markers, that of the places."""
    if turns := [signal.noise for signal in quality.signals if signal.turns]:
        return f"{np.degrees(np.nanmean(turns)):.2f} degrees"
    places = [signal.noise for signal in quality.signals]
    return f"{1000.0 * np.nanmean(places):.2f} mm"


def _count(flags: np.ndarray) -> int:
    """Count the stretches of True along the frames, over all joints."""
    starts = np.diff(flags.astype(np.int8), axis=0, prepend=0) > 0
    return int(starts.sum())
