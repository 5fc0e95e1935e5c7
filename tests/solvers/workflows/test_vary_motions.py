"""Variants stand on their feet, and what is wrong with the examples is said."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from solvers.denoising import measure_quality
from solvers.motion import Motion
from solvers.recordings import read_recording
from solvers.samples import GaitSettings, walking_gait
from solvers.variation import VarySettings, measure_variation
from solvers.workflows import vary_motions


@pytest.fixture(scope="module")
def walks():
    return [
        walking_gait(GaitSettings(duration=1.1, frame_rate=60.0, seed=seed, cadence=cadence))
        for seed, cadence in ((1, 110), (2, 106), (3, 114))
    ]


@pytest.mark.parametrize("behavior", ["bd_squat1Reps", "bk_kickLFront1Reps"])
def test_variants_have_the_contacts_of_the_examples_without_slide(behavior, recordings):
    folder = recordings / "mocap" / "hdm05"
    files = sorted(folder.glob(f"HDM_{behavior}_*.amc"))[:6]
    examples = [read_recording(file) for file in files]
    variants = vary_motions(examples, 3)
    assert not variants.remarks
    measured = [
        [measure_quality(motion) for motion in motions]
        for motions in (examples, variants.motions)
    ]
    slides = [np.mean([one.foot_slide for one in each]) for each in measured]
    stands = [
        np.mean([foot.contact.mean() for one in each for foot in one.feet]) for each in measured
    ]
    assert slides[1] <= slides[0]
    assert stands[1] > 0.9 * stands[0]


def test_feet_are_unchanged_without_planting(walks):
    planted = vary_motions(walks, 1)
    free = vary_motions(walks, 1, planting=None)
    assert planted.motions[0].n_frames == free.motions[0].n_frames
    assert np.abs(planted.motions[0].rotations - free.motions[0].rotations).max() > 1e-3


def test_the_same_seed_makes_the_same_variants(walks):
    one, same, other = (
        vary_motions(walks, 2, settings=VarySettings(seed=seed)).motions for seed in (4, 4, 5)
    )
    assert_array_equal(one[1].rotations, same[1].rotations)
    assert one[0].n_frames != other[0].n_frames or not np.allclose(
        one[0].rotations, other[0].rotations, atol=1e-3
    )


def test_example_of_another_behavior_is_named(walks):
    still = walks[0]
    rotations = np.repeat(still.rotations[:1], still.n_frames, axis=0)
    standing = Motion(still.skeleton, rotations, still.root_positions * 0.3, still.frame_rate)
    remarks = vary_motions([*walks, standing], 1, planting=None).remarks
    assert len(remarks) == 1
    assert "Example 4" in remarks[0]
    assert "another behavior" in remarks[0]


def test_progress_rises_from_0_to_1(walks):
    messages = []
    vary_motions(walks, 2, progress=lambda fraction, message="": messages.append(fraction))
    assert messages == sorted(messages)
    assert messages[-1] == 1.0


def test_single_example_gets_shipped_variation_with_a_remark(walks):
    variants = vary_motions(walks[:1], 3, planting=None)
    assert measure_variation(variants.motions) > 0.003
    assert variants.remarks == (
        "There is only one example; its variation is borrowed from other motions.",
    )
