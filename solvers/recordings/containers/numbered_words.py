"""Number the words of a column of a table, such as the names of joints."""

import re

import numpy as np
from numpy.typing import NDArray

from .text import decode_text

NUMBER = re.compile(rb"[-+]?(\d+[.,]?\d*|[.,]\d+)([eE][-+]?\d+)?")
MAX_DIGITS = 400
"""Maximum digits of a number that is sorted by size; floats have up to 309. It guards the
conversion, which Python refuses for long texts."""


class NumberedWords:
    """Numbers words as they appear, for the columns of a table; `1.0` is the word `1`."""

    def __init__(self) -> None:
        self._numbers: dict[bytes, int] = {}
        self._converted: dict[bytes, bytes] = {b"": b""}

    def __call__(self, cell: bytes) -> bytes:
        """Return the number of the word in a cell, as text; empty for an empty cell."""
        if cell not in self._converted:
            number = self._numbers.setdefault(_word(cell), len(self._numbers))
            self._converted[cell] = b"%d" % number
        return self._converted[cell]

    def __len__(self) -> int:
        return len(self._numbers)

    def name(self, number: int) -> str:
        """Return the word with this number."""
        return next((decode_text(w) for w, k in self._numbers.items() if k == number), "1")

    def in_order(self) -> tuple[tuple[str, ...], NDArray[np.intp]]:
        """Return the words, numbers among them by size, and the index of each in that list."""
        words = [*self._numbers]
        if all(word.isdigit() and len(word) <= MAX_DIGITS for word in words):
            words.sort(key=int)
        index = {word: number for number, word in enumerate(words)}
        order = np.array([index[word] for word in self._numbers])
        return tuple(decode_text(word) for word in words), order


def _word(cell: bytes) -> bytes:
    """Return a cell, a whole number without its decimals."""
    if cell.isdigit() or NUMBER.fullmatch(cell) is None:
        return cell
    value = float(cell.replace(b",", b"."))
    return b"%d" % value if value.is_integer() else cell
