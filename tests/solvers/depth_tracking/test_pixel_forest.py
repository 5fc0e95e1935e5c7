"""Pixel forests: features, training, classification and files."""

from dataclasses import replace

import numpy as np
import pytest
from box_person import box_person
from hypothesis import given, settings
from hypothesis import strategies as st

from solvers.depth_scene.camera import Camera
from solvers.depth_tracking.forest.depth_differences import (
    BACKGROUND_MM,
    depth_differences,
    pad_depth_image,
    pixel_features,
)
from solvers.depth_tracking.forest.grow_tree import (
    N_BINS,
    THRESHOLDS_MM,
    Tree,
    TreeSettings,
    _gains,
    grow_tree,
)
from solvers.depth_tracking.forest.parts import N_PARTS
from solvers.depth_tracking.forest.pixel_forest import (
    LAYOUT,
    SHIPPED,
    PixelForest,
    classify_pixels,
    load_pixel_forest,
)
from solvers.depth_tracking.forest_training.render_mesh import NO_PART
from solvers.depth_tracking.forest_training.train_forest import (
    PixelForestSettings,
    draw_images,
    draw_pixels,
    train_pixel_forest,
)
from solvers.depth_tracking.forest_training.training_images import CAMERA, image_source
from solvers.errors import InvalidFileError, InvalidMotionError
from solvers.samples import GaitSettings, walking_gait

SMALL = PixelForestSettings(
    n_images=80,
    n_pixels=100,
    n_trees=2,
    levels=8,
    n_candidates=30,
    min_pixels=20,
    loose=0.0,
)


@pytest.fixture(scope="module")
def gait():
    return walking_gait(GaitSettings(duration=1.0, frame_rate=10.0))


@pytest.fixture(scope="module")
def bodies():
    return [box_person(), box_person(1.2)]


@pytest.fixture(scope="module")
def forest(gait, bodies):
    return train_pixel_forest([gait], bodies, SMALL, trained_on="a made walk")


@pytest.fixture(scope="module")
def held_out(gait, bodies):
    """Images with another seed."""
    source = image_source([gait], bodies, SMALL, 99)
    observed = draw_images(source, range(1))
    depth = (
        np.where(observed.images == BACKGROUND_MM, 0, observed.images)[:, 1:-1, 1:-1] / 1000.0
    )
    return depth.astype(np.float32), observed.labels


def depth_difference(depth, camera, row, column, right, down):
    """Depth feature of one pixel in millimeters, from its definition."""
    z = depth[row, column]
    u = int(np.rint(column + camera.fx * right / z))
    v = int(np.rint(row + camera.fy * down / z))
    inside = 0 <= u < camera.width and 0 <= v < camera.height
    return round(1000 * float(depth[v, u])) if inside and depth[v, u] > 0 else BACKGROUND_MM


@settings(max_examples=30)
@given(seed=st.integers(0, 1000))
def test_features_are_differences_at_metric_offsets(seed):
    rng = np.random.default_rng(seed)
    camera = Camera(rng.uniform(20, 60), rng.uniform(20, 60), 9.5, 7.5, 20, 16)
    depth = (rng.uniform(0.5, 3, (16, 20)) * (rng.random((16, 20)) < 0.7)).astype(np.float32)
    rows, columns = np.nonzero(depth)
    offsets = rng.uniform(-1, 1, 4).astype(np.float32)
    views = pixel_features(
        pad_depth_image(depth)[None], np.zeros(len(rows), int), rows, columns, camera
    )
    differences = depth_differences(views, offsets)
    exact = [
        depth_difference(depth, camera, row, column, *offsets[:2])
        - depth_difference(depth, camera, row, column, *offsets[2:])
        for row, column in zip(rows, columns, strict=True)
    ]
    # Rounding may assign a position between two pixels to either.
    assert (np.abs(differences - exact) <= 1).mean() > 0.98


def test_gains_equal_differences_of_entropy(rng):
    counts = rng.integers(0, 9, (5, N_BINS, N_PARTS))
    gain, edge = _gains(counts)

    def entropy(parts):
        fractions = parts[parts > 0] / parts.sum() if parts.sum() else np.ones(1)
        return -(fractions * np.log(fractions)).sum()

    for node in range(5):
        complete = counts[node].sum(axis=0)
        each = []
        for bins in range(1, N_BINS):
            low = counts[node, :bins].sum(axis=0)
            after = low.sum() * entropy(low) + (complete - low).sum() * entropy(complete - low)
            each.append(complete.sum() * entropy(complete) - after)
        np.testing.assert_allclose(gain[node], max(each), rtol=1e-3)
        assert each[edge[node]] == pytest.approx(max(each), rel=1e-3)


def test_grow_tree_learns_a_single_feature(rng):
    """Half of the pixels have background on their right: one test separates them."""
    depth = np.full((40, 60), 2.0, dtype=np.float32)
    depth[:, 30:] = 0.0
    rows, columns = np.nonzero(depth)
    views = pixel_features(
        pad_depth_image(depth)[None], np.zeros(len(rows), int), rows, columns, CAMERA
    )
    views = views._replace(width=60, height=40)
    parts = np.where(columns >= 25, 4, 9).astype(np.uint8)
    tree = grow_tree(views, parts, TreeSettings(levels=4, n_candidates=400), rng)
    assert (tree.shares.max(axis=1) == 255).mean() > 0.6
    assert tree.splits[0]
    assert len(tree.splits) == 2 * tree.splits.sum() + 1


def test_classify_pixels_matches_a_scalar_traversal(forest, held_out):
    depth = held_out[0][3]
    found = classify_pixels(depth, CAMERA, forest)
    for pixel in range(0, len(found.rows), 41):
        position = int(found.rows[pixel]), int(found.columns[pixel])
        fractions = np.mean(
            [leaf_probabilities(tree, depth, *position) for tree in forest.trees], axis=0
        )
        np.testing.assert_allclose(found.probabilities[pixel], fractions, atol=1e-6)


