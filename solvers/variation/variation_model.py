"""Hold what a few examples of one behavior show about its variation."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..archives import ArchiveLayout
from ..arrays import Array
from ..motion import Skeleton
from ..npz_members import integers, numbers, quaternions, words
from .curves import N_ROOT_CHANNELS
from .mixing_kernel import MixingKernel
from .published import StepwiseModel

MIN_FRAME_RATE_HZ, MAX_FRAME_RATE_HZ = 1e-3, 1e6
"""Bounds of a plausible frame rate. They guard against damaged files."""
MAX_LOG_RATE = 14.0
"""Logarithm of the most frames of an example per sample, a million. It guards against damaged
files (`test_values_within_range_are_refused_or_used`)."""
LAYOUT = ArchiveLayout(
    "a variation model",
    2,
    {
        "names": words("joints"),
        "parents": integers("joints", minimum=-1),
        "offsets": numbers("joints", 3),
        "usual": quaternions("joints"),
        "root": numbers("examples", "moments", N_ROOT_CHANNELS),
        "joints": numbers("examples", "moments", "joints", 3),
        "haste": numbers("examples", "moments", minimum=-MAX_LOG_RATE, maximum=MAX_LOG_RATE),
        "footing": numbers("examples", "moments", 2, finite=False),
        "carrier": quaternions("moments", "joints", or_empty=True),
        "warning": words(),
        "numbers": numbers(5),
        "stepwise": StepwiseModel.SAVED,
    },
    holds="a damaged variation model",
    remedy="Learn it again.",
)


@dataclass(frozen=True, eq=False)
class VariationModel:
    """Examples in common time, and the kernel of their weights in a mixture.

    Attributes
    ----------
    skeleton : Skeleton
        Of the first example.
    frame_rate : float, hertz
    reference_rotations : shape (n_joints, 4)
        Rotation of each joint that its rotation vectors are relative to.
    root : shape (n_examples, n_samples, 4)
        Displacements of the root since the sample before, and height (`MotionCurves`).
    joints : shape (n_examples, n_samples, n_joints, 3), radians
    log_warp_rates : shape (n_examples, n_samples)
        Logarithm of the time-warp rate: frames of the example per sample.
    contact_state : shape (n_examples, n_samples, 2), seconds
        Signed time to the nearest contact change (`measure_contact_state`); NaN without feet.
    moving_references : shape (n_samples, n_joints, 4), or None
        Rotations before the reference rotations: the center's, for wide-ranging joints.
    kernel : MixingKernel
    center : int
        The example nearest to all others.
    loops : bool
        Whether the examples are cyclic.
    warning : str
        Suspected errors in the examples; empty if there are none.
    stepwise : StepwiseModel or None
        For the methods that draw frame by frame.
    """

    skeleton: Skeleton
    frame_rate: float
    reference_rotations: Array
    root: Array
    joints: Array
    log_warp_rates: Array
    contact_state: Array
    moving_references: Array | None
    kernel: MixingKernel
    center: int
    loops: bool
    warning: str = ""
    stepwise: StepwiseModel | None = None

    @property
    def n_examples(self) -> int:
        """Number of clips the model was learned from."""
        return len(self.root)

    @property
    def n_samples(self) -> int:
        """Number of samples of the common time."""
        return self.root.shape[1]

    def save(self, path: Path | str) -> None:
        """Write the model to a file that `load_variation_model` reads."""
        moving = self.moving_references
        LAYOUT.write(path, {
            "names": np.array(self.skeleton.names), "parents": np.array(self.skeleton.parents),
            "offsets": self.skeleton.offsets,
            "usual": self.reference_rotations, "root": self.root,
            "joints": self.joints, "haste": self.log_warp_rates, "footing": self.contact_state,
            "carrier": np.zeros(0) if moving is None else moving,
            "warning": np.array(self.warning),
            "numbers": np.array([
                self.frame_rate, self.kernel.scale, self.kernel.bias, self.center, self.loops,
            ]),
            "stepwise": np.zeros(0) if self.stepwise is None else self.stepwise.pack(),
        })  # fmt: skip


def load_variation_model(path: Path | str) -> VariationModel:
    """Read a saved model; nothing in the file is executed.

    Raises
    ------
    InvalidFileError
        There is no such file, it holds something else, or its arrays are inconsistent.
    """
    arrays = LAYOUT.read(path)
    frame_rate, scale, bias, center, loops = arrays["numbers"].tolist()
    n_examples, n_samples = arrays["haste"].shape
    in_range = 0 <= center < n_examples and scale > 0.0 and 0.0 <= bias <= 1.0
    if not (n_samples and in_range and MIN_FRAME_RATE_HZ <= frame_rate <= MAX_FRAME_RATE_HZ):
        raise LAYOUT.damaged(path, "its numbers are out of range")
    names, parents = arrays["names"].tolist(), arrays["parents"].tolist()
    try:
        skeleton = Skeleton(tuple(names), tuple(parents), arrays["offsets"])
        stepwise = StepwiseModel.restore(
            arrays["stepwise"], skeleton, arrays["joints"], arrays["root"], frame_rate
        )
    except (ValueError, IndexError) as error:
        raise LAYOUT.damaged(path, str(error).removesuffix(".")) from None
    moving_references = arrays["carrier"] if arrays["carrier"].size else None
    return VariationModel(
        skeleton, frame_rate, arrays["usual"], arrays["root"], arrays["joints"],
        arrays["haste"], arrays["footing"], moving_references, MixingKernel(scale, bias),
        int(center), bool(loops), str(arrays["warning"]), stepwise,
    )  # fmt: skip
