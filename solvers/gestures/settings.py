"""What counts as a gesture; lengths are in arm lengths, from the shoulder to the wrist."""

from dataclasses import dataclass

from ..settings import Settings, setting


def _length(default: float, help: str) -> float:
    length: float = setting(default, help, unit="arms", minimum=0.0, maximum=3.0, advanced=True)
    return length


def _time(default: float, help: str, maximum: float = 10.0) -> float:
    seconds: float = setting(
        default, help, unit="s", minimum=0.02, maximum=maximum, advanced=True
    )
    return seconds


@dataclass(frozen=True, kw_only=True)
class GestureSettings(Settings):
    """Thresholds of the gestures. What more does is told for each."""

    least_confidence: float = setting(
        0.25,
        "Confidence from which on a joint counts as seen; higher trusts the sensor less",
        minimum=0.0,
        maximum=1.0,
        advanced=True,
    )
    patience: float = _time(0.25, "How long a lost hand is taken to be where it was", 2.0)
    raised: float = _length(0.45, "Height of the raised wrist above its shoulder")
    raised_for: float = _time(1.0, "How long the raised hand must be held still")
    still: float = _length(0.22, "How far a hand that is held still may stray")
    wave: float = _length(0.5, "Way of the hand that is a wave; higher needs wider waves")
    wave_within: float = _time(0.6, "Time in which the hand makes that way", 2.0)
    wave_pause: float = _time(0.7, "Time after a wave in which no other counts")
    browse_for: float = _time(
        15.0, "How long after the hand was up, or the last wave, waves still count", 600.0
    )
    waves_need_hand_up: bool = setting(
        True, "Count waves only while the library is shown", advanced=True
    )
    apart: float = _length(
        0.85, "Sideways distance of the hands from which on a clap may start"
    )
    together: float = _length(0.4, "Distance of the hands from which on they touch")
    clap_within: float = _time(0.8, "Time in which the hands come together in a clap", 2.0)
    touch_for: float = _time(1.0, "How long the hands may touch in a clap", 3.0)
    clap_pause: float = _time(0.8, "Time between claps of one applause, which counts once", 5.0)
    longest_capture: float = _time(
        60.0, "Time after which a performance that no clap has ended is dropped", 600.0
    )
    engage_for: float = _time(
        0.7, "How long hands are held still before they zoom or turn the view", 5.0
    )
    dead_zone: float = setting(
        0.04,
        "Change of zoom (as a share) or turn (rad) that is let pass as jitter",
        minimum=0.0,
        maximum=0.5,
        advanced=True,
    )
