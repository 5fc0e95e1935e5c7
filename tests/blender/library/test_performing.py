"""What gestures do with the library."""

import pytest


@pytest.fixture
def performing(load):
    return load("mocap_assist.search.performing")


@pytest.fixture
def performance(load, recordings):
    """The joints of a recorded actor."""
    path = recordings / "kinect" / "irds" / "215_18_5_8_1_stand.txt"
    return load("solvers.recordings").read_recording(path)


def test_performance_fills_the_list_and_waves_page_it(
    find, newcomer, performing, performance, blank
):
    newcomer("walk")
    find()
    listed = blank.context.window_manager.mocap_assist_matches

    message = performing.search_with(blank.context, performance)

    assert listed.query == "your performance" and len(listed.rows) == 6
    assert message == performing.chosen_sentence() and message.startswith("1 of 6: ")
    assert performing.page(blank.context, 1).startswith("2 of 6: ")
    assert performing.page(blank.context, -1) == message
    assert performing.page(blank.context, -1).startswith("6 of 6: ")
    assert performing.page(blank.context, 1) == message


def test_show_library_turns_on_the_ghost(performing, blank):
    blank.context.window_manager.mocap_assist_matches.rows.clear()
    blank.context.window_manager.mocap_assist_ghost = False

    assert performing.show_library(blank.context) == "No search yet."
    assert blank.context.window_manager.mocap_assist_ghost
    assert performing.page(blank.context, 1) == "No search yet."


def test_performance_reports_a_missing_library(performing, performance, blank, tmp_path):
    blank.context.scene.mocap_assist.library.library_file = str(tmp_path / "none")

    assert "There is no library yet" in performing.search_with(blank.context, performance)
