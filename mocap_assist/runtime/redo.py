"""Cache the last solution, so that the redo panel does not solve the same problem again."""

import hashlib
import pickle
from typing import Any

_last: dict[str, Any] = {}


def fingerprint(problem: Any) -> str:
    """Return a digest of a picklable value: equal problems, and only those, have equal ones."""
    return hashlib.sha256(pickle.dumps(problem)).hexdigest()


def remember(problem: Any, solution: Any) -> None:
    """Keep one solution; the one before is forgotten, so that memory stays bounded."""
    _last.clear()
    _last[fingerprint(problem)] = solution


def recall(problem: Any) -> Any:
    """Return the solution of this very problem if it was the last one, else None."""
    return _last.get(fingerprint(problem)) if _last else None
