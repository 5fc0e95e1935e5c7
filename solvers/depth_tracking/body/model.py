"""The body model: 17 rigid segments with capsules, defined by lengths and radii."""

from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from ...archives import ArchiveLayout
from ...arrays import Array
from ...errors import InvalidFileError, InvalidMotionError
from ...motion.humanoid import ADULT_STATURE_M, SIDES
from ...npz_members import numbers, words
from .tables import (
    CAPSULE_ENDS,
    CAPSULES,
    DEFAULT_LENGTHS_M,
    DEFAULT_RADII_M,
    LENGTHS,
    OFFSETS,
)

MIN_LENGTH_M, MAX_LENGTH_M = 1e-3, 100.0
"""Bounds of the length or radius of a body part. They guard against damaged files
(`test_body_of_no_size_is_refused`)."""
LAYOUT = ArchiveLayout(
    "body model",
    1,
    {
        "lengths": numbers(len(LENGTHS), minimum=MIN_LENGTH_M, maximum=MAX_LENGTH_M),
        "radii": numbers(len(CAPSULES), 2, minimum=MIN_LENGTH_M, maximum=MAX_LENGTH_M),
        "length_names": words("lengths"),
        "capsule_names": words("capsules"),
    },
    holds="a damaged body",
    remedy="Calibrate it again.",
)


@dataclass(frozen=True, eq=False)
class BodyModel:
    """The full-body geometry of [WZC12]_, section 2: segments of one or two capsules.

    Capsules of trunk and head are elliptic. Hands have no rotation of their own. Feet flex at
    the ankles, unlike in the paper (`TrackerSettings.ankle_weight`). In the zero pose the body
    stands upright, faces the camera, and its arms hang down. All segment frames then equal the
    camera frame: x to the body's left, y down, z to its back.

    Attributes
    ----------
    lengths : shape (20,), meters
        In the order of `LENGTHS`.
    radii : shape (19, 2), meters
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
            if not ((values >= MIN_LENGTH_M) & (values <= MAX_LENGTH_M)).all():
                raise InvalidMotionError(
                    f"The {name} of a body must all be from {MIN_LENGTH_M:g} to"
                    f" {MAX_LENGTH_M:g} m."
                )
            values.setflags(write=False)
            object.__setattr__(self, name, values)

    def __reduce__(self) -> tuple[type["BodyModel"], tuple[Array, Array]]:
        """Pickle only lengths and radii, without cached properties."""
        return BodyModel, (self.lengths, self.radii)

    @cached_property
    def offsets(self) -> Array:
        """Each of the `JOINTS` in the frame of its parent segment, shape (21, 3), meters."""
        offsets: Array = OFFSETS @ self.lengths
        return offsets

    @cached_property
    def capsule_ends(self) -> Array:
        """Both ends of each capsule's axis in its segment's frame, shape (19, 2, 3), meters."""
        ends: Array = CAPSULE_ENDS @ self.lengths
        return ends

    def length(self, name: str) -> float:
        """Return one of the `LENGTHS`, meters."""
        return float(self.lengths[LENGTHS.index(name)])

    def with_lengths(self, **lengths: float) -> "BodyModel":
        """Return the body with some of its `LENGTHS` replaced, meters."""
        changed = self.lengths.copy()
        for name, length in lengths.items():
            changed[LENGTHS.index(name)] = length
        return replace(self, lengths=changed)

    def scaled(self, factor: float) -> "BodyModel":
        """Return the body scaled by this factor."""
        return BodyModel(self.lengths * factor, self.radii * factor)

    def symmetric(self) -> "BodyModel":
        """Return the body with left and right averaged."""
        return BodyModel(
            0.5 * (self.lengths + self.lengths[_mirrored_indices(LENGTHS)]),
            0.5 * (self.radii + self.radii[_mirrored_indices(CAPSULES)]),
        )

    def save(self, path: Path | str) -> None:
        """Write an archive that `load_body_model` reads."""
        arrays = {"lengths": self.lengths, "radii": self.radii}
        names = {"length_names": np.array(LENGTHS), "capsule_names": np.array(CAPSULES)}
        LAYOUT.write(path, arrays | names)


def default_body(stature: float = ADULT_STATURE_M) -> BodyModel:
    """Return an adult of default proportions, `stature` meters tall.

    Raises
    ------
    InvalidMotionError
        The stature is not between 0.5 and 2.5 m.
    """
    if not 0.5 <= stature <= 2.5:
        raise InvalidMotionError(
            f"The stature {stature:g} m is invalid. Give between 0.5 and 2.5 m."
        )
    return BodyModel(DEFAULT_LENGTHS_M, DEFAULT_RADII_M).scaled(stature / ADULT_STATURE_M)


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
        raise InvalidFileError(f"{path} holds a body with other parts. Calibrate it again.")
    try:
        return BodyModel(arrays["lengths"], arrays["radii"])
    except InvalidMotionError as error:
        raise LAYOUT.damaged(path, str(error).removesuffix(".")) from None


def _mirrored_indices(names: tuple[str, ...]) -> list[int]:
    opposite = dict(zip(SIDES, reversed(SIDES), strict=True))
    order = []
    for name in names:
        side = next((side for side in SIDES if name.startswith(side)), None)
        mirrored = name if side is None else opposite[side] + name.removeprefix(side)
        order.append(names.index(mirrored))
    return order
