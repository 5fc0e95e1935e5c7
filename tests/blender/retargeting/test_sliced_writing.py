"""A new action is written bone by bone, so that the window stays responsive."""

import itertools

import numpy as np
import pytest

N_BONES, N_FRAMES = 60, 6


@pytest.fixture
def writing(load, make_armature, blank, monkeypatch):
    """Work that writes an action, whose clock advances at each look."""
    names = [f"bone_{number}" for number in range(N_BONES)]
    armature = make_armature({
        name: (names[0] if number else None, (0, 0, 1.0), (0, 0, 1.1), False)
        for number, name in enumerate(names)
    })
    time_slices = load("mocap_assist.blender.time_slices")
    clock = itertools.count()
    monkeypatch.setattr(time_slices, "monotonic", lambda: next(clock))
    turned = np.tile([0.6, 0.8, 0.0, 0.0], (N_FRAMES, 1))
    channels = load("mocap_assist.scene.controls").BoneKeys(turned, None)
    return time_slices.Work(
        load("mocap_assist.actions.action_write").write_action,
        armature,
        "turned",
        np.arange(N_FRAMES) + 1.0,
        dict.fromkeys(names, channels),
        {},
    )


def test_bones_of_a_new_action_are_written_a_few_at_a_time(blank, writing):
    n_slices = 1
    while not writing.run_slice(10):
        n_slices += 1

    assert n_slices >= N_BONES // 10
    action, _ = writing.result
    assert len(action.layers[0].strips[0].channelbags[0].fcurves) == 4 * N_BONES


def test_new_action_has_a_fake_user_once_it_is_complete(blank, writing):
    while not blank.data.actions:
        assert not writing.run_slice(3)
    assert not blank.data.actions[0].users  # a file saved now leaves it out

    while not writing.run_slice(10):
        pass

    assert blank.data.actions[0].use_fake_user


def test_cancelled_writing_leaves_no_new_action(blank, writing):
    while not blank.data.actions:
        assert not writing.run_slice(3)

    writing.stop()

    assert not blank.data.actions
