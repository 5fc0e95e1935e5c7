"""Estimate the unit of length of a file by the likelihood of the body's size."""

from collections.abc import Mapping, Sequence
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
"""Prior probability, a ratio, of the units of programs that model bodies of any size. Measured:
of 18 makers of BVH files in docs/benchmarks/importing.md, 11 write centimeters."""
CAPTURED_UNITS = {0.0254: 0.03, 0.3048: 0.02, 0.1: 0.01}
"""The same, a ratio, of units in which only recordings of people are written. Chosen by hand:
x0.5 for inches makes children of adults of 2 m (`test_the_unit_of_an_adult_is_recognized`)."""
UNITS_OF_JOINTS = MODELED_UNITS | CAPTURED_UNITS
"""The same, a ratio, for tables of joints. By definition all units that programs model and
record in."""
UNITS_OF_SKELETONS = UNITS_OF_JOINTS | {ACCLAIM_UNIT: 0.08}
"""The same, a ratio, for skeletons of CMU's library. Chosen by hand: BVH files made from
Acclaim's are common, and only adults are in them."""
UNITS_OF_MARKERS = {MILLIMETER: 0.7, 1.0: 0.2, CENTIMETER: 0.08, 0.0254: 0.002, 0.3048: 0.002}
"""The same, a ratio, for markers. Measured: of 24 TRC files in docs/benchmarks/importing.md
that state their unit, 21 have millimeters and 3 meters; x2 for inches makes adults of children
of 0.8 m in centimeters (`test_who_squats_keeps_the_unit`)."""
SCALED = 0.03
"""The same, a ratio, of a unit of its own, by which a body is scaled to an adult's size. Chosen
by hand: x0.5 fails `test_units_of_no_program_give_an_adult_and_are_reported`, x2 makes adults
of giants of 4.2 m."""
SCALED_UNITS_M = (MILLIMETER, 2.0)
"""Range of such a unit, meters. By definition from the smallest usual unit to twice the
largest: a person in a unit of 2 m has a height of 0.9."""
DEFAULT = 0.6
"""Prior probability, a ratio, of the default unit of a format. Chosen by hand: 4.4 m, 2.5 times
an adult's height, remain, and 5.7 m, an adult's in feet, do not."""
ADULTS, CHILDREN = (0.9, 0.0, 0.1), (0.05, -0.43, 0.25)
"""Fraction of bodies, and mean and standard deviation of the logarithm of their size relative
to an adult's, as ratios. Measured: lengths of nine makers' adults differ by 10 %, and children
have 0.4 to 1.0 of them."""
OTHERS, OTHERS_SPREAD = 0.08, 0.4
"""Fraction of animals, dolls and giants, and the mean absolute logarithm of their size relative
to an adult's, as ratios. Chosen by hand: their density falls with |log size| as slowly as
Laplace's, so that of units in which nothing has a usual size the nearest one is the likeliest.
x0.5 for the spread makes adults of giants of 3.8 m, x2 dwarfs of rigs in units of 4 cm
(`test_children_and_giants_stay_what_they_are`,
`test_rigs_of_another_scale_get_the_size_of_an_adult`)."""
RARE = 0.05
"""Prior, a ratio, below which a unit is reported. Chosen by hand: inches, 0.03, and rarer."""
NEARLY_AS_LIKELY = 0.25
"""Probability relative to the estimate's from which another unit is reported, a ratio.
Measured: 4 of 5 such estimates are right. It decides a sentence of the report only."""


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
    units: Mapping[float, float] = UNITS_OF_SKELETONS,
    *,
    default: float | None = None,
    is_body: bool = True,
) -> UnitEstimate:
    """Return the most probable unit of a body of a size.

    Each usual unit has a prior probability and makes the body a size that adults, children or
    other characters have more or less often; a unit of its own would make it an adult.

    Parameters
    ----------
    size : float
        Size of the body in units of the file, relative to that of an adult in meters.
    units : mapping of float to float
        Prior probability of each usual unit, in meters.
    default : float, meters, or None
        Default unit of the format.
    is_body : bool
        Whether the joints are known to be those of a person; only then the unit may be any.
    """
    others = 1.0 if default is None else 1.0 - DEFAULT
    priors = {unit: others * prior for unit, prior in units.items()}
    if default is not None:
        priors[default] = DEFAULT
    evidence = {
        unit: prior * _density(log(size * unit), unit, default)
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
    """Return the probable meters per unit of offsets (n_joints, 3); 0.01 with few joints."""
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


def _density(log_size: float, unit: float, default: float | None) -> float:
    """Return the density of the logarithm of the size of the bodies written in a unit."""
    groups = (ADULTS,) if unit == ACCLAIM_UNIT else (ADULTS, CHILDREN)
    of_people = sum(
        weight * exp(-0.5 * ((log_size - mean) / spread) ** 2) / (spread * sqrt(2.0 * pi))
        for weight, mean, spread in groups
    )
    if unit not in MODELED_UNITS and unit != default:
        return of_people
    return of_people + OTHERS * exp(-abs(log_size) / OTHERS_SPREAD) / (2.0 * OTHERS_SPREAD)
