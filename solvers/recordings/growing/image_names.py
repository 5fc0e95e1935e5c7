"""Positions of images in a recording, by the numbers or time stamps in their names."""

import re
from enum import Enum
from pathlib import Path
from typing import NamedTuple

MAX_DIGITS = 9
"""Digits of a number that counts images. By definition of `frames_by_number`: longer ones are
time stamps in a unit that the name does not state."""


class PositionKind(Enum):
    """Meaning of the positions of a recording's images."""

    NUMBERS = "count images; a number without an image is a gap"
    TIMES = "are seconds"
    ORDER = "say only which image comes first"


class ImageName(NamedTuple):
    """The parts of a name."""

    head: str
    """Text before the number, by which recorders are distinguished; empty for time stamps."""
    position: float
    kind: PositionKind


def parse_image_name(name: str) -> ImageName:
    """Return the parts of a file's name; one without a number at its end has the position 0."""
    stem = Path(name).stem
    if re.fullmatch(r"\d+\.\d+", stem):
        return ImageName("", float(stem), PositionKind.TIMES)
    number = re.search(r"\d+$", stem)
    if number is None:
        return ImageName("", 0.0, PositionKind.ORDER)
    is_count = len(number[0]) <= MAX_DIGITS and "." not in stem
    kind = PositionKind.NUMBERS if is_count else PositionKind.ORDER
    return ImageName(stem[: number.start()], float(number[0]), kind)
