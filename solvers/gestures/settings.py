"""Settings of gesture recognition; lengths are in arm lengths, from shoulder to wrist."""

from dataclasses import dataclass

from ..settings import Settings, setting


def _length(default: float, help: str, former: str = "") -> float:
    length: float = setting(
        default, help, unit="arms", minimum=0.0, maximum=3.0, advanced=True, former=former
    )
    return length


def _time(default: float, help: str, maximum: float = 10.0) -> float:
    seconds: float = setting(
        default, help, unit="s", minimum=0.02, maximum=maximum, advanced=True
    )
    return seconds


@dataclass(frozen=True, kw_only=True)
class GestureSettings(Settings):
    """Thresholds of the gestures."""

    min_confidence: float = setting(
        0.25,
        "Minimum confidence of an observed joint; higher ignores more of the sensor's data",
        minimum=0.0,
        maximum=1.0,
        advanced=True,
        former="least_confidence",
    )
    patience: float = _time(0.25, "Time for which a missing hand keeps its last position", 2.0)
    raised: float = _length(0.45, "Height of the raised wrist above its shoulder")
    raised_for: float = _time(1.0, "Time for which the raised hand must be held still")
    still: float = _length(0.22, "Maximum movement of a hand held still")
    wave: float = _length(0.5, "Minimum length of a wave; higher needs wider waves")
    wave_within: float = _time(0.6, "Maximum duration of a wave", 2.0)
    wave_pause: float = _time(0.7, "Pause after a wave in which others are ignored")
    browse_for: float = _time(
        15.0, "Time for which waves count after the raised hand or the last wave", 600.0
    )
    waves_need_hand_up: bool = setting(
        True, "Count waves only while the library is shown", advanced=True
    )
    hand_distance: float = _length(
        0.85, "Minimum sideways distance of the hands at the start of a clap", "apart"
    )
    together: float = _length(0.4, "Maximum distance of touching hands")
    clap_within: float = _time(0.8, "Maximum time in which the hands close in a clap", 2.0)
    touch_for: float = _time(1.0, "Maximum time that the hands touch in a clap", 3.0)
    clap_pause: float = _time(
        0.8, "Maximum time between claps of applause, which counts once", 5.0
    )
    longest_capture: float = _time(
        60.0, "Time after which a performance without a second clap is dropped", 600.0
    )
    engage_for: float = _time(
        0.7, "Time for which hands must be still before they zoom or turn the view", 5.0
    )
    dead_zone: float = setting(
        0.04,
        "Change of zoom (fraction) or turn (rad) that is ignored as jitter",
        minimum=0.0,
        maximum=0.5,
        advanced=True,
    )
