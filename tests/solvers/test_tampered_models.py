"""Numbers in a learned file that are valid one by one: it is refused, or gives a motion."""

import numpy as np
import pytest
from learned_files import LEARNED, npz

from solvers.errors import MocapAssistError
from solvers.variation import synthesize

USES = {
    "keys": lambda keys: [keys.dense()],
    "variation": lambda model: synthesize(model, 2),
}
CHANGES = {
    "zeros": np.zeros_like,
    "tiny": lambda array: array * 1e-300,
    "first tiny": lambda array: with_first(array, 1e-310),
    "first huge": lambda array: with_first(array, 9e15),
    "all huge": lambda array: np.full_like(array, 1e15),
    "shuffled": lambda array: np.random.default_rng(1).permuted(array),
}
NUMBERS = [
    (kind, name)
    for kind in USES
    for name, array in LEARNED[kind].arrays.items()
    if array.dtype.kind == "f" and array.size
]


def with_first(array: np.ndarray, value: float) -> np.ndarray:
    changed = array.copy()
    changed.flat[0] = value
    return changed


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize(("kind", "name"), NUMBERS)
def test_values_within_range_are_refused_or_used(tmp_path, kind, name, change):
    arrays = LEARNED[kind].arrays
    (tmp_path / "odd.npz").write_bytes(npz(arrays | {name: CHANGES[change](arrays[name])}))

    try:
        motions = USES[kind](LEARNED[kind].load(tmp_path / "odd.npz"))
    except MocapAssistError as error:
        assert str(error).endswith(".")
        return

    for motion in motions:
        assert motion.observed.all() and np.isfinite(motion.root_positions).all()


def test_body_of_no_size_is_refused(tmp_path):
    arrays = LEARNED["body"].arrays
    for name in ("lengths", "radii"):
        odd = arrays | {name: with_first(arrays[name], 1e-9)}
        (tmp_path / "odd.npz").write_bytes(npz(odd))

        with pytest.raises(MocapAssistError, match=rf"odd\.npz .* \({name} has numbers out of"):
            LEARNED["body"].load(tmp_path / "odd.npz")


def test_few_keys_allocate_no_memory(tmp_path):
    arrays = LEARNED["keys"].arrays
    long = arrays | {
        "length": np.array([9_999_999, 30.0, 0.0]),
        "names": np.array([f"joint {n}" for n in range(100)]),
        "parents": np.arange(-1, 99),
        "offsets": np.ones((100, 3)),
        "orders": np.full(100, ""),
        "axes": np.tile([1.0, 0.0, 0.0, 0.0], (100, 1)),
        "counts": np.array([0] * 100 + [len(arrays["places"])]),
        "frames": arrays["frames"][-len(arrays["places"]):],
        "rotations": np.zeros(0),
        "turning": np.zeros(0),
    }  # fmt: skip
    (tmp_path / "long.npz").write_bytes(npz(long))

    with pytest.raises(MocapAssistError, match="The motion length is invalid"):
        LEARNED["keys"].load(tmp_path / "long.npz")
