"""A body of 17 rigid segments in capsules: how long and how thick its parts are."""

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...archives import ArchiveLayout
from ...errors import InvalidFileError, InvalidMotionError
from ...npz_members import numbers, words
from .tables import (
    CAPSULE_ENDS,
    CAPSULES,
    DEFAULT_LENGTHS_M,
    DEFAULT_RADII_M,
    DEFAULT_STATURE_M,
    LENGTHS,
    OFFSETS,
    SIDES,
)

Array = NDArray[np.float64]

LONGEST = 100.0
"""Metres, of any part of a body."""
LAYOUT = ArchiveLayout(
    "body model",
    1,
    {
        "lengths": numbers(len(LENGTHS), minimum=0.0, maximum=LONGEST),
        "radii": numbers(len(CAPSULES), 2, minimum=0.0, maximum=LONGEST),
        "length_names": words("lengths"),
        "capsule_names": words("capsules"),
    },
    holds="a damaged body",
    remedy="Calibrate it again.",
)


@dataclass(frozen=True, eq=False)
class BodyModel:
    """The full-body geometry of [WZC12]_, section 2: segments, each a cylinder or two.

    Cylinders have round ends (capsules), those of the trunk and the head are elliptic; hands
    do not turn by themselves. Feet bend at the ankles, which the paper's do not
    (`TrackerSettings.ankle_weight`). In the pose of zeros the body stands upright before the
    camera and looks at it, arms hanging, and the frames of all segments are the camera's: x to
    the body's left, y down, z to its back.

    Attributes
    ----------
    lengths : shape (20,), metres
        In the order of `LENGTHS`.
    radii : shape (19, 2), metres
        Of the `CAPSULES`, across (along x) and from front to back; equal where round.

    References
    ----------
    .. [WZC12] Wei, Zhang, Chai (2012). Accurate realtime full-body motion capture using a
       single depth camera. ACM Transactions on Graphics 31(6).
    """

    lengths: Array
    radii: Array

    def __post_init__(self) -> None:
        for name, shape in (("lengths", (len(LENGTHS),)), ("radii", (len(CAPSULES), 2))):
            values = np.array(getattr(self, name), dtype=np.float64)
            if values.shape != shape:
                raise InvalidMotionError(
                    f"The {name} of a body have shape {shape}, not {values.shape}."
                )
            if not (np.isfinite(values).all() and (values > 0.0).all()):
                raise InvalidMotionError(f"The {name} of a body must all be above 0.")
            values.setflags(write=False)
            object.__setattr__(self, name, values)

    def __reduce__(self) -> tuple[type["BodyModel"], tuple[Array, Array]]:
        """Pickle lengths and radii alone, not what is derived of them."""
        return BodyModel, (self.lengths, self.radii)

    @cached_property
    def offsets(self) -> Array:
        """Each of the `JOINTS` in the frame of the segment above, shape (21, 3), metres."""
        offsets: Array = OFFSETS @ self.lengths
        return offsets

    @cached_property
    def capsule_ends(self) -> Array:
        """Both ends of each capsule's axis in its segment's frame, shape (19, 2, 3), metres."""
        ends: Array = CAPSULE_ENDS @ self.lengths
        return ends

    def length(self, name: str) -> float:
        """Return one of the `LENGTHS`, metres."""
        return float(self.lengths[LENGTHS.index(name)])

    def with_lengths(self, **lengths: float) -> "BodyModel":
        """Return the body with these of its `LENGTHS` changed, metres."""
        changed = self.lengths.copy()
        for name, length in lengths.items():
            changed[LENGTHS.index(name)] = length
        return replace(self, lengths=changed)

    def scaled(self, factor: float) -> "BodyModel":
        """Return the body made larger by this factor."""
        return BodyModel(self.lengths * factor, self.radii * factor)

    def symmetric(self) -> "BodyModel":
        """Return the body whose left and right are both the mean of its left and right."""
        return BodyModel(
            0.5 * (self.lengths + self.lengths[_other_side(LENGTHS)]),
            0.5 * (self.radii + self.radii[_other_side(CAPSULES)]),
        )

    def save(self, path: Path | str) -> None:
        """Write an archive that `load_body_model` reads."""
        arrays = {"lengths": self.lengths, "radii": self.radii}
        names = {"length_names": np.array(LENGTHS), "capsule_names": np.array(CAPSULES)}
        LAYOUT.write(path, arrays | names)


def default_body(stature: float = DEFAULT_STATURE_M) -> BodyModel:
    """Return an adult of usual proportions, `stature` metres tall."""
    if not 0.5 <= stature <= 2.5:
        raise InvalidMotionError(f"Nobody is {stature:g} m tall; give between 0.5 and 2.5 m.")
    return BodyModel(DEFAULT_LENGTHS_M, DEFAULT_RADII_M).scaled(stature / DEFAULT_STATURE_M)


def load_body_model(path: Path | str) -> BodyModel:
    """Read what `BodyModel.save` wrote.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or holds something else.
    """
    arrays = LAYOUT.read(path)
    expected = {"length_names": LENGTHS, "capsule_names": CAPSULES}
    if any(tuple(arrays[name].tolist()) != names for name, names in expected.items()):
        raise InvalidFileError(f"{path} holds a body of other parts. Calibrate it again.")
    try:
        return BodyModel(arrays["lengths"], arrays["radii"])
    except InvalidMotionError as error:
        raise LAYOUT.damaged(path, str(error).removesuffix(".")) from None


def _other_side(names: tuple[str, ...]) -> list[int]:
    exchanged = dict(zip(SIDES, reversed(SIDES), strict=True))
    order = []
    for name in names:
        side = next((side for side in SIDES if name.startswith(side)), None)
        other = name if side is None else exchanged[side] + name.removeprefix(side)
        order.append(names.index(other))
    return order
