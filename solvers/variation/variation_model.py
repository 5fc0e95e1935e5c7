"""What a few examples of one behaviour tell of all the ways in which it is done."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidFileError, InvalidMotionError
from ..files import read_archive, write_archive
from ..motion import Motion, Skeleton, resample
from ..motion.rotations import mean_rotation
from ..progress import Progress, unwatched
from .align_examples import Alignment, align_examples, body_positions
from .course import N_ROOT, Course, course_of, headings, without_heading
from .mixing_kernel import MixingKernel, learn_mixing_kernel

Array = NDArray[np.float64]

KIND, VERSION = "a variation model", 1
ODD = 2.0
"""An example that is so many times farther from the others than usual is of another kind."""
LOOP_GAP = 0.06
"""Metres by which joints may be beside where they began, for a clip to loop."""
MEMORY = 600_000_000
"""Numbers in all curves together; more would not fit."""


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
    kernel : MixingKernel
    centre : int
        The example that is nearest to all others.
    loops : bool
        Whether the examples end as they begin.
    warning : str
        What seems wrong with the examples; empty if nothing does.
    """

    skeleton: Skeleton
    frame_rate: float
    usual: Array
    root: Array
    joints: Array
    haste: Array
    kernel: MixingKernel
    centre: int
    loops: bool
    warning: str = ""

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
            "joints": self.joints, "haste": self.haste, "warning": np.array(self.warning),
            "numbers": np.array([
                self.frame_rate, self.kernel.scale, self.kernel.bias, self.centre, self.loops,
            ]),
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
        return VariationModel(
            Skeleton(names, parents, arrays["offsets"]), rate,
            arrays["usual"].reshape(len(names), 4), arrays["root"].reshape(n, moments, N_ROOT),
            joints, arrays["haste"], MixingKernel(scale, bias), int(centre), bool(loops),
            str(arrays["warning"]),
        )  # fmt: skip
    except (KeyError, ValueError, TypeError) as error:
        raise InvalidFileError(f"{path} is damaged: it does not fit itself.") from error


def learn_variation_model(
    motions: Sequence[Motion], *, progress: Progress = unwatched
) -> VariationModel:
    """Learn from examples of one behaviour how it varies.

    The examples are lined up in time; what varies are their curves in common time and how fast
    that passes.

    Parameters
    ----------
    motions : Motion, one or more
        Of one rig, without gaps; other bone lengths and frame rates are brought to those of
        the first. One alone tells nothing of how it varies: see `borrow_variation`.

    Raises
    ------
    InvalidMotionError
        There is none, rigs differ, a clip has gaps or less than two frames, or no body.
    """
    motions = _of_one_rig(list(motions))
    turns = [headings(motion) for motion in motions]
    progress(0.1, "Lining up")
    alignment = align_examples(motions, turns)
    progress(0.6, "Learning")
    usual = mean_rotation(
        np.concatenate([
            without_heading(motion, turn) for motion, turn in zip(motions, turns, strict=True)
        ])
    )  # fmt: skip
    courses = [
        _in_common_time(course_of(motion, turn, usual), times)
        for motion, turn, times in zip(motions, turns, alignment.times, strict=True)
    ]
    root = np.stack([course.root for course in courses])
    joints = np.stack([course.joints for course in courses])
    joints = _same_turns(joints, alignment.centre)
    rate = motions[0].frame_rate
    haste = (
        np.log(np.gradient(alignment.times, axis=1)) if root.shape[1] > 1 else 0 * root[..., 0]
    )
    centre = motions[alignment.centre]
    kernel = _kernel(joints, root, haste, root.shape[1] / rate)
    progress(1.0)
    return VariationModel(
        motions[0].skeleton, rate, usual, root, joints, haste, kernel, alignment.centre,
        _loops(centre, turns[alignment.centre]), _odd_one(alignment),
    )  # fmt: skip


