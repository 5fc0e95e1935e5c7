"""Check the frame rate of a recording."""

from ...errors import InvalidMotionError

MIN_FRAME_RATE_HZ = 0.01
"""One frame in 100 s: slower than any time lapse of a moving body. It guards against damaged
files."""
MAX_FRAME_RATE_HZ = 10_000.0
"""Faster than any motion capture. Filter windows last seconds, so a wrong rate above it would
need gigabytes. It guards against damaged files."""


def check_frame_rate(frame_rate: float) -> None:
    """Raise InvalidMotionError if the frame rate is outside the valid range."""
    if not MIN_FRAME_RATE_HZ <= frame_rate <= MAX_FRAME_RATE_HZ:
        raise InvalidMotionError(
            f"A frame rate of {frame_rate:g} Hz is not that of a recording: it must be"
            f" between {MIN_FRAME_RATE_HZ:g} and {MAX_FRAME_RATE_HZ:,.0f} Hz."
        )
