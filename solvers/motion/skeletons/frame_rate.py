"""Which frame rates a recording can have."""

from ...errors import InvalidMotionError

MIN_FRAME_RATE_HZ = 0.01
"""A frame in 100 s: slower than any time lapse of a moving body."""
MAX_FRAME_RATE_HZ = 10_000.0
"""Faster than any motion capture. Windows of filters are seconds long, so beyond it a mistaken
rate would ask for gigabytes."""


def check_frame_rate(frame_rate: float) -> None:
    """Raise InvalidMotionError where no recording has so many frames in a second."""
    if not MIN_FRAME_RATE_HZ <= frame_rate <= MAX_FRAME_RATE_HZ:
        raise InvalidMotionError(
            f"A frame rate of {frame_rate:g} Hz is not that of a recording: it must lie between"
            f" {MIN_FRAME_RATE_HZ:g} and {MAX_FRAME_RATE_HZ:,.0f} Hz."
        )
