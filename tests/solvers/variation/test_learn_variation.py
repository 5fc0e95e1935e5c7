"""Models of examples, and errors for invalid ones."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidFileError, InvalidMotionError
from solvers.motion import Motion, Skeleton, resample
from solvers.rotations.representations import (
    IDENTITY,
    multiply,
    quaternion_from_rotation_vector,
    rotation_vector_from_quaternion,
)
from solvers.variation import (
    VaryMethod,
    VarySettings,
    borrow_variation,
    learn_variation_model,
    load_variation_model,
    measure_variation,
    synthesize,
)
from solvers.variation.learn_variation import MAX_VALUES


def rotated_about_z(motion, angle):
    rotation = np.array([np.cos(angle / 2), 0.0, 0.0, np.sin(angle / 2)])
    rotations = motion.rotations.copy()
    rotations[:, 0] = multiply(rotation, rotations[:, 0])
    cos, sin = np.cos(angle), np.sin(angle)
    x, y, z = motion.root_positions.T
    return replace(
        motion,
        rotations=rotations,
        root_positions=np.column_stack([cos * x - sin * y + 3, sin * x + cos * y - 2, z]),
    )


def test_model_ignores_position_and_heading_of_examples(walks, model):
    moved = [rotated_about_z(walk, 0.7 * index) for index, walk in enumerate(walks)]

    reference, rotated = (synthesize(one, 2) for one in (model, learn_variation_model(moved)))

    for one, other in zip(reference, rotated, strict=True):
        assert one.n_frames == other.n_frames
        assert_allclose(one.root_positions, other.root_positions, atol=1e-5)
        assert_allclose(np.abs(np.sum(one.rotations * other.rotations, axis=-1)), 1, atol=1e-7)


def test_warning_names_the_outlier(walks, model):
    swung = walks[3].rotations.copy()
    arm = walks[3].skeleton.names.index("LeftArm")
    swung[:, arm] = multiply([np.cos(1.2), np.sin(1.2), 0, 0], swung[:, arm])
    leg = walks[3].skeleton.names.index("LeftUpLeg")
    swung[:, leg] = multiply([np.cos(0.8), np.sin(0.8), 0, 0], swung[:, leg])

    with_outlier = learn_variation_model([*walks[:3], replace(walks[3], rotations=swung)])

    assert with_outlier.warning.startswith("Example 4 is ")
    assert not model.warning


def test_examples_are_resampled_to_the_first_frame_rate(walks):
    model = learn_variation_model([walks[0], resample(walks[1], 120.0), walks[2]])

    assert model.frame_rate == 60.0
    assert not model.warning
    assert {one.frame_rate for one in synthesize(model, 2)} == {60.0}


def test_examples_are_scaled_to_the_size_of_the_first(walks):
    skeleton = walks[1].skeleton
    child = replace(
        walks[1],
        skeleton=Skeleton(skeleton.names, skeleton.parents, 0.6 * skeleton.offsets),
        root_positions=0.6 * walks[1].root_positions,
    )

    grown, reference = (learn_variation_model([walks[0], one]) for one in (child, walks[1]))

    assert_allclose(grown.root, reference.root, atol=0.01)


def test_errors_name_the_example_and_the_remedy(walks, leg):
    hole = walks[1].rotations.copy()
    hole[5] = np.nan
    with pytest.raises(InvalidMotionError, match="There is no example"):
        learn_variation_model([])
    with pytest.raises(InvalidMotionError, match="Example 2 has one frame"):
        learn_variation_model([walks[0], walks[1].slice(0, 1)])
    with pytest.raises(InvalidMotionError, match="Example 2 has gaps; clean it first"):
        learn_variation_model([walks[0], replace(walks[1], rotations=hole)])
    still = Motion(leg, np.tile(IDENTITY, (9, 4, 1)), np.zeros((9, 3)), 60.0)
    with pytest.raises(InvalidMotionError, match="Example 2 has a different rig"):
        learn_variation_model([walks[0], still])
    with pytest.raises(InvalidMotionError, match="at least two"):
        measure_variation(walks[:1])


def test_learning_raises_when_examples_exceed_memory(walks):
    size = int(np.sqrt(MAX_VALUES / walks[0].n_frames / walks[0].skeleton.n_joints)) + 1
    with pytest.raises(InvalidMotionError, match="too long to vary"):
        learn_variation_model([walks[0]] * size)


def test_learning_raises_without_a_body(leg):
    still = Motion(leg, np.tile(IDENTITY, (9, 4, 1)), np.zeros((9, 3)), 60.0)
    with pytest.raises(InvalidMotionError, match=r"no joint for .*leftUpperLeg"):
        learn_variation_model([still, still])


@pytest.mark.parametrize(
    ("n_frames", "method"),
    [
        (2, VaryMethod.MIXTURE),
        (3, VaryMethod.MIXTURE),
        (2, VaryMethod.COREGIONALISED),
        (3, VaryMethod.PUBLISHED),
    ],
)
def test_clips_of_a_few_frames(walks, n_frames, method):
    short = [walk.slice(0, n_frames) for walk in walks[:2]]
    settings = VarySettings(method=method)

    model = learn_variation_model(short, settings=settings)

    for variant in synthesize(model, 2, settings=settings):
        assert np.isfinite(variant.rotations).all()
        assert variant.n_frames >= 2


def test_single_clip_varies_only_by_borrowed_variation(walks):
    separate, generic = learn_variation_model(walks[:1]), borrow_variation(walks[0])
    others = borrow_variation(walks[0], [learn_variation_model(walks[1:])])

    found = [measure_variation(synthesize(one, 6)) for one in (separate, generic, others)]

    assert found[0] < 1e-6
    assert 0.2 < found[1] / measure_variation(walks) < 2.0
    assert 0.2 < found[2] / measure_variation(walks) < 2.0
    assert (
        generic.warning
        == "There is only one example; its variation is borrowed from other motions."
    )
    assert_allclose(generic.joints.mean(axis=0), separate.joints[0], atol=1e-12)


def test_borrowed_variation_shrinks_with_the_movement_of_the_clip(walks):
    half = quaternion_from_rotation_vector(
        0.5 * rotation_vector_from_quaternion(walks[0].rotations)
    )
    other = learn_variation_model(walks[1:])

    found = [
        borrow_variation(clip, [other])
        for clip in (walks[0], replace(walks[0], rotations=half))
    ]

    spread, half_spread = (model.joints[1:].std(axis=0).mean() for model in found)
    assert half_spread == pytest.approx(0.5 * spread, rel=0.1)


def test_variation_of_hardly_moving_clips_is_not_scaled_up_to_that_of_a_walk(walks):
    quiet = [
        replace(each, rotations=quaternion_from_rotation_vector(
            0.05 * rotation_vector_from_quaternion(each.rotations)
        ))
        for each in walks[1:]
    ]  # fmt: skip

    own = learn_variation_model(quiet)

    borrowed = borrow_variation(walks[0], [own])

    assert borrowed.joints.std(axis=0).mean() < 3.0 * own.joints.std(axis=0).mean()


def test_generic_model_does_not_move_joints_at_rest(walks):
    still = walks[0].skeleton.names.index("Spine2")
    rotations = walks[0].rotations.copy()
    rotations[:, still] = IDENTITY

    model = borrow_variation(replace(walks[0], rotations=rotations))

    assert np.ptp(model.joints[:, :, still], axis=(0, 1)).max() < 1e-9


def test_borrowing_raises_for_another_rig(walks):
    skeleton = walks[0].skeleton
    names = tuple(name.replace("Spine2", "Ribs") for name in skeleton.names)
    other = replace(walks[1], skeleton=Skeleton(names, skeleton.parents, skeleton.offsets))
    with pytest.raises(InvalidMotionError, match="Model 1 to borrow from has a different rig"):
        borrow_variation(walks[0], [learn_variation_model([other])])


def test_saved_model_gives_the_same_variants(learned, tmp_path):
    model, settings = learned
    model.save(tmp_path / "walks.npz")

    again = load_variation_model(tmp_path / "walks.npz")

    result, reference = (synthesize(one, 2, settings=settings) for one in (model, again))
    for one, other in zip(result, reference, strict=True):
        assert_allclose(one.rotations, other.rotations, atol=1e-9)


def test_loading_raises_for_a_damaged_file(model, tmp_path):
    path = tmp_path / "walks.npz"
    replace(model, log_warp_rates=model.log_warp_rates * np.nan).save(path)
    with pytest.raises(
        InvalidFileError,
        match=r"damaged variation model .* first of haste",
    ):
        load_variation_model(path)
