"""When feet stand is carried over from the examples."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.motion import Motion
from solvers.motion.humanoid.contacts import detect_contacts
from solvers.rotations.representations import IDENTITY
from solvers.variation import (
    Method,
    VarySettings,
    borrow_variation,
    draw_variants,
    learn_variation_model,
)
from solvers.variation.footing import FAR, contacts_from, footing_of
from solvers.variation.mixtures import COMMON, mixed_deviations
from solvers.variation.partitions import FEET


def test_footing_tells_the_time_to_the_nearest_change(walks):
    walk = walks[0]
    stands, told = detect_contacts(walk), footing_of(walk)

    for side in range(2):
        changes = [
            frame + 0.5
            for frame in range(walk.n_frames - 1)
            if stands[frame, side] != stands[frame + 1, side]
        ]
        for frame in range(walk.n_frames):
            away = min(abs(frame - change) for change in changes) / walk.frame_rate
            wanted = min(away, FAR) * (1 if stands[frame, side] else -1)
            assert told[frame, side] == pytest.approx(wanted)
    assert_array_equal(contacts_from(told), stands)


def test_half_of_each_comes_down_half_way(model):
    """One stands from moment 30 on, another from 42 on: half of each from 36 on."""
    moments = np.arange(model.n_moments)
    footing = np.zeros((model.n_examples, model.n_moments, 2))
    footing[0] = (moments - 30)[:, None] / model.frame_rate
    footing[1] = (moments - 42)[:, None] / model.frame_rate
    shares = np.zeros((COMMON + 1, 1, model.n_moments, model.n_examples))
    shares[FEET, ..., :2] = 0.5

    drawn = mixed_deviations(replace(model, footing=footing), shares)[3][0]
    stands = contacts_from(drawn + footing.mean(axis=0))

    assert_array_equal(stands, np.repeat((moments > 36)[:, None], 2, axis=1))


@pytest.mark.parametrize("method", [Method.MIXTURE, Method.COREGIONALISED])
def test_a_copy_stands_when_the_example_does(method, walks):
    settings = VarySettings(method=method, amount=0.0)
    model = learn_variation_model(walks, settings=settings)

    copy = draw_variants(model, 1, settings=settings)[0]

    assert_array_equal(copy.contacts, detect_contacts(walks[model.centre]))


def test_a_leg_that_does_not_vary_stands_when_the_example_does(walks, model):
    frozen = VarySettings(left_leg=0.0, timing=0.0)
    own = detect_contacts(walks[model.centre])

    contacts = [one.contacts for one in draw_variants(model, 4, settings=frozen)]

    assert all((one[:, 0] == own[:, 0]).all() for one in contacts)
    assert any((one[:, 1] != own[:, 1]).any() for one in contacts)


def test_variants_stand_for_as_long_as_the_examples(walks, model):
    share = np.mean([detect_contacts(walk).mean() for walk in walks])
    for variant in draw_variants(model, 8):
        assert variant.contacts.shape == (variant.motion.n_frames, 2)
        assert variant.contacts.mean() == pytest.approx(share, abs=0.1)


def test_as_published_nobody_knows_when_feet_stand(walks):
    settings = VarySettings(method=Method.PUBLISHED)
    model = learn_variation_model(walks, settings=settings)
    assert draw_variants(model, 1, settings=settings)[0].contacts is None


def test_a_leg_alone_has_no_two_feet(leg):
    still = Motion(leg, np.tile(IDENTITY, (9, 4, 1)), np.zeros((9, 3)), 60.0)
    assert np.isnan(footing_of(still)).all()
    assert contacts_from(footing_of(still)) is None


def test_one_clip_stands_when_it_does(walks):
    model = borrow_variation(walks[0])
    assert_allclose(model.footing, np.broadcast_to(footing_of(walks[0]), model.footing.shape))
