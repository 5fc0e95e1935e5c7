"""Follow people by their positions where a tracker switches their identities."""

from .evidence import (
    BODY_TIMEOUT_S,
    MAX_PEOPLE,
    MAX_RETURN_M,
    MIN_SWITCH_M,
    continues_other_path,
)
from .relabel import follow_arrays, follow_bodies, follow_columns

__all__ = [
    "BODY_TIMEOUT_S",
    "MAX_PEOPLE",
    "MAX_RETURN_M",
    "MIN_SWITCH_M",
    "continues_other_path",
    "follow_arrays",
    "follow_bodies",
    "follow_columns",
]
