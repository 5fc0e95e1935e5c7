"""Results do not depend on where arrays lie in memory.

NumPy 1.26, which Blender 4.5 ships, computes elementary functions of a view with gaps, such as
a column, in another way if the result happens to lie right behind it in memory. The last bit
then differs from run to run.
"""

from collections.abc import Callable

import numpy as np
import pytest

from solvers.denoising import denoise, learn_filter_bases, measure_quality
from solvers.feet import plant_feet
from solvers.motion import HumanoidMap, Motion, find_humanoid_map
from solvers.retargeting import retarget
from solvers.samples import GaitSettings, corrupt, walking_gait

ELEMENTARY = (
    "exp", "exp2", "expm1", "log", "log2", "log10", "log1p", "sin", "cos", "tan", "arcsin",
    "arccos", "arctan", "arctan2", "sinh", "cosh", "tanh", "cbrt", "power",
)  # fmt: skip


def has_gaps(*arguments: object) -> bool:
    """Whether neighbors of an array are not adjacent in memory along its innermost axis."""
    arrays = [each for each in arguments if isinstance(each, np.ndarray) and each.size > 1]
    if not arrays:
        return False
    arrays = list(np.broadcast_arrays(*arrays))
    axes = [axis for axis, size in enumerate(arrays[0].shape) if size > 1]
    steps = [[abs(each.strides[axis]) for each in arrays] for axis in axes]
    innermost = min(reversed(steps), key=sum)
    return any(
        step not in (0, each.itemsize) for step, each in zip(innermost, arrays, strict=True)
    )


@pytest.fixture
def calls_with_gaps(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The calls of elementary functions by this project whose arguments have gaps."""
    found: list[str] = []

    def watch(name: str, function: Callable[..., object]) -> None:
        def watched(*arguments: object, **options: object) -> object:
            if has_gaps(*arguments):
                found.append(name)
            return function(*arguments, **options)

        monkeypatch.setattr(np, name, watched)

    for name in ELEMENTARY:
        watch(name, getattr(np, name))
    return found


@pytest.fixture(scope="module")
def walk() -> Motion:
    return walking_gait(GaitSettings(duration=3.0, frame_rate=60.0))


def roles(motion: Motion) -> HumanoidMap:
    return find_humanoid_map(motion.skeleton)


def test_gaps_are_found():
    frames = np.ones((10, 4))

    assert has_gaps(frames[:, 3])
    assert has_gaps(frames[:, 0].copy(), frames[:, :1].T)
    assert not has_gaps(frames)
    assert not has_gaps(frames, frames[0])
    assert not has_gaps(frames[:, :3])
    assert not has_gaps(frames[:, 3].copy(), 2.0)


@pytest.mark.parametrize(
    "solve",
    [
        lambda walk: denoise(corrupt(walk)),
        lambda walk: denoise(corrupt(walk), learn_filter_bases([walk])),
        lambda walk: measure_quality(corrupt(walk)),
        lambda walk: plant_feet(corrupt(walk)),
        lambda walk: retarget(walk, roles(walk), walk.skeleton, roles(walk)),
    ],
    ids=["clean", "examples", "check", "plant feet", "retarget"],
)
def test_elementary_functions_get_arrays_without_gaps(solve, walk, calls_with_gaps):
    solve(walk)

    assert calls_with_gaps == []
