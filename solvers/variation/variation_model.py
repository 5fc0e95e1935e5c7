"""What a few examples of one behaviour tell of all the ways in which it is done."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidFileError
from ..files import read_archive, write_archive
from ..motion import Skeleton
from .course import N_ROOT
from .mixing_kernel import MixingKernel
from .stepwise_model import StepwiseModel, learn_stepwise
from .stepwise_process import Hyperparameters

Array = NDArray[np.float64]

KIND, VERSION = "a variation model", 2


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
        write_archive(path, KIND, VERSION, {
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
    arrays = read_archive(path, KIND, VERSION)
    try:
        names = tuple(str(name) for name in arrays["names"])
        parents = tuple(int(parent) for parent in arrays["parents"])
        rate, scale, bias, centre, loops = (float(x) for x in arrays["numbers"])
        n, moments = arrays["haste"].shape
        joints = arrays["joints"].reshape(n, moments, len(names), 3)
        if not all(np.isfinite(arrays[key]).all() for key in ("joints", "root", "haste")):
            raise ValueError("Some numbers are no numbers.")
        if not (0 <= centre < n and rate > 0 and scale > 0 and 0 <= bias <= 1):
            raise ValueError("Settings out of range.")
        skeleton = Skeleton(names, parents, arrays["offsets"])
        told = arrays["carrier"]
        carrier = told.reshape(moments, len(names), 4) if told.size else None
        root, found = arrays["root"].reshape(n, moments, N_ROOT), _unpacked(arrays["stepwise"])
        stepwise = (
            learn_stepwise(skeleton, joints, root, rate, len(found) > 1, found)
            if found
            else None
        )
        return VariationModel(
            skeleton, rate, arrays["usual"].reshape(len(names), 4), root, joints,
            arrays["haste"], arrays["footing"].reshape(n, moments, 2), carrier,
            MixingKernel(scale, bias), int(centre), bool(loops), str(arrays["warning"]),
            stepwise,
        )  # fmt: skip
    except (KeyError, ValueError, TypeError, IndexError) as error:
        raise InvalidFileError(f"{path} is damaged: it does not fit itself.") from error


def _packed(stepwise: StepwiseModel | None) -> Array:
    """Return all hyper-parameters, shape (n_stacks, n_triples, 18); the rest follows."""
    stacks = stepwise.hyperparameters if stepwise else ()
    return np.array([[one.packed() for one in stack] for stack in stacks])


def _unpacked(numbers: Array) -> tuple[tuple[Hyperparameters, ...], ...]:
    if not np.isfinite(numbers).all():
        raise ValueError("Some numbers are no numbers.")
    return tuple(tuple(Hyperparameters.unpacked(one) for one in stack) for stack in numbers)
