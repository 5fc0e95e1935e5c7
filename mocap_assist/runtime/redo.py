"""Cache the last solution, so that the redo panel does not solve the same problem again."""

import hashlib
import pickle
from typing import Any

_last: dict[str, Any] = {}


def fingerprint(problem: Any) -> str:
    """Return a digest of a picklable value; only equal problems have equal digests."""
    return hashlib.sha256(pickle.dumps(problem)).hexdigest()


def remember(problem: Any, solution: Any) -> None:
    """Cache one solution in place of the previous one, so that memory stays bounded."""
    _last.clear()
    _last[fingerprint(problem)] = solution


def recall(problem: Any) -> Any:
    """Return the cached solution if it solves the same problem, otherwise None."""
    return _last.get(fingerprint(problem)) if _last else None
