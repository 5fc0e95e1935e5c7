"""Recognize the titles of columns with the numbers of frames."""

import re

FRAME = re.compile(
    r"(?:video[_ ]?)?(?:frame|image|img)(?:[_ ]?(?:id|index|idx|number|num|no|nr))?s?"
)


def is_frame_title(title: str) -> bool:
    """Return whether a column with this title has the numbers of frames."""
    return FRAME.fullmatch(title.strip().lower().replace(" ", "_").strip("#_")) is not None
