"""List the issues of a take that need the animator's attention, worst first."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

import numpy as np

from ...motion import Motion, Tracks
from ...motion.skeletons import MIN_JUMP_M
from ...progress import Progress, unwatched
from ...settings import Settings, setting
from ...signals import find_runs, merge_runs
from .gap_issues import gap_issues
from .issue import Issue
from .joint_jumps import MIN_JUMP_RAD
from .joint_signals import Signal
from .measure import Quality, measure_quality

CUT_SEVERITY = 10.0
"""Severity of a cut, chosen by hand: joined recordings should be split before any other edit.
It decides the order of a list only."""
MAX_NAMED_RATIO = 100.0
"""Ratio of jitter to that of the take up to which it is named. Chosen by hand: where the median
joint has next to none, such as in takes from a computer, the ratio is in the millions."""
SEVERE_EXCESS = np.radians(10.0)
"""Radians beyond a joint limit with severity 1, by definition; a fifth of it is not
reported."""


@dataclass(frozen=True, kw_only=True)
class IssueSettings(Settings):
    """Thresholds of the issues to list."""

    max_issues: int = setting(
        100,
        "Maximum number of issues to list; more shows milder ones",
        minimum=1,
        maximum=10000,
        label="Max Issues",
        former="n_spots",
    )
    min_slide: float = setting(
        0.02,
        "Ignore planted feet that slide less; higher shows fewer issues",
        unit="m",
        minimum=0.001,
        maximum=1.0,
        label="Min Foot Slide",
        former="smallest_slide",
    )
    shake_ratio: float = setting(
        3.0,
        "Jitter of a joint in multiples of the take's noise; higher shows fewer issues",
        minimum=1.0,
        maximum=100.0,
        label="Jitter Ratio",
    )
    min_rotation_jitter: float = setting(
        np.radians(1.0),
        "Ignore rotation jitter below this angle; higher shows fewer issues",
        unit="rad",
        minimum=0.0,
        maximum=np.pi,
        advanced=True,
        label="Min Rotation Jitter",
        former="smallest_shake_turn",
    )
    min_position_jitter: float = setting(
        0.002,
        "Ignore position jitter below this distance; higher shows fewer issues",
        unit="m",
        minimum=0.0,
        maximum=1.0,
        advanced=True,
        label="Min Position Jitter",
        former="smallest_shake_move",
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


def find_worst_issues(
    recording: Motion | Tracks,
    quality: Quality | None = None,
    *,
    settings: IssueSettings = IssueSettings(),
    progress: Progress = unwatched,
) -> tuple[Issue, ...]:
    """List the faults of a take, worst first.

    The take itself sets the scale of jitter: a joint is listed where its noise is several times
    the median over all joints and frames, not where the entire take is noisy.

    Parameters
    ----------
    recording : Motion or Tracks
    quality : Quality
        Result of `measure_quality` for this recording; measured here if not given.
    settings : IssueSettings
    progress : Progress

    Returns
    -------
    tuple of Issue
        At most as many as the settings allow.

    Raises
    ------
    SolveCancelled
        Raised by `progress`.
    """
    if quality is None:
        quality = measure_quality(recording, progress=progress)
    pause = round(settings.pause * quality.frame_rate)
    issues = [
        *_spikes(quality, pause),
        *_path_jumps(quality),
        *_joint_jumps(quality),
        *gap_issues(quality, pause),
        *_jitter(quality, settings, pause),
        *_slides(quality, settings),
        *_beyond_limits(quality, pause),
        *_cuts(quality),
    ]
    issues.sort(key=lambda issue: (-issue.severity, issue.start_frame, issue.joint))
    progress(1.0, "Found the worst issues")
    return tuple(islice(issues, settings.max_issues))


def _spikes(quality: Quality, pause: int) -> Iterator[Issue]:
    for signal in quality.signals:
        for start, stop in merge_runs(find_runs(signal.spikes), pause):
            height = float(
                np.nanmax(np.where(signal.spikes, signal.deviation, 0.0)[start:stop])
            )
            n_spikes = len(find_runs(signal.spikes[start:stop]))
            amount = _amount(signal, height)
            sentence = (
                f"{signal.joint} jumps {n_spikes} times, by up to {amount}."
                if n_spikes > 1
                else f"{signal.joint} jumps by {amount}."
            )
            yield Issue(
                signal.joint,
                start,
                stop,
                "spike",
                height / signal.spike_threshold,
                sentence,
            )


def _joint_jumps(quality: Quality) -> Iterator[Issue]:
    for signal, frame, angle in quality.joint_jumps:
        sentence = _describe_lasting_jump(signal.joint, _amount(signal, angle))
        yield Issue(signal.joint, frame - 1, frame + 1, "jump", angle / MIN_JUMP_RAD, sentence)


def _describe_lasting_jump(joint: str, amount: str) -> str:
    return f"{joint} jumps by {amount} and stays there."


def _path_jumps(quality: Quality) -> Iterator[Issue]:
    name = quality.names[0]
    for jump in quality.path_jumps:
        frame, distance = jump.frame, jump.distance
        sentence = _describe_lasting_jump(name, f"{100 * distance:.0f} cm")
        yield Issue(name, frame - 1, frame + 1, "jump", distance / MIN_JUMP_M, sentence)


def _jitter(quality: Quality, settings: IssueSettings, pause: int) -> Iterator[Issue]:
    for is_rotation, min_noise in (
        (True, settings.min_rotation_jitter),
        (False, settings.min_position_jitter),
    ):
        signals = [signal for signal in quality.signals if signal.is_rotation is is_rotation]
        if not signals:
            continue
        typical_noise = float(np.median([signal.local_noise for signal in signals]))
        threshold = max(settings.shake_ratio * typical_noise, min_noise)
        for signal in signals:
            for start, stop in merge_runs(find_runs(signal.local_noise > threshold), pause):
                level = float(signal.local_noise[start:stop].max())
                yield Issue(
                    signal.joint,
                    start,
                    stop,
                    "jitter",
                    level / threshold,
                    _describe_jitter(signal, level, typical_noise),
                )


def _describe_jitter(signal: Signal, level: float, typical_noise: float) -> str:
    joint, amount = signal.joint, _amount(signal, level)
    if level > MAX_NAMED_RATIO * typical_noise:
        return f"{joint} jitters by {amount}; most of the take does not jitter."
    ratio = f"{level / typical_noise:.0f}"
    return f"{joint} jitters by {amount}, {ratio} times the typical noise of the take."


def _slides(quality: Quality, settings: IssueSettings) -> Iterator[Issue]:
    for foot in quality.feet:
        for start, stop, slide in foot.slides:
            if slide >= settings.min_slide:
                yield Issue(
                    foot.joint,
                    start,
                    stop,
                    "foot slide",
                    slide / settings.min_slide,
                    f"{foot.joint} slides {100 * slide:.1f} cm while it is planted.",
                )


def _beyond_limits(quality: Quality, pause: int) -> Iterator[Issue]:
    if quality.limit_excess is None:
        return
    for name, excess in zip(quality.names, quality.limit_excess.T, strict=True):
        for start, stop in merge_runs(find_runs(excess > SEVERE_EXCESS / 5), pause):
            angle = float(excess[start:stop].max())
            sentence = f"{name} turns {np.degrees(angle):.0f}° beyond its limits."
            yield Issue(name, start, stop, "limit", angle / SEVERE_EXCESS, sentence)


def _cuts(quality: Quality) -> Iterator[Issue]:
    for frame in quality.cuts:
        sentence = (
            "The entire body jumps: the take is cut here, or it begins with a separate pose."
        )
        yield Issue(quality.names[0], frame - 1, frame + 1, "cut", CUT_SEVERITY, sentence)


def _amount(signal: Signal, value: float) -> str:
    if signal.is_rotation:
        return f"{np.degrees(value):.1f}°"
    return f"{100 * value:.1f} cm"
