"""Foot contacts of variants follow those of the examples."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.motion import Motion
from solvers.motion.humanoid.foot_contacts import detect_contacts
from solvers.rotations.representations import IDENTITY
from solvers.variation import (
    VaryMethod,
    VarySettings,
    borrow_variation,
    draw_variants,
)
from solvers.variation.contact_state import (
    MAX_CONTACT_TIME_S,
    _signed_change_times,
    contacts_from_state,
    measure_contact_state,
)
from solvers.variation.curves.partitions import LEG_ROWS, ROOT_ROW
from solvers.variation.mixtures import mix_deviations


def test_contact_state_is_signed_time_to_nearest_change(walks):
    walk = walks[0]
    contacts, measured = detect_contacts(walk), measure_contact_state(walk)

    for side in range(2):
        changes = [
            frame + 0.5
            for frame in range(walk.n_frames - 1)
            if contacts[frame, side] != contacts[frame + 1, side]
        ]
        for frame in range(walk.n_frames):
            distance = min(abs(frame - change) for change in changes) / walk.frame_rate
            expected = min(distance, MAX_CONTACT_TIME_S) * (1 if contacts[frame, side] else -1)
            assert measured[frame, side] == pytest.approx(expected)
    assert_array_equal(contacts_from_state(measured), contacts)


def test_touch_down_is_halfway_when_examples_mix_equally(model):
    """One foot stands from sample 30 on, another from 42 on: their equal mixture from 36 on."""
    samples = np.arange(model.n_samples)
    contact_state = np.zeros((model.n_examples, model.n_samples, 2))
    contact_state[0] = (samples - 30)[:, None] / model.frame_rate
    contact_state[1] = (samples - 42)[:, None] / model.frame_rate
    weights = np.zeros((ROOT_ROW + 1, 1, model.n_samples, model.n_examples))
    weights[LEG_ROWS, ..., :2] = 0.5

    drawn = mix_deviations(replace(model, contact_state=contact_state), weights)[3][0]
    contacts = contacts_from_state(drawn + contact_state.mean(axis=0))

    assert_array_equal(contacts, np.repeat((samples > 36)[:, None], 2, axis=1))


@pytest.mark.parametrize("method", [VaryMethod.MIXTURE, VaryMethod.COREGIONALISED])
def test_contacts_equal_those_of_the_example_at_zero_amount(method, walks, learned_with):
    settings, model = VarySettings(method=method, amount=0.0), learned_with(method)

    copy = draw_variants(model, 1, settings=settings)[0]

    assert_array_equal(copy.contacts, detect_contacts(walks[model.center]))


def test_contacts_of_a_frozen_leg_equal_those_of_the_example(walks, model):
    frozen = VarySettings(left_leg=0.0, timing=0.0)
    own = detect_contacts(walks[model.center])

    contacts = [each.contacts for each in draw_variants(model, 4, settings=frozen)]

    assert all((each[:, 0] == own[:, 0]).all() for each in contacts)
    assert any((each[:, 1] != own[:, 1]).any() for each in contacts)


def test_variants_keep_the_mean_contact_duration(walks, model):
    contact_fraction = np.mean([detect_contacts(walk).mean() for walk in walks])
    for variant in draw_variants(model, 8):
        assert variant.contacts.shape == (variant.motion.n_frames, 2)
        assert variant.contacts.mean() == pytest.approx(contact_fraction, abs=0.1)


def test_contacts_are_unknown_with_the_published_method(learned_with):
    settings, model = (
        VarySettings(method=VaryMethod.PUBLISHED),
        learned_with(VaryMethod.PUBLISHED),
    )

    assert draw_variants(model, 1, settings=settings)[0].contacts is None


def test_contact_state_is_nan_without_two_feet(leg):
    still = Motion(leg, np.tile(IDENTITY, (9, 4, 1)), np.zeros((9, 3)), 60.0)
    assert np.isnan(measure_contact_state(still)).all()
    assert contacts_from_state(measure_contact_state(still)) is None


def test_borrowed_variation_keeps_the_contacts_of_the_clip(walks):
    model = borrow_variation(walks[0])
    assert_allclose(
        model.contact_state,
        np.broadcast_to(measure_contact_state(walks[0]), model.contact_state.shape),
    )


def test_foot_that_always_stands_has_a_finite_contact_state():
    """It has no contact change to be near to."""
    state = _signed_change_times(np.ones(50, bool), 60.0)

    assert np.isfinite(state).all()
