"""One fault of a take, as an animator reads it."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Issue:
    """One fault of one joint."""

    joint: str
    start_frame: int
    stop_frame: int
    """The first frame after the fault."""
    kind: str
    """"spike", "jump", "gap", "jitter", "foot slide", "limit" or "cut". A spike returns, a jump
    stays, and at a cut most of the body jumps."""
    severity: float
    """1 just deserves a look. Severities of all kinds are comparable."""
    sentence: str
