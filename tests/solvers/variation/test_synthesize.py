"""Properties of variants, for every method."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.denoising import measure_quality
from solvers.errors import InvalidMotionError, SolveCancelled
from solvers.motion import forward_kinematics, warp
from solvers.rotations.representations import inverse, multiply, rotation_vector_from_quaternion
from solvers.variation import (
    Partition,
    VaryMethod,
    VarySettings,
    measure_variation,
    synthesize,
)
from solvers.variation.align_examples import positions_in_body_frame
from solvers.variation.curves.motion_curves import curves_from_motion, headings_from_motion
from solvers.variation.curves.partitions import partition_joints
from solvers.variation.synthesize import RANGE_MARGIN

drawn = partial(synthesize, planting=None)


def rotation_between(one, other):
    return np.linalg.norm(
        rotation_vector_from_quaternion(multiply(inverse(one), other)), axis=-1
    )


def test_the_same_seed_gives_the_same_bits(learned):
    model, settings = learned
    first, again = (drawn(model, 3, settings=settings) for _ in range(2))
    other = drawn(model, 3, settings=replace(settings, seed=5))

    for one, two in zip(first, again, strict=True):
        assert_array_equal(one.rotations, two.rotations)
        assert_array_equal(one.root_positions, two.root_positions)
    assert first[0].rotations.shape != other[0].rotations.shape or not np.allclose(
        first[0].rotations, other[0].rotations
    )


def test_feet_are_planted(learned):
    model, settings = learned

    free, planted = (make(model, 1, settings=settings)[0] for make in (drawn, synthesize))

    assert measure_quality(planted).foot_slide < 0.5 * measure_quality(free).foot_slide


def test_variant_is_the_example_at_zero_amount(learned, walks):
    model, settings = learned
    center = walks[model.center]

    copy = drawn(model, 2, settings=replace(settings, amount=0.0))[1]

    assert copy.n_frames == center.n_frames
    assert rotation_between(copy.rotations[:, 1:], center.rotations[:, 1:]).max() < 1e-5
    assert_allclose(positions_in_body_frame(copy), positions_in_body_frame(center), atol=1e-5)


@pytest.mark.parametrize("method", [VaryMethod.MIXTURE, VaryMethod.COREGIONALISED])
def test_variation_grows_with_the_amount(method, learned_with):
    model = learned_with(method)
    found = [
        measure_variation(drawn(model, 8, settings=VarySettings(method=method, amount=amount)))
        for amount in (0.25, 0.5, 1.0, 2.0)
    ]

    assert found == sorted(found)
    assert found[3] > 1.3 * found[2]


def test_variants_vary_as_much_as_the_examples(walks, model):
    ratio = measure_variation(drawn(model, 12)) / measure_variation(walks)

    assert 0.7 < ratio < 1.4


@pytest.mark.parametrize("partition", Partition)
def test_frozen_partition_equals_that_of_the_base(partition, learned, walks):
    model, settings = learned
    frozen = replace(settings, timing=0.0, **{partition.name.lower(): 0.0})
    members = partition_joints(model.skeleton)[list(Partition).index(partition)]
    members[0] = False

    variant = drawn(model, 1, settings=frozen)[0]

    distances = rotation_between(variant.rotations, walks[model.center].rotations)
    assert distances[:, members].max() < 1e-5
    assert distances[:, ~members].max() > 0.01


def test_small_amount_stays_near_the_base(learned, walks):
    model, settings = learned
    farthest = (model.center + 1) % len(walks)
    little = replace(settings, amount=0.02, base=farthest + 1)

    for variant in drawn(model, 3, settings=little):
        distance = warp(
            positions_in_body_frame(variant), positions_in_body_frame(walks[farthest])
        ).cost
        assert 1e-5 < distance < 0.15 * measure_variation(walks)


def test_pins_hold_with_any_timing(learned, walks):
    model, settings = learned
    pinned = replace(settings, pin_start=True, pin_end=True)
    example = positions_in_body_frame(walks[model.center])

    for variant in drawn(model, 3, settings=pinned):
        observed = positions_in_body_frame(variant)
        # Millimeters: `positions_in_body_frame` removes a heading averaged over frames.
        assert_allclose(observed[0], example[0], atol=3e-3)
        assert_allclose(observed[-1], example[-1], atol=3e-3)
        assert warp(observed, example).distances.max() > 0.005


@pytest.mark.parametrize("amount", [1.0, 2.0])
def test_joints_stay_near_the_range_of_the_examples(amount, learned):
    model, settings = learned
    low, high = model.joints.min(axis=(0, 1)), model.joints.max(axis=(0, 1))
    # Between moments splines overshoot a little; those through white noise, as published, far.
    times = 6.0 if settings.method is VaryMethod.PUBLISHED else 1.2
    slack = times * RANGE_MARGIN * (high - low) + 1e-6

    for variant in drawn(model, 5, settings=replace(settings, amount=amount)):
        joints = curves_from_motion(
            variant, headings_from_motion(variant), model.reference_rotations
        ).joints[:, 1:]
        assert (joints > (low - slack)[1:]).all()
        assert (joints < (high + slack)[1:]).all()


def test_variant_has_the_requested_length(model, walks):
    reference, slow = (
        drawn(model, 1, settings=VarySettings(length=length))[0] for length in (1.0, 2.0)
    )

    assert abs(slow.n_frames - 2 * reference.n_frames) <= 2


def test_timing_changes_only_the_length(model):
    """Without timing all variants take the base's time."""
    same = {one.n_frames for one in drawn(model, 6, settings=VarySettings(timing=0.0))}
    different = {one.n_frames for one in drawn(model, 6)}

    assert same == {model.n_samples}
    assert len(different) > 2


def test_variants_start_above_the_origin_facing_minus_y(model):
    for variant in drawn(model, 3):
        assert_allclose(variant.root_positions[0, :2], 0.0, atol=0.05)
        assert abs(headings_from_motion(variant)[0]) < 0.2
        assert np.isfinite(forward_kinematics(variant).positions).all()


def test_first_variants_keep_their_size_when_more_are_drawn(learned):
    model, settings = learned
    many = drawn(model, 7, settings=settings)

    assert len(many) == 7
    assert len({one.rotations.tobytes() for one in many}) == 7


def test_errors_name_a_remedy(model):
    with pytest.raises(InvalidMotionError, match="request at least one"):
        drawn(model, 0)
    with pytest.raises(InvalidMotionError, match="There is no example 9; the model has 4"):
        drawn(model, 1, settings=VarySettings(base=9))
    with pytest.raises(InvalidMotionError, match="not learned for the method published"):
        drawn(model, 1, settings=VarySettings(method=VaryMethod.PUBLISHED))


def test_progress_reaches_one_and_can_cancel(model):
    fractions = []
    drawn(model, 4, progress=lambda fraction, message="": fractions.append(fraction))

    def cancel(fraction, message=""):
        raise SolveCancelled

    assert fractions == sorted(fractions)
    assert fractions[-1] == 1.0
    with pytest.raises(SolveCancelled):
        drawn(model, 4, progress=cancel)