def _of_one_rig(motions: list[Motion]) -> list[Motion]:
    """Bring examples to the rate and the size of the first, or say why that cannot be."""
    if not motions:
        raise InvalidMotionError("There is no example to vary.")
    first = motions[0]
    for place, motion in enumerate(motions):
        if motion.skeleton.names != first.skeleton.names or (
            motion.skeleton.parents != first.skeleton.parents
        ):
            raise InvalidMotionError(
                f"Example {place + 1} is of another rig than the first; retarget it first."
            )
        if motion.n_frames < 2:
            raise InvalidMotionError(f"Example {place + 1} has one frame; it shows no motion.")
        observed = (
            np.isfinite(motion.rotations).all() and np.isfinite(motion.root_positions).all()
        )
        if not observed:
            raise InvalidMotionError(f"Example {place + 1} has gaps; clean it first.")
    if (
        sum(motion.n_frames for motion in motions) * len(motions) * first.skeleton.n_joints
        > MEMORY
    ):
        raise InvalidMotionError("The examples are too long to vary; cut out what is to vary.")
    return [_as_first(motion, first) for motion in motions]


def _as_first(motion: Motion, first: Motion) -> Motion:
    if motion.frame_rate != first.frame_rate:
        motion = resample(motion, first.frame_rate)
    sizes = [np.linalg.norm(one.skeleton.offsets, axis=-1).sum() for one in (first, motion)]
    places = motion.root_positions * (sizes[0] / max(sizes[1], 1e-9))
    return replace(motion, skeleton=first.skeleton, root_positions=places)


def _in_common_time(course: Course, times: Array) -> Course:
    """Return a course at its frames `times`; ways are those between them."""
    before = np.minimum(times.astype(int), max(len(course.root) - 2, 0))
    part = (times - before)[:, None]
    after = np.minimum(before + 1, len(course.root) - 1)
    joints = course.joints[before] + part[..., None] * (
        course.joints[after] - course.joints[before]
    )
    ways = np.cumsum(course.root[:, :3], axis=0)
    made = ways[before] + part * (ways[after] - ways[before])
    height = course.root[:, 3:]
    heights = height[before] + part * (height[after] - height[before])
    return Course(np.column_stack([np.diff(made, axis=0, prepend=made[:1]), heights]), joints)


def _same_turns(joints: Array, centre: int) -> Array:
    """Tell rotation vectors that mean the same by the one nearer to the centre's."""
    length = np.linalg.norm(joints, axis=-1, keepdims=True)
    other = joints * (1.0 - 2.0 * np.pi / np.where(length > 0.0, length, np.inf))
    stay = np.linalg.norm(joints - joints[centre], axis=-1, keepdims=True).mean(axis=1)
    turn = np.linalg.norm(other - joints[centre], axis=-1, keepdims=True).mean(axis=1)
    return np.where((turn < stay)[:, None], other, joints)


def _kernel(joints: Array, root: Array, haste: Array, seconds: float) -> MixingKernel:
    flat = joints.reshape(*joints.shape[:2], -1)
    told = np.concatenate([flat, root[..., 3:]], axis=-1)
    return learn_mixing_kernel(told - told.mean(axis=0), seconds)


def _loops(motion: Motion, turns: Array) -> bool:
    body = body_positions(motion, turns)
    gap = np.linalg.norm(body[-1] - body[0], axis=-1).mean()
    step = np.linalg.norm(np.diff(body, axis=0), axis=-1).mean()
    return bool(gap < LOOP_GAP + step)


def _odd_one(alignment: Alignment) -> str:
    """Return a sentence about the example that is not like the others; empty without one."""
    n = len(alignment.distances)
    if n < 3:
        return ""
    apart = alignment.distances.sum(axis=0) / (n - 1)
    worst = int(apart.argmax())
    if apart[worst] <= ODD * np.median(apart):
        return ""
    return (
        f"Example {worst + 1} is {apart[worst] / np.median(apart):.1f} times as far from the"
        " others as they are from each other: it seems to be of another behaviour."
    )
