"""Estimate the unit of length of a file by the likelihood of the body's size."""

from collections.abc import Sequence
from math import exp, inf, log, pi, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...motion import unit_name
from .axes import (
    ACCLAIM_UNIT,
    ADULT_REACH_M,
    CENTIMETER,
    MILLIMETER,
    MIN_BODY_JOINTS,
    longest_bone_path,
)

MODELED_UNITS = {CENTIMETER: 0.7, 1.0: 0.2, MILLIMETER: 0.05}
"""Prior probability, a ratio, of the units of programs that model bodies of any size. Chosen by
hand: of 18 makers of BVH files in docs/benchmarks/importing.md, 11 write centimeters."""
CAPTURED_UNITS = {0.0254: 0.03, 0.3048: 0.02, 0.1: 0.002}
"""The same, a ratio, of units in which only recordings of people are written. Chosen by hand:
x2 for inches makes adults of children of 0.84 m in centimeters
(`test_children_and_giants_stay_what_they_are`)."""
SKELETON_UNITS = {ACCLAIM_UNIT: 0.08}
"""The same, a ratio, of what only skeletons of adults are written in. By definition of the
Acclaim format, and of the actors of CMU's and other libraries in it."""
SCALED = 0.035
"""The same, a ratio, of a unit of its own, by which a body is scaled to an adult's size. Chosen
by hand: x0.5 fails `test_units_of_no_program_give_an_adult_and_are_reported`, x2 makes adults
of giants of 3.8 m."""
SCALED_UNITS_M = (MILLIMETER, 2.0)
"""Range of such a unit, meters. By definition from the smallest usual unit to twice the
largest: a person in a unit of 2 m has a height of 0.9."""
DEFAULT = 0.6
"""Prior probability, a ratio, of the default unit of a format. Chosen by hand: 4.4 m, 2.5 times
an adult's height, remain, and 5.7 m, an adult's in feet, do not."""
ADULTS, CHILDREN, OTHERS = (0.9, 0.0, 0.1), (0.05, -0.43, 0.25), (0.08, 0.2, 0.6)
"""Fraction of bodies, and mean and standard deviation of the logarithm of their size relative
to an adult's, as ratios. Chosen by hand: lengths of nine makers' adults differ by 10 %,
children have 0.4 to 1.0 of them, and games have giants rather than dwarfs."""
NO_BODY = 1e-4
"""Density, a ratio, of what is no body. It guards what is no person from any other unit than
the likeliest (`test_no_unit_makes_a_man_of_an_ant`)."""
RARE = 0.05
"""Prior, a ratio, below which a unit is reported. Chosen by hand: inches, 0.03, and rarer."""
NEARLY_AS_LIKELY = 0.25
"""Probability relative to the estimate's from which another unit is reported, a ratio. Chosen
by hand: 4 of 5 such estimates are right. It decides a sentence of the report only."""


class UnitEstimate(NamedTuple):
    """Unit of length of a file, in meters."""

    unit: float
    is_rare: bool
    """Whether few files have this unit."""
    rival: float | None
    """The next unit, where it is nearly as likely and gives a body of another size."""

    @property
    def has_low_confidence(self) -> bool:
        """Whether a report says how lengths are interpreted."""
        return self.is_rare or self.rival is not None


def estimate_unit(
    size: float,
    *,
    default: float | None = None,
    is_body: bool = True,
    is_skeleton: bool = True,
) -> UnitEstimate:
    """Return the most probable unit of a body of a size.

    Each usual unit has a prior probability and makes the body a size that adults, children or
    other characters have more or less often; a unit of its own would make it an adult.

    Parameters
    ----------
    size : float
        Size of the body in units of the file, relative to that of an adult in meters.
    default : float, meters, or None
        Default unit of the format.
    is_body : bool
        Whether the joints are known to be those of a person; only then the unit may be any.
    is_skeleton : bool
        Whether the file holds bones rather than points.
    """
    others = 1.0 if default is None else 1.0 - DEFAULT
    known = MODELED_UNITS | CAPTURED_UNITS | (SKELETON_UNITS if is_skeleton else {})
    priors = {unit: others * prior for unit, prior in known.items()}
    if default is not None:
        priors[default] = DEFAULT
    evidence = {
        unit: prior * _density(size * unit, _groups_of(unit, default))
        for unit, prior in priors.items()
    }
    low, high = SCALED_UNITS_M
    if is_body and low < 1.0 / size < high:
        scaled = float(f"{1.0 / size:.3g}")
        weight = others * SCALED / log(high / low)
        evidence[scaled] = max(evidence.get(scaled, 0.0), weight)
    unit, *following = sorted(evidence, key=lambda each: -evidence[each])
    spread = ADULTS[2]
    rivals = [
        other
        for other in following
        if evidence[other] > NEARLY_AS_LIKELY * evidence[unit]
        and abs(log(other / unit)) > spread
    ]
    return UnitEstimate(unit, priors.get(unit, 0.0) < RARE, next(iter(rivals), None))


def guess_unit(parents: Sequence[int], offsets: NDArray[np.float64]) -> float:
    """Return the probable meters per unit of a skeleton; centimeters with too few joints."""
    reach = longest_bone_path(parents, offsets)
    if len(parents) < MIN_BODY_JOINTS or not 0.0 < reach < inf:
        return CENTIMETER
    return estimate_unit(reach / ADULT_REACH_M, is_body=False).unit


def describe_guessed_unit(unit: float, rival: float | None = None) -> str:
    """Return a message that states the estimated unit of length, and which is nearly as likely.

    Both are in meters.
    """
    if rival is not None:
        return (
            f"Lengths are interpreted as {unit_name(unit)}, by the size of the body, but may be"
            f" {unit_name(rival)}; give the unit if that is wrong"
        )
    return (
        f"Lengths are interpreted as {unit_name(unit)}, by the size of the body; give the unit"
        " if that is wrong"
    )


def _groups_of(unit: float, default: float | None) -> Sequence[tuple[float, float, float]]:
    """Return whose bodies are written in a unit."""
    if unit in MODELED_UNITS or unit == default:
        return ADULTS, CHILDREN, OTHERS
    return (ADULTS,) if unit in SKELETON_UNITS else (ADULTS, CHILDREN)


def _density(size: float, groups: Sequence[tuple[float, float, float]]) -> float:
    """Return the density of the logarithm of a size in groups of bodies."""
    return NO_BODY + sum(
        weight * exp(-0.5 * ((log(size) - mean) / spread) ** 2) / (spread * sqrt(2.0 * pi))
        for weight, mean, spread in groups
    )
