"""The panel Library."""

import dataclasses

import numpy as np
import pytest


@pytest.fixture
def matched(load, blank):
    """A list of two matches, as a search leaves it."""
    finding, retrieval = (
        load("mocap_assist.find_similar.solve_finding"),
        load("solvers.retrieval"),
    )
    searches = load("mocap_assist.find_similar.searches")
    pairs = np.array([[0, 0], [9, 9]])
    found = tuple(
        finding.Found(
            retrieval.ClipEntry(f"folder/{name}", ("calm",), None, 20, 20.0),
            retrieval.Match(f"folder/{name}", range(10), 0.9, pairs),
            np.zeros((10, 20, 3), np.float32),
            20.0,
            np.full((128, 128, 3), 255, np.uint8),
        )
        for name in ("walk", "run")
    )
    stage = finding.QueryPath(np.zeros((10, 3)), np.zeros(10), np.ones(20), 20.0)
    search = searches.store_search("take", (1.0, 1.0), 1.0, finding.Finding(found, stage, 5))
    load("mocap_assist.find_similar.scene_finding").fill_list(blank.context, search)
    return search


@pytest.mark.usefixtures("all_panels")
def test_panel_shows_index_and_find_without_matches(draw, blank):
    blank.context.window_manager.mocap_assist_matches.rows.clear()

    shown = draw("MOCAP_PT_library")

    assert {"mocap_assist.index_library", "mocap_assist.find_similar"} <= set(shown)
    assert "mocap_assist.load_match" not in shown
    assert "Select an animated armature" in " ".join(shown)


def test_panel_shows_every_search_setting_once(draw, blank, actor, show_research):
    find = blank.context.scene.mocap_assist.find

    shown = draw("MOCAP_PT_library")

    names = set(type(find).setting_names)
    assert sorted(names - {"n_aligned"}) == sorted(name for name in shown if name in names)


def test_panel_shows_matches_with_previews_and_buttons(draw, matched, blank):
    shown = draw("MOCAP_PT_library")

    assert shown.count("icon") == 2 + 2 + 1  # grid, list and the selected clip
    assert {"folder/walk", "folder/run", "90%", "mocap_assist_ghost"} <= set(shown)
    for button in ("load_match", "link_match", "learn_from_matches", "mark_asset"):
        assert f"mocap_assist.{button}" in shown
    assert "frames 1–10 of 20" in " ".join(shown) and "calm" in " ".join(shown)


def test_browsed_clips_are_no_best_matches(draw, matched, load, blank):
    browsed = dataclasses.replace(matched.finding, first=0)
    search = load("mocap_assist.find_similar.searches").store_search(
        "all", (1.0, 1.0), 1.0, browsed
    )
    load("mocap_assist.find_similar.scene_finding").fill_list(blank.context, search)

    shown = draw("MOCAP_PT_library")

    assert "Clips of the library" in shown and "mocap_assist.mark_asset" in shown
    assert not {"mocap_assist.learn_from_matches", "mocap_assist.use_matches"} & set(shown)


def test_click_in_the_grid_selects_a_clip(draw, matched, blank):
    assert draw("MOCAP_PT_library").count("mocap_assist.choose_match") == 2

    blank.ops.mocap_assist.choose_match(index=1)

    assert blank.context.window_manager.mocap_assist_matches.active == 1
    assert "folder/run: frames 1" in " ".join(draw("MOCAP_PT_library"))


def test_weak_matches_are_not_in_the_grid(draw, matched, blank):
    rows = blank.context.window_manager.mocap_assist_matches.rows
    rows[1].score = 0.1
    shown = draw("MOCAP_PT_library")
    assert shown.count("mocap_assist.choose_match") == 1
    assert "No good match" not in " ".join(shown)

    rows[0].score = 0.15

    shown = " ".join(draw("MOCAP_PT_library"))
    assert "No good match. The best is folder/walk, with a score of 15%." in shown
    assert "mocap_assist.choose_match" not in shown and "folder/run" in shown


def test_discarded_search_requests_a_new_one(draw, matched, blank):
    blank.context.window_manager.mocap_assist_matches.search = -1

    assert "Press Find Similar again." in " ".join(draw("MOCAP_PT_library"))
