"""Divide the takes of a batch among machines."""

import argparse
import re
import unicodedata
from hashlib import sha256
from typing import NamedTuple


class Shard(NamedTuple):
    """One of several parts of a batch; takes that are added to the batch do not move others."""

    number: int
    """From 1."""
    n_shards: int

    def has(self, name: str) -> bool:
        """Return whether a take belongs to this part, from its path below the named folder."""
        plain = unicodedata.normalize("NFC", name)  # macOS decomposes letters.
        digest = sha256(plain.encode("utf-8", "surrogatepass")).digest()
        return int.from_bytes(digest[:8]) % self.n_shards == self.number - 1


def parse_shard(word: str) -> Shard:
    """Return the part that `I/N` names, for argparse."""
    found = re.fullmatch(r"(\d{1,9})/(\d{1,9})", word, re.ASCII)
    if found is None or not 1 <= int(found[1]) <= int(found[2]):
        raise argparse.ArgumentTypeError(
            f"{word!r} is no part of a batch; write I/N with I from 1 to N, such as 2/5"
        )
    return Shard(int(found[1]), int(found[2]))
