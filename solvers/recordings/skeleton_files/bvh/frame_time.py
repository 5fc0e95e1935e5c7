"""Read the frame time of a BVH file, however it is written."""

import re
from decimal import Decimal, InvalidOperation

from ....progress import Progress, Remark
from ...conventions import common_rate
from ...point_bodies import time_name

COMMON_RATES = (24, 25, 30, 48, 50, 60, 90, 100, 120, 200, 240, 23.976, 29.97, 59.94, 119.88)
MIN_TIME_S = 1e-5
"""Frame times from which they are some, seconds. It guards wrong numbers."""
MS_PER_S = 1000.0
"""Milliseconds per second, by definition."""
MIN_FRAME_MS = 4.0
"""Frame times from which they are no seconds. By definition that of 250 Hz in milliseconds, the
highest rate that capture software records."""
RATE_DIGITS = 3
"""Digits after the point of rates that are stated in place of frame times. By definition those
of the common ones."""
QUANTITY = re.compile(
    r"(?P<number>[-+\d.,e]+|snan|nan)(?:\s*/\s*(?P<divisor>\d+(?:[.,]\d+)?))?\s*(?P<unit>[a-z]{0,12})",
    re.IGNORECASE,
)


def rate_of_frame_time(text: str, progress: Progress) -> float | None:
    """Return the rate of a frame time in hertz; None for what no recording has.

    The time may be a fraction of a second or have a unit, such as `1/25`, `40 ms` or `25 fps`.
    Without a unit, the rate or milliseconds may be in its place, which is reported:
    milliseconds of a common rate may be cut or rounded; other whole numbers are rates.
    """
    words = QUANTITY.fullmatch(text)
    if words is None:
        return None
    word, unit = words["number"], words["unit"]
    if words["divisor"]:
        return _rate_of_fraction(word, words["divisor"])
    if unit in {"hz", "fps"}:
        return _rate_of_fraction("1", word)
    if unit:
        name = time_name(f"time ({unit})")
        return None if name is None else _rate_from_time(word, name.second or 1.0)
    rate = _rate_from_time(word)
    if rate is None or 1.0 / rate < MIN_FRAME_MS:
        return rate
    time = round(1.0 / rate, RATE_DIGITS)
    common = min(COMMON_RATES, key=lambda each: abs(MS_PER_S / each - time))
    if time in COMMON_RATES:
        rate = time
    elif -0.5 <= MS_PER_S / common - time < 1.0:
        rate = common
    else:
        rate = time if time.is_integer() else common_rate(MS_PER_S / time)
    progress(0.1, Remark(f"A frame time of {time:g} is interpreted as {rate:g} Hz"))
    return float(rate)


def _rate_of_fraction(dividend: str, divisor: str) -> float | None:
    """Return the rate of a frame time such as 1001/30000 s."""
    time, rest = (float(each.replace(",", ".")) for each in (dividend, divisor))
    rate = rest / time if time > 0.0 else 0.0
    return float(f"{rate:.6g}") if MIN_TIME_S < rate < 1.0 / MIN_TIME_S else None


def _rate_from_time(word: str, second: float = 1.0) -> float | None:
    """Return the common rate whose frame time rounds to `word`: 0.00833333 means 120 Hz."""
    try:
        exact = Decimal(word.replace(",", ".")) * Decimal(f"{second:g}")
        time = float(exact)
    except (InvalidOperation, ValueError):  # sNaN is a decimal, but no float
        return None
    if not MIN_TIME_S < time < 1e3:
        return None
    nearest_integer = round(1.0 / time)
    half_digit = 0.51 * 10.0 ** int(exact.as_tuple().exponent)
    for rate, tolerance in [
        (nearest_integer, 1e-12),
        *((rate, half_digit) for rate in COMMON_RATES),
        (nearest_integer, min(half_digit, 1e-8)),
    ]:
        if rate and abs(1.0 / rate - time) <= tolerance:
            return float(rate)
    return 1.0 / time