def leaf_probabilities(tree, depth, row, column):
    node = 0
    while tree.splits[node]:
        rank = int(tree.splits[:node].sum())
        offsets = tree.offsets[rank].astype(np.float32) / np.float32(100)
        difference = depth_difference(depth, CAMERA, row, column, *offsets[:2])
        difference -= depth_difference(depth, CAMERA, row, column, *offsets[2:])
        node = 1 + 2 * rank + (difference > tree.thresholds[rank])
    fractions = tree.shares[int((~tree.splits[:node]).sum())].astype(float)
    return fractions / fractions.sum()


def test_classify_pixels_beats_chance_on_held_out_images(forest, held_out):
    right, total = 0, 0
    for depth, labels in zip(*held_out, strict=True):
        found = classify_pixels(depth, CAMERA, forest)
        right += (found.labels == labels[found.rows, found.columns]).sum()
        total += len(found.rows)
    assert right / total > 0.35  # The most frequent part has a sixth of all pixels.


def test_classify_pixels_is_independent_of_resolution(forest, held_out):
    depth = held_out[0][5]
    fine = np.repeat(np.repeat(depth, 2, axis=0), 2, axis=1)
    camera = Camera(2 * 142.8, 2 * 142.8, 159.5, 119.5, 320, 240)
    small = classify_pixels(depth, CAMERA, forest)
    large = classify_pixels(fine, camera, forest)
    labels = np.full(fine.shape, -1)
    labels[large.rows, large.columns] = large.labels
    assert (labels[2 * small.rows, 2 * small.columns] == small.labels).mean() > 0.7


def test_training_repeats_for_the_same_seed(gait, bodies, forest):
    again = train_pixel_forest([gait], bodies, SMALL)
    other = train_pixel_forest([gait], bodies, replace(SMALL, seed=1))
    np.testing.assert_array_equal(again.trees[1].offsets, forest.trees[1].offsets)
    np.testing.assert_array_equal(again.trees[1].shares, forest.trees[1].shares)
    assert not np.array_equal(other.trees[0].offsets, forest.trees[0].offsets)


def test_training_pixels_are_of_bodies_and_unique(gait, bodies, rng):
    observed = draw_images(image_source([gait], bodies, SMALL, 0), range(1))
    views, parts = draw_pixels(observed, 50, rng)
    assert len(np.unique(views.flat_index)) == len(views.flat_index)
    assert parts.max() < N_PARTS
    assert (observed.labels != NO_PART).sum(axis=(1, 2)).clip(max=50).sum() == len(parts)


def test_empty_image_has_no_parts(forest):
    found = classify_pixels(np.zeros((120, 160), np.float32), CAMERA, forest)
    assert found.probabilities.shape == (0, N_PARTS)
    assert found.labels.shape == (0,)


def test_load_restores_a_saved_forest(forest, held_out, tmp_path):
    forest.save(tmp_path / "forest.npz")
    loaded = load_pixel_forest(tmp_path / "forest.npz")
    assert loaded.trained_on == "a made walk"
    for original, restored in zip(forest.trees, loaded.trees, strict=True):
        for name in ("splits", "offsets", "thresholds", "shares"):
            np.testing.assert_array_equal(getattr(original, name), getattr(restored, name))
    one, other = (classify_pixels(held_out[0][0], CAMERA, each) for each in (forest, loaded))
    np.testing.assert_array_equal(one.probabilities, other.probabilities)


@pytest.mark.parametrize(
    ("name", "value", "fault"),
    [
        ("parts", np.array(["hips"]), "other parts"),
        ("n_nodes", np.array([3]), "nodes do not fit"),
        ("thresholds", np.zeros(2, np.int16), "shapes do not fit"),
        ("offsets", np.zeros((2, 4)), "other kinds"),
        ("shares", None, "missing"),
    ],
)
def test_load_raises_for_damaged_forests(forest, tmp_path, name, value, fault):
    path = tmp_path / "forest.npz"
    forest.save(path)
    arrays = LAYOUT.read(path)
    if value is None:
        del arrays[name]
    else:
        arrays[name] = value
    LAYOUT.write(path, arrays)
    with pytest.raises(InvalidFileError, match=fault):
        load_pixel_forest(path)


def test_load_pixel_forest_raises_for_empty_leaves(forest, tmp_path):
    fractions = np.zeros_like(forest.trees[0].shares)
    empty = PixelForest((Tree(*vars(replace(forest.trees[0], shares=fractions)).values()),))
    empty.save(tmp_path / "forest.npz")
    with pytest.raises(InvalidFileError, match="a leaf is empty"):
        load_pixel_forest(tmp_path / "forest.npz")


def test_training_raises_without_poses_or_bodies(gait, bodies):
    with pytest.raises(InvalidMotionError, match="at least one motion"):
        train_pixel_forest([], bodies, SMALL)
    with pytest.raises(InvalidMotionError, match="at least one motion"):
        train_pixel_forest([gait], [], SMALL)
    with pytest.raises(InvalidMotionError, match="at least one tree"):
        PixelForest(())


def test_threshold_edges_are_sorted():
    assert (np.diff(THRESHOLDS_MM) > 0).all()
    np.testing.assert_array_equal(THRESHOLDS_MM, -THRESHOLDS_MM[::-1])


def test_shipped_forest_is_small_and_names_its_sources():
    forest = load_pixel_forest()
    assert SHIPPED.stat().st_size <= 3_000_000
    assert "CMU" in forest.trained_on
    assert len(forest.trees) >= 3
