"""What a few examples of one behaviour tell of all the ways in which it is done."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..archives import ArchiveLayout
from ..motion import Skeleton
from ..npz_members import integers, numbers, words
from .mixing_kernel import MixingKernel
from .motion_curves import N_ROOT_CHANNELS
from .stepwise_model import StepwiseModel, learn_stepwise
from .stepwise_process import PACKED, Hyperparameters

Array = NDArray[np.float64]

SLOWEST, FASTEST = 1e-3, 1e6
"""Hertz."""
LAYOUT = ArchiveLayout(
    "a variation model",
    2,
    {
        "names": words("joints"),
        "parents": integers("joints", minimum=-1),
        "offsets": numbers("joints", 3),
        "usual": numbers("joints", 4),
        "root": numbers("examples", "moments", N_ROOT_CHANNELS),
        "joints": numbers("examples", "moments", "joints", 3),
        "haste": numbers("examples", "moments"),
        "footing": numbers("examples", "moments", 2, finite=False),
        "carrier": numbers("moments", "joints", 4, or_empty=True),
        "warning": words(),
        "numbers": numbers(5),
        "stepwise": numbers("stacks", "triples", PACKED, or_empty=True),
    },
    holds="a damaged variation model",
    remedy="Learn it again.",
)


@dataclass(frozen=True, eq=False)
class VariationModel:
    """Examples in common time, and how their shares in a mixture may change.

    Attributes
    ----------
    skeleton : Skeleton
        That of the first example.
    frame_rate : float, hertz
    usual : shape (n_joints, 4)
        About which rotation each joint's are told.
    root : shape (n_examples, n_moments, 4)
        The ways of the root from each moment to the next (`Course`).
    joints : shape (n_examples, n_moments, n_joints, 3), radians
    haste : shape (n_examples, n_moments)
        Logarithm of how many frames a moment lasts.
    footing : shape (n_examples, n_moments, 2), seconds
        By how much feet stand (`footing_of`); NaN where the rig has no feet.
    carrier : shape (n_moments, n_joints, 4), or None
        What comes before `usual`: the centre's rotation, of joints that turn far.
    kernel : MixingKernel
    centre : int
        The example that is nearest to all others.
    loops : bool
        Whether the examples end as they begin.
    warning : str
        What seems wrong with the examples; empty if nothing does.
    stepwise : StepwiseModel or None
        For the methods that draw frame after frame.
    """

    skeleton: Skeleton
    frame_rate: float
    usual: Array
    root: Array
    joints: Array
    haste: Array
    footing: Array
    carrier: Array | None
    kernel: MixingKernel
    centre: int
    loops: bool
    warning: str = ""
    stepwise: StepwiseModel | None = None

    @property
    def n_examples(self) -> int:
        """How many clips it was learned of."""
        return len(self.root)

    @property
    def n_moments(self) -> int:
        """Length of the common time."""
        return self.root.shape[1]

    def save(self, path: Path | str) -> None:
        """Write the model to a file that `load_variation_model` reads."""
        LAYOUT.write(path, {
            "names": np.array(self.skeleton.names), "parents": np.array(self.skeleton.parents),
            "offsets": self.skeleton.offsets, "usual": self.usual, "root": self.root,
            "joints": self.joints, "haste": self.haste, "footing": self.footing,
            "carrier": np.zeros(0) if self.carrier is None else self.carrier,
            "warning": np.array(self.warning),
            "numbers": np.array([
                self.frame_rate, self.kernel.scale, self.kernel.bias, self.centre, self.loops,
            ]),
            "stepwise": _packed(self.stepwise),
        })  # fmt: skip


def load_variation_model(path: Path | str) -> VariationModel:
    """Read a model that was saved; nothing in the file is executed.

    Raises
    ------
    InvalidFileError
        There is no such file, it holds something else, or does not fit itself.
    """
    arrays = LAYOUT.read(path)
    rate, scale, bias, centre, loops = arrays["numbers"].tolist()
    n_examples, n_moments = arrays["haste"].shape
    in_range = 0 <= centre < n_examples and scale > 0.0 and 0.0 <= bias <= 1.0
    if not (n_moments and in_range and SLOWEST <= rate <= FASTEST):
        raise LAYOUT.damaged(path, "its numbers are out of range")
    names, parents = arrays["names"].tolist(), arrays["parents"].tolist()
    try:
        skeleton = Skeleton(tuple(names), tuple(parents), arrays["offsets"])
        found = _unpacked(arrays["stepwise"])
        learned = skeleton, arrays["joints"], arrays["root"], rate
        stepwise = learn_stepwise(*learned, len(found) > 1, found) if found else None
    except (ValueError, IndexError) as error:
        raise LAYOUT.damaged(path, str(error).removesuffix(".")) from None
    carrier = arrays["carrier"] if arrays["carrier"].size else None
    return VariationModel(
        skeleton, rate, arrays["usual"], arrays["root"], arrays["joints"], arrays["haste"],
        arrays["footing"], carrier, MixingKernel(scale, bias), int(centre), bool(loops),
        str(arrays["warning"]), stepwise,
    )  # fmt: skip


def _packed(stepwise: StepwiseModel | None) -> Array:
    """Return all hyper-parameters, shape (n_stacks, n_triples, 18); the rest follows."""
    stacks = stepwise.hyperparameters if stepwise else ()
    return np.array([[one.packed() for one in stack] for stack in stacks])


def _unpacked(packed: Array) -> tuple[tuple[Hyperparameters, ...], ...]:
    return tuple(tuple(Hyperparameters.unpacked(one) for one in stack) for stack in packed)
