"""Fix My Take gives long takes to a rig in another process, pressed in a window."""

import pytest
from modal_events import event, nothing_is_left, wait

CARD = "mocap_assist_fix"


@pytest.fixture
def sample(blank):
    """The armature of the built-in sample take."""
    assert blank.ops.mocap_assist.load_sample() == {"FINISHED"}
    return blank.context.object


@pytest.fixture
def waits_for_rig(sample, blank, load, make_button, window, monkeypatch):
    """Press Fix in a window; return the button and the rig while another process retargets."""
    blank.ops.mocap_assist.load_sample()
    rig, sample = blank.context.object, blank.data.objects[sample.name]
    blank.context.view_layer.objects.active = sample
    monkeypatch.setattr(
        load("mocap_assist.retarget.scene_retargeting"), "MAX_SHORT_SOLVE_FRAMES", 0
    )
    settings, jobs = load("mocap_assist.fix.button_settings"), []
    retargeting = load("mocap_assist.fix.retargeting")
    start = retargeting.Job
    monkeypatch.setattr(retargeting, "Job", lambda solve: jobs.append(start(solve)) or jobs[0])
    fixing = load("solvers.workflows").FixSettings(plant_feet=False)
    choices = settings.FixChoices(rig=rig.name)
    button = make_button("fix_take", settings.FixBundle(fixing, choices))
    assert button.invoke(window.context, None) == {"RUNNING_MODAL"}
    assert wait(button, window, until=lambda: jobs) is None
    return button, rig


def test_rig_gets_its_motion_from_another_process(waits_for_rig, window, sample):
    button, rig = waits_for_rig

    assert wait(button, window) == {"FINISHED"}

    action = sample.animation_data.action
    assert rig.animation_data.action.name == f"{action.name}.{rig.name}"
    assert "retargeted" in action[CARD] and nothing_is_left(window)


def test_esc_while_the_rig_waits_keeps_the_fixed_take_as_an_undo_step(
    waits_for_rig, window, sample, load, monkeypatch
):
    button, rig = waits_for_rig
    steps = []
    monkeypatch.setattr(load("mocap_assist.fix.scene_fixing"), "push_undo", steps.append)
    before = rig.animation_data.action

    assert button.modal(window.context, event("ESC", "PRESS")) == {"CANCELLED"}

    assert rig.animation_data.action == before and nothing_is_left(window)
    assert CARD in sample.animation_data.action
    assert steps == [sample.animation_data.action.name]
