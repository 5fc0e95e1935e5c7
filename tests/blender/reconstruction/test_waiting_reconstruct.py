"""Esc while Reconstruct runs; here Blender pretends to have a window."""

import pytest
from modal_events import event, nothing_is_left, wait


@pytest.fixture
def press_reconstruct(make_button, window, load):
    """Press Reconstruct; return the button, which has read the take and waits."""
    button_settings = load("mocap_assist.reconstruct.button_settings")

    def press():
        settings = button_settings.ReconstructBundle(
            button_settings.ReconstructChoices(),
            load("solvers.reconstruction").ReconstructSettings(),
            load("solvers.denoising").PlantSettings(),
        )
        button = make_button("reconstruct", settings)
        assert button.invoke(window.context, None) == {"RUNNING_MODAL"}
        assert wait(button, window, until=lambda: hasattr(button, "_job")) is None
        return button

    return press


@pytest.mark.parametrize("solved", [0.0, 0.2], ids=["at once", "half way"])
def test_escape_cancels_reconstruct_and_writes_nothing(
    walk, press_reconstruct, window, blank, solved
):
    actions = blank.data.actions.keys()
    button = press_reconstruct()
    wait(button, window, until=lambda: button._job.progress()[0] >= solved)

    assert window.job.owner == "reconstruct"
    assert button.modal(window.context, event("ESC", "PRESS")) == {"CANCELLED"}

    assert blank.data.actions.keys() == actions
    assert walk.animation_data.action.name == actions[0]
    assert nothing_is_left(window) and window.reports == [({"INFO"}, "Cancelled.")]


def test_reconstruct_writes_a_new_action_when_it_ends(walk, press_reconstruct, window, blank):
    recorded = walk.animation_data.action

    assert wait(press_reconstruct(), window) == {"FINISHED"}

    assert walk.animation_data.action.name == f"{recorded.name}.reconstructed"
    assert recorded.name in blank.data.actions and nothing_is_left(window)
