"""Convert a quality measurement to plain numbers for JSON."""

from typing import TYPE_CHECKING, Any

import numpy as np

from ...signals import find_runs
from .joint_signals import Signal

if TYPE_CHECKING:
    from .measure import Quality


def quality_figures(quality: "Quality") -> dict[str, Any]:
    """Return nested dicts and lists of numbers, with units in the names; None means unknown."""
    figures: dict[str, Any] = {
        "n_frames": quality.n_frames,
        "frame_rate_hz": quality.frame_rate,
        "mean_jitter_m_per_s3": _json_number(quality.mean_jitter),
        "mean_rotation_noise_deg": _json_number(np.degrees(quality.rotation_noise)),
        "mean_position_noise_mm": _json_number(1000.0 * quality.position_noise),
        "spikes": sum(len(find_runs(signal.spikes)) for signal in quality.signals),
        "missing_share": float(np.mean([signal.gaps for signal in quality.signals])),
        "foot_slide_cm_per_s": _json_number(100.0 * quality.foot_slide),
        "longest_foot_slide_cm": _json_number(100.0 * quality.longest_foot_slide),
        "joints": {
            name: {"jitter_m_per_s3": _json_number(jitter)}
            for name, jitter in zip(quality.names, quality.jitter.tolist(), strict=True)
        },
    }
    for signal in quality.signals:
        figures["joints"][signal.joint].update(_signal_figures(signal))
    figures["feet"] = {
        foot.side: {
            "joint": foot.joint,
            "contact_share": float(foot.contact.mean()),
            "slide_cm_per_s": _json_number(100.0 * foot.mean_speed),
            "slide_cm": 100.0 * foot.distance,
        }
        for foot in quality.feet
    }
    figures["bones"] = [
        {
            "between": [bone.first, bone.second],
            "length_cm": 100.0 * bone.length,
            "drift_mm": 1000.0 * bone.drift,
        }
        for bone in quality.bones
    ]
    figures["bones_searched"] = quality.bones_searched
    figures["cuts"] = list(quality.cuts)
    figures["body_jumps"] = [
        {"frame": jump.frame, "distance_cm": 100.0 * jump.distance}
        for jump in quality.path_jumps
    ]
    figures["joint_jumps"] = [
        {"joint": signal.joint, "frame": frame, "angle_deg": float(np.degrees(angle))}
        for signal, frame, angle in quality.joint_jumps
    ]
    if quality.limit_excess is not None:
        worst = np.degrees(np.nan_to_num(quality.limit_excess).max(axis=0))
        beyond = zip(quality.names, worst.tolist(), strict=True)
        figures["beyond_limits_deg"] = {name: angle for name, angle in beyond if angle > 0.0}
    return figures


def _signal_figures(signal: Signal) -> dict[str, Any]:
    """Return the figures of one signal; the root has both a rotation and a position."""
    spikes = find_runs(signal.spikes)
    kind, noise, factor = (
        ("turn", "deg", 180.0 / np.pi) if signal.is_rotation else ("move", "mm", 1e3)
    )
    return {
        f"{kind}_noise_{noise}": factor * signal.noise,
        f"{kind}_spikes": len(spikes),
        f"{kind}_spike_frames": [start for start, _ in spikes],
        f"{kind}_gaps": [list(gap) for gap in find_runs(signal.gaps)],
    }


def _json_number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
