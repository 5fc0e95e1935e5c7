"""Measure how many images a second a recorder writes."""

import numpy as np

from .growing_source import ImagePositions, NewImage

MIN_WRITTEN_S = 3.0
"""Seconds of images from which their rate is measured. It guards recorders that write a second
of images at once (`test_rate_at_which_files_are_written_is_compared`)."""
MAX_RATE_ERROR = 0.2
"""Fraction by which the rate of the motion may differ from that of the files. It guards disks
that are late and cameras that are slower in the dark; those of 15 Hz are off by far more
(`test_rate_at_which_files_are_written_is_compared`)."""


class WrittenRate:
    """Compares the times of images' files with the times that the images have in the motion."""

    def __init__(self) -> None:
        self._images: list[tuple[float, float]] = []
        """Position and time of each file."""

    def add(self, image: NewImage) -> None:
        """Add the next image that was written while the recording was followed."""
        self._images.append((image.position, image.written))

    def remark(self, assumed: ImagePositions) -> str:
        """Return a sentence if the files were written at another rate; otherwise nothing."""
        if len(self._images) < 2:
            return ""
        positions, written = np.array(self._images).T
        written -= written[0]
        if np.ptp(written) < MIN_WRITTEN_S:
            return ""
        frames = np.arange(len(positions), dtype=np.float64)
        if assumed.seconds_per_unit:
            frames = positions * (assumed.seconds_per_unit * assumed.frame_rate)
        rate = float(np.polyfit(written, frames, 1)[0])
        if rate <= 0.0 or abs(assumed.frame_rate / rate - 1.0) <= MAX_RATE_ERROR:
            return ""
        return (
            f"The recorder wrote about {rate:.3g} images a second, but the motion has"
            f" {assumed.frame_rate:.3g}: it may play {assumed.frame_rate / rate:.2g} times as"
            " fast as the actor moved. Set the frame rate of the camera."
        )
