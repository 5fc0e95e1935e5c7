"""The places of a take that need the animator's eye most."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

import numpy as np

from ...motion import Motion, Tracks
from ...progress import Progress, unwatched
from ...settings import Settings, setting
from ...signals import runs
from .joint_signals import Signal
from .measure import Quality, measure_quality

LONG_GAP = 0.25
"""Seconds that an animator can still bridge by eye: severity 1."""
CUT_SEVERITY = 10.0
"""What is joined should be taken apart before anything else is done."""
LARGE_EXCESS = np.radians(10.0)
"""Severity 1 of a joint beyond its limits; a fifth of it is not mentioned."""


@dataclass(frozen=True, kw_only=True)
class SpotSettings(Settings):
    """What is worth a look."""

    n_spots: int = setting(
        100,
        "Maximum number of issues to list; more shows milder ones",
        minimum=1,
        maximum=10000,
        label="Max Issues",
    )
    smallest_slide: float = setting(
        0.02,
        "Ignore planted feet that slide less; higher shows fewer issues",
        unit="m",
        minimum=0.001,
        maximum=1.0,
        label="Min Foot Slide",
    )
    shake_ratio: float = setting(
        3.0,
        "Shaking of a joint in multiples of the take's noise; higher shows fewer issues",
        minimum=1.0,
        maximum=100.0,
        label="Jitter Ratio",
    )
    smallest_shake_turn: float = setting(
        np.radians(1.0),
        "Ignore rotation jitter below this angle; higher shows fewer issues",
        unit="rad",
        minimum=0.0,
        maximum=np.pi,
        advanced=True,
        label="Min Rotation Jitter",
    )
    smallest_shake_move: float = setting(
        0.002,
        "Ignore position jitter below this distance; higher shows fewer issues",
        unit="m",
        minimum=0.0,
        maximum=1.0,
        advanced=True,
        label="Min Position Jitter",
    )
    pause: float = setting(
        0.2,
        "Merge issues of one joint that are closer in time; higher merges more",
        unit="s",
        minimum=0.0,
        maximum=10.0,
        advanced=True,
        label="Merge Time",
    )


@dataclass(frozen=True)
class Spot:
    """One fault of one joint."""

    joint: str
    start_frame: int
    stop_frame: int
    """The first frame after the fault."""
    kind: str
    """"spike", "gap", "jitter", "foot slide", "limit" or "cut"."""
    severity: float
    """1: just worth a look. Faults of all kinds are comparable."""
    sentence: str


def find_worst_spots(
    recording: Motion | Tracks,
    quality: Quality | None = None,
    *,
    settings: SpotSettings = SpotSettings(),
    progress: Progress = unwatched,
) -> tuple[Spot, ...]:
    """List the faults of a take, worst first.

    Shaking is judged against the take itself: a joint is listed where its noise is several
    times the median over all joints and frames, not where the whole take is noisy.

    Parameters
    ----------
    recording : Motion or Tracks
    quality : Quality
        What `measure_quality` found in this recording; measured here where it is not given.
    settings : SpotSettings
    progress : Progress

    Returns
    -------
    tuple of Spot
        As many as the settings allow.

    Raises
    ------
    SolveCancelled
        Raised by `progress`.
    """
    if quality is None:
        quality = measure_quality(recording, progress=progress)
    pause = round(settings.pause * quality.frame_rate)
    found = [
        *_spikes(quality, pause),
        *_gaps(quality),
        *_shaking(quality, settings, pause),
        *_slides(quality, settings),
        *_beyond_limits(quality, pause),
        *_cuts(quality),
    ]
    found.sort(key=lambda spot: (-spot.severity, spot.start_frame, spot.joint))
    progress(1.0, "Found the worst spots")
    return tuple(islice(found, settings.n_spots))


def _spikes(quality: Quality, pause: int) -> Iterator[Spot]:
    for signal in quality.signals:
        for start, stop in _merged(runs(signal.spikes), pause):
            height = float(
                np.nanmax(np.where(signal.spikes, signal.deviation, 0.0)[start:stop])
            )
            times = len(runs(signal.spikes[start:stop]))
            often = f" {times} times, by up to" if times > 1 else " by"
            yield Spot(
                signal.joint,
                start,
                stop,
                "spike",
                height / signal.spike_threshold,
                f"{signal.joint} jumps{often} {_amount(signal, height)}.",
            )


def _gaps(quality: Quality) -> Iterator[Spot]:
    for signal in quality.signals:
        for start, stop in runs(signal.gaps):
            seconds = (stop - start) / quality.frame_rate
            whole = stop - start == quality.n_frames
            sentence = (
                f"{signal.joint} is never observed."
                if whole
                else f"{signal.joint} is missing for {seconds:.2f} s."
            )
            yield Spot(signal.joint, start, stop, "gap", seconds / LONG_GAP, sentence)


def _shaking(quality: Quality, settings: SpotSettings, pause: int) -> Iterator[Spot]:
    for turns, smallest in (
        (True, settings.smallest_shake_turn),
        (False, settings.smallest_shake_move),
    ):
        signals = [signal for signal in quality.signals if signal.turns is turns]
        if not signals:
            continue
        usual = float(np.median([signal.shake for signal in signals]))
        threshold = max(settings.shake_ratio * usual, smallest)
        for signal in signals:
            for start, stop in _merged(runs(signal.shake > threshold), pause):
                level = float(signal.shake[start:stop].max())
                amount = _amount(signal, level) + _compared(level, usual)
                yield Spot(
                    signal.joint,
                    start,
                    stop,
                    "jitter",
                    level / threshold,
                    f"{signal.joint} shakes by {amount}.",
                )


def _slides(quality: Quality, settings: SpotSettings) -> Iterator[Spot]:
    for foot in quality.feet:
        for start, stop in runs(foot.contact):
            way = float(np.linalg.norm(np.nansum(foot.steps[start:stop], axis=0)))
            if way >= settings.smallest_slide:
                yield Spot(
                    foot.joint,
                    start,
                    stop,
                    "foot slide",
                    way / settings.smallest_slide,
                    f"{foot.joint} slides {100 * way:.1f} cm while it stands.",
                )


def _beyond_limits(quality: Quality, pause: int) -> Iterator[Spot]:
    if quality.limit_excess is None:
        return
    for name, excess in zip(quality.names, quality.limit_excess.T, strict=True):
        for start, stop in _merged(runs(excess > LARGE_EXCESS / 5), pause):
            angle = float(excess[start:stop].max())
            sentence = f"{name} turns {np.degrees(angle):.0f}° beyond its limits."
            yield Spot(name, start, stop, "limit", angle / LARGE_EXCESS, sentence)


def _cuts(quality: Quality) -> Iterator[Spot]:
    for frame in quality.cuts:
        sentence = "The whole body jumps: the take is cut here, or begins with a pose apart."
        yield Spot(quality.names[0], frame - 1, frame + 1, "cut", CUT_SEVERITY, sentence)


def _merged(stretches: list[tuple[int, int]], pause: int) -> list[tuple[int, int]]:
    """Join stretches that are at most `pause` frames apart."""
    merged: list[tuple[int, int]] = []
    for start, stop in stretches:
        if merged and start - merged[-1][1] <= pause:
            merged[-1] = (merged[-1][0], stop)
        else:
            merged.append((start, stop))
    return merged


def _amount(signal: Signal, value: float) -> str:
    if signal.turns:
        return f"{np.degrees(value):.1f}°"
    return f"{100 * value:.1f} cm"


def _compared(level: float, usual: float) -> str:
    if usual <= 0.0:
        return ""
    return f", {level / usual:.0f} times as much as is usual here"
