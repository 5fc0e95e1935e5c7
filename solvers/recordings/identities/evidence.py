"""What shows that a tracker switched identities: the same for files and for live streams."""

MAX_PEOPLE = 16
"""Number of people that are followed. It bounds time and memory."""
BODY_TIMEOUT_S = 1.0
"""Duration in seconds without a person after which the last position is no evidence. It guards
people who walk while they are hidden."""
MIN_SWITCH_M = 0.25
"""Meters: a person who jumps as far to where another one was has the other's identity. It
guards people whose positions differ by less than sensors err."""
SWITCH_RATIO = 0.5
"""Distance to the other's position over that to the own one, below which identities were
switched. It guards people who pass each other."""
MAX_RETURN_M = 0.5
"""Meters from the last position within which a new identity is that of someone who was just
missing. It guards people who come in where another one went."""


def continues_other_path(other: float, own: float) -> bool:
    """Return whether a position continues another person's path rather than the own one.

    Parameters
    ----------
    other, own : float
        Distances from the last position of the other person and from the own one, in one unit.
    """
    return other < SWITCH_RATIO * own
