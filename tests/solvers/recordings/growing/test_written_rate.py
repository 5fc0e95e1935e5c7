"""A recorder that writes at another rate than the motion assumes is reported."""

import os
from itertools import count

import numpy as np
import pytest
from depth_folders import save_png

from solvers.recordings import DepthSettings
from solvers.recordings.growing import GrowingFolder

DEPTH = np.full((6, 8), 1000, np.uint16)
LENS = {"fx": 9.0, "fy": 8.0, "cx": 3.25, "cy": 2.75}


@pytest.mark.parametrize(
    ("name", "rate", "per_burst", "given", "words"),
    [
        ("{:04}.png", 15.0, 1, 0.0, "wrote about 15 images a second, but the motion has 30"),
        ("{:013}.png", 60.0, 1, 0.0, "about 60 images a second"),
        ("{:04}.png", 15.0, 15, 0.0, "but the motion has 30"),
        ("{:04}.png", 30.0, 30, 0.0, ""),
        ("{:04}.png", 27.0, 1, 0.0, ""),
        ("{:04}.png", 15.0, 1, 15.0, ""),
        ("1305031102.{:04}.png", 15.0, 1, 0.0, ""),
    ],
)
def test_rate_at_which_files_are_written_is_compared(
    tmp_path, name, rate, per_burst, given, words
):
    """Files that were there before say nothing: they may be copies."""
    settings = DepthSettings(scale=0.001, frame_rate=given, **LENS)
    source = GrowingFolder(tmp_path, settings, now=count(1.0).__next__)
    found = []
    for number in range(100 + int(4.0 * rate)):
        save_png(tmp_path / name.format(number), DEPTH)
        at = 1000.0 + number // per_burst * per_burst / rate
        os.utime(tmp_path / name.format(number), (at, at) if number >= 100 else (1.0, 1.0))
        if number >= 99:
            found += source.poll()
    source.positions([image.position for image in found[:45]])

    remarks = source.remarks()

    assert len(remarks) == bool(words) and all(words in each for each in remarks)
