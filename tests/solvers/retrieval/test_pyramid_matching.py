"""Temporal codes and pyramids equal the equations of [ZH14]."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.sparse import csr_array, vstack

from solvers.recordings import read_acclaim
from solvers.retrieval.postures.clip_postures import ClipPostures, clip_postures
from solvers.retrieval.published.dictionary import (
    DictionarySettings,
    PostureDictionary,
    learn_dictionary,
)
from solvers.retrieval.published.pyramid_matching import (
    PyramidSettings,
    pyramid_descriptor,
    pyramid_kernel,
)
from solvers.retrieval.published.sparse_codes import SparseCodes
from solvers.retrieval.published.temporal_codes import temporal_codes

N_ATOMS = 7


@pytest.fixture
def dictionary(rng):
    atoms = rng.normal(size=(N_ATOMS, 60))
    return PostureDictionary(
        atoms / np.linalg.norm(atoms, axis=1, keepdims=True), np.zeros(60), 3
    )


def clip_of(rng, n_frames):
    return ClipPostures(rng.normal(size=(n_frames, 20, 3)), np.zeros((n_frames, 4)), 30.0)


def dense_codes(postures, dictionary):
    codes = dictionary.codes(postures)
    x = np.zeros((postures.n_frames, N_ATOMS))
    np.put_along_axis(x, codes.atoms, codes.weights, axis=1)
    return x


def dense_slices(x, gap):
    """Equations 3.6 to 3.9, with frames counted from 1."""
    t = len(x)
    k = max(k for k in range(t) if 1 + k * gap < t)
    slices = []
    for i in (1 + n * gap for n in range(k + 1)):
        j = i + gap if i + gap < t else t
        slices.append(np.outer(x[i - 1], x[j - 1]))
    return np.array(slices)


def cubes(slices, n_levels):
    """Equation 3.10, for each level, segment and block; blocks of nearly the same size."""
    q = slices.shape[1]
    for level in range(n_levels):
        group = np.arange(q) * (level + 1) // q
        segment = np.arange(len(slices)) * 2**level // len(slices)
        for s in range(2**level):
            for a in range(level + 1):
                for b in range(level + 1):
                    cut = slices[segment == s][:, group == a][:, :, group == b]
                    yield level, np.abs(cut).max(axis=0, initial=0.0)


def dense_kernel(a, b, n_levels, normalize):
    """Equation 3.11 with histogram intersection."""
    total = 0.0
    for (level, one), (_, other) in zip(cubes(a, n_levels), cubes(b, n_levels), strict=True):
        if normalize:
            one, other = (each / max(each.sum(), 1e-12) for each in (one, other))
        total += np.minimum(one, other).sum() / 2**level
    return total


@pytest.mark.parametrize("normalize", [False, True])
@pytest.mark.parametrize("n_levels", [1, 2, 3, 4])
@pytest.mark.parametrize("gap", [1, 2, 7])
def test_kernel_equals_the_equations(rng, dictionary, gap, n_levels, normalize):
    settings = PyramidSettings(gap=gap / 30.0, n_levels=n_levels, normalize_cubes=normalize)
    clips = [clip_of(rng, n_frames) for n_frames in (40, 23, 2)]
    rows = [pyramid_descriptor(clip, dictionary, settings) for clip in clips]
    slices = [dense_slices(dense_codes(clip, dictionary), gap) for clip in clips]

    kernel = pyramid_kernel(vstack(rows), vstack(rows))

    expected = [[dense_kernel(a, b, n_levels, normalize) for b in slices] for a in slices]
    assert_allclose(kernel, expected, atol=1e-12)


def test_blocks_have_no_effect_unless_cubes_are_normalized(rng, dictionary):
    """Maxima and intersections are elementwise, so the default differs from [ZH14]."""
    a, b = (dense_slices(dense_codes(clip_of(rng, 40), dictionary), 2) for _ in range(2))

    def cubes_of_level(slices, level):
        segment = np.arange(len(slices)) * 2**level // len(slices)
        return [np.abs(slices[segment == s]).max(axis=0) for s in range(2**level)]

    unsplit = sum(
        np.minimum(one, other).sum() / 2**level
        for level in range(3)
        for one, other in zip(cubes_of_level(a, level), cubes_of_level(b, level), strict=True)
    )
    assert_allclose(dense_kernel(a, b, 3, False), unsplit)
    assert not np.isclose(dense_kernel(a, b, 3, True), unsplit)


def test_slices_of_the_toy_example():
    """Figure 3.3 of [ZH14]: 4 atoms, 7 frames and a gap of 2 give a 4 x 4 x 3 volume."""
    codes = SparseCodes(np.tile(np.arange(4), (7, 1)), np.arange(28.0).reshape(7, 4))

    found = temporal_codes(codes, 2)

    assert found.entries()[2].shape == (3, 4, 4)
    assert_allclose(found.earlier.weights[:, 0], [0, 8, 16])
    assert_allclose(found.later.weights[:, 0], [8, 16, 24])


@pytest.mark.parametrize("n_frames", [1, 2, 3])
def test_very_short_clips_are_accepted(rng, dictionary, n_frames):
    row = pyramid_descriptor(clip_of(rng, n_frames), dictionary)

    assert row.shape == (1, 7 * N_ATOMS**2)
    assert 0 < row.nnz <= 3 * 9
    assert (row.data > 0.0).all()


@given(st.integers(0, 10**6))
def test_sparse_kernel_equals_the_dense_one(seed):
    rng = np.random.default_rng(seed)
    a, b = (np.maximum(rng.normal(size=(n, 30)), 0.0) for n in (4, 6))

    kernel = pyramid_kernel(csr_array(a), csr_array(b))

    assert_allclose(kernel, np.minimum(a[:, None], b[None]).sum(axis=2), atol=1e-12)
    assert_allclose(pyramid_kernel(csr_array(b), csr_array(a)), kernel.T)


def test_each_normalized_cube_has_sum_one(rng, dictionary):
    settings = PyramidSettings(gap=1 / 30.0, normalize_cubes=True)
    row = pyramid_descriptor(clip_of(rng, 200), dictionary, settings)

    # Level l has 2^l (l + 1)^2 cubes, of weight 1 / 2^l, and 200 frames leave none empty.
    assert_allclose(row.sum(), 1 + 4 + 9)


def test_other_actors_hops_are_nearer_than_squats(recordings):
    folder = recordings / "mocap" / "hdm05"
    first = {"hopBothLegs1hops": ("001", "013", "022"), "squat1Reps": ("001", "013", "025")}
    names = [
        f"HDM_{actor}_{label}_{number}_120.amc"
        for label, numbers in first.items()
        for actor, number in zip(("bd", "bk", "dg"), numbers, strict=True)
    ]
    clips = [clip_postures(read_acclaim(folder / name), 30.0) for name in names]
    settings = DictionarySettings(n_atoms=16, n_nonzeros=2, n_rounds=5)
    dictionary = learn_dictionary(clips, settings)
    rows = [
        pyramid_descriptor(clip, dictionary, PyramidSettings(gap=0.1, normalize_cubes=True))
        for clip in clips
    ]

    kernel = pyramid_kernel(vstack(rows), vstack(rows))

    same = np.arange(6)[:, None] // 3 == np.arange(6) // 3
    is_off_diagonal = ~np.eye(6, dtype=bool)
    assert kernel[same & is_off_diagonal].mean() > 1.5 * kernel[~same].mean()
    for row, same_class in zip(kernel, same & is_off_diagonal, strict=True):
        others = ~same_class & (np.arange(6) != row.argmax())
        assert row[same_class].max() > row[others].max()
