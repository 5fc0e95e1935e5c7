"""Break sentences into lines, in languages without spaces between words, too."""

import re
from collections.abc import Callable
from unicodedata import east_asian_width

NO_START = "、。，．：；！？）」』】〕》”’ー々ぁぃぅぇぉっゃゅょァィゥェォッャュョ"
"""Characters that Japanese and Chinese do not put at the start of a line."""
NO_END = "（「『【〔《“‘"
"""Characters that they do not put at the end of a line."""
WIDE = "WF"
"""Classes of Unicode whose characters are twice as wide as a letter."""
UNIT = re.compile(
    rf"\s+"
    rf"|[{NO_END}]*[^\s\u0000-\u2fff][{NO_START}]*"
    rf"|[^\s\u3000-\uffff]+[{NO_START}]*"
)
"""What stays together: spaces, one wide character, or a word, each with its punctuation."""


def broken_lines(text: str, fits: Callable[[str], bool]) -> list[str]:
    """Return lines that each fit, except for longer words."""
    lines = [""]
    for unit in UNIT.findall(text):
        if lines[-1] and not fits(lines[-1] + unit.rstrip()):
            lines.append("")
        lines[-1] += unit.lstrip() if not lines[-1] else unit
    return [line.rstrip() for line in lines if line.strip()]


def text_width(text: str) -> int:
    """Return the width of a text in letters."""
    return sum(2 if east_asian_width(letter) in WIDE else 1 for letter in text)
