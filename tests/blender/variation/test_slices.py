"""Variants that come into the scene a few at a time, while Blender only pretends to wait."""

import pytest
from modal_events import event, nothing_is_left, wait


@pytest.fixture
def button(load, press_button, walker, monkeypatch):
    """Vary, pressed for two walks; one variant is written between two looks."""
    button_settings = load("mocap_assist.variants.button_settings")
    monkeypatch.setattr(load("mocap_assist.runtime.solver_operator"), "MAX_SLICE_S", 0.0)
    settings = button_settings.VaryBundle(
        button_settings.VaryChoices(actions="walk_1; walk_2", n_variants=4, plant_feet=False),
        button_settings.VarySettings(),
        button_settings.PlantSettings(),
    )
    return press_button("vary", settings)


def n_variants(blank):
    return sum(".variant" in each.name for each in blank.data.actions)


def test_variants_arrive_one_by_one_and_the_last_ends_the_operator(button, window, blank):
    counts = []

    def poll():
        counts.append(n_variants(blank))
        return False

    assert wait(button, window, poll) == {"FINISHED"}

    assert next(n for n in counts if n) == 1 and {1, 2, 3} <= set(counts)
    assert n_variants(blank) == 4 and nothing_is_left(window)
    assert window.reports[-1] == ({"INFO"}, "4 variants of 2 actions.")


@pytest.mark.parametrize("n_written", [0, 2])
def test_esc_removes_all_variants(button, window, blank, walker, n_written):
    played = walker.animation_data.action
    wait(button, window, lambda: n_variants(blank) == n_written)

    outcome = button.modal(window.context, event("ESC", "PRESS"))

    assert outcome == {"CANCELLED"} and window.reports[-1] == ({"INFO"}, "Cancelled.")
    assert n_variants(blank) == 0 and nothing_is_left(window)
    assert walker.animation_data.action == played


def test_example_changed_or_deleted_during_the_solve_is_reported(button, window, blank):
    wait(button, window, lambda: n_variants(blank) == 2)
    blank.data.actions.remove(blank.data.actions["walk_1"])

    assert wait(button, window) == {"CANCELLED"}

    assert "walk_1 was deleted during the solve" in window.reports[-1][1]
    assert n_variants(blank) == 0 and nothing_is_left(window)
