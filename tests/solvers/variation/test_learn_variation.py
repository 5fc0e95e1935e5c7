"""What is learned of examples, and of odd ones."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidFileError, InvalidMotionError
from solvers.motion import Motion, Skeleton, resample
from solvers.rotations.representations import IDENTITY, multiply
from solvers.variation import (
    Method,
    VarySettings,
    borrow_variation,
    learn_variation_model,
    load_variation_model,
    measure_variation,
    synthesize,
)
from solvers.variation.learn_variation import MEMORY


def turned_about_z(motion, angle):
    turn = np.array([np.cos(angle / 2), 0.0, 0.0, np.sin(angle / 2)])
    rotations = motion.rotations.copy()
    rotations[:, 0] = multiply(turn, rotations[:, 0])
    cos, sin = np.cos(angle), np.sin(angle)
    x, y, z = motion.root_positions.T
    return replace(
        motion,
        rotations=rotations,
        root_positions=np.column_stack([cos * x - sin * y + 3, sin * x + cos * y - 2, z]),
    )


def test_where_an_example_happens_and_whither_it_faces_is_all_one(walks):
    there = [turned_about_z(walk, 0.7 * place) for place, walk in enumerate(walks)]

    usual, turned = (synthesize(learn_variation_model(one), 2) for one in (walks, there))

    for one, other in zip(usual, turned, strict=True):
        assert one.n_frames == other.n_frames
        assert_allclose(one.root_positions, other.root_positions, atol=1e-5)
        assert_allclose(np.abs(np.sum(one.rotations * other.rotations, axis=-1)), 1, atol=1e-7)


def test_the_odd_one_out_is_named(walks):
    swung = walks[3].rotations.copy()
    arm = walks[3].skeleton.names.index("LeftArm")
    swung[:, arm] = multiply([np.cos(1.2), np.sin(1.2), 0, 0], swung[:, arm])
    leg = walks[3].skeleton.names.index("LeftUpLeg")
    swung[:, leg] = multiply([np.cos(0.8), np.sin(0.8), 0, 0], swung[:, leg])

    model = learn_variation_model([*walks[:3], replace(walks[3], rotations=swung)])

    assert model.warning.startswith("Example 4 is ")
    assert not learn_variation_model(walks).warning


def test_other_frame_rates_are_brought_to_that_of_the_first(walks):
    model = learn_variation_model([walks[0], resample(walks[1], 120.0), walks[2]])

    assert model.frame_rate == 60.0
    assert not model.warning
    assert {one.frame_rate for one in synthesize(model, 2)} == {60.0}


def test_other_sizes_are_brought_to_that_of_the_first(walks):
    skeleton = walks[1].skeleton
    child = replace(
        walks[1],
        skeleton=Skeleton(skeleton.names, skeleton.parents, 0.6 * skeleton.offsets),
        root_positions=0.6 * walks[1].root_positions,
    )

    grown, usual = (learn_variation_model([walks[0], one]) for one in (child, walks[1]))

    assert_allclose(grown.root, usual.root, atol=0.01)


def test_refusals_say_which_example_and_what_to_do(walks, leg):
    hole = walks[1].rotations.copy()
    hole[5] = np.nan
    with pytest.raises(InvalidMotionError, match="There is no example"):
        learn_variation_model([])
    with pytest.raises(InvalidMotionError, match="Example 2 has one frame"):
        learn_variation_model([walks[0], walks[1].slice(0, 1)])
    with pytest.raises(InvalidMotionError, match="Example 2 has gaps; clean it first"):
        learn_variation_model([walks[0], replace(walks[1], rotations=hole)])
    still = Motion(leg, np.tile(IDENTITY, (9, 4, 1)), np.zeros((9, 3)), 60.0)
    with pytest.raises(InvalidMotionError, match="Example 2 is of another rig"):
        learn_variation_model([walks[0], still])
    with pytest.raises(InvalidMotionError, match="at least two"):
        measure_variation(walks[:1])


def test_examples_that_would_not_fit_into_memory_are_refused(walks):
    size = int(np.sqrt(MEMORY / walks[0].n_frames / walks[0].skeleton.n_joints)) + 1
    with pytest.raises(InvalidMotionError, match="too long to vary"):
        learn_variation_model([walks[0]] * size)


def test_what_is_no_body_is_refused(leg):
    still = Motion(leg, np.tile(IDENTITY, (9, 4, 1)), np.zeros((9, 3)), 60.0)
    with pytest.raises(InvalidMotionError, match=r"no joint for .*leftUpperLeg"):
        learn_variation_model([still, still])


@pytest.mark.parametrize(
    ("n_frames", "method"),
    [
        (2, Method.MIXTURE),
        (3, Method.MIXTURE),
        (2, Method.COREGIONALISED),
        (3, Method.PUBLISHED),
    ],
)
def test_clips_of_a_few_frames(walks, n_frames, method):
    short = [walk.slice(0, n_frames) for walk in walks[:2]]
    settings = VarySettings(method=method)

    model = learn_variation_model(short, settings=settings)

    for variant in synthesize(model, 2, settings=settings):
        assert np.isfinite(variant.rotations).all()
        assert variant.n_frames >= 2


def test_one_clip_alone_varies_only_by_what_is_borrowed(walks):
    alone, generic = learn_variation_model(walks[:1]), borrow_variation(walks[0])
    others = borrow_variation(walks[0], [learn_variation_model(walks[1:])])

    found = [measure_variation(synthesize(one, 6)) for one in (alone, generic, others)]

    assert found[0] < 1e-6
    assert 0.2 < found[1] / measure_variation(walks) < 2.0
    assert 0.2 < found[2] / measure_variation(walks) < 2.0
    assert generic.warning == "There is one example; how it varies is borrowed."
    assert_allclose(generic.joints.mean(axis=0), alone.joints[0], atol=1e-12)


def test_joints_that_stand_still_are_not_moved_by_the_generic_model(walks):
    still = walks[0].skeleton.names.index("Spine2")
    rotations = walks[0].rotations.copy()
    rotations[:, still] = IDENTITY

    model = borrow_variation(replace(walks[0], rotations=rotations))

    assert np.ptp(model.joints[:, :, still], axis=(0, 1)).max() < 1e-9


def test_borrowing_from_another_rig_is_refused(walks):
    skeleton = walks[0].skeleton
    names = tuple(name.replace("Spine2", "Ribs") for name in skeleton.names)
    other = replace(walks[1], skeleton=Skeleton(names, skeleton.parents, skeleton.offsets))
    with pytest.raises(InvalidMotionError, match="Model 1 to borrow from is of another rig"):
        borrow_variation(walks[0], [learn_variation_model([other])])


def test_a_saved_model_gives_the_same_variants(learned, tmp_path):
    model, settings = learned
    model.save(tmp_path / "walks.npz")

    again = load_variation_model(tmp_path / "walks.npz")

    ours, theirs = (synthesize(one, 2, settings=settings) for one in (model, again))
    for one, other in zip(ours, theirs, strict=True):
        assert_allclose(one.rotations, other.rotations, atol=1e-9)


def test_a_damaged_file_is_refused(model, tmp_path):
    path = tmp_path / "walks.npz"
    replace(model, haste=model.haste * np.nan).save(path)
    with pytest.raises(
        InvalidFileError,
        match=r"damaged variation model .* first of haste",
    ):
        load_variation_model(path)
