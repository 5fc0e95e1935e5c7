"""What gestures do with the library."""

from dataclasses import replace
from types import SimpleNamespace

import pytest


@pytest.fixture
def performing(load):
    return load("mocap_assist.find_similar.performing")


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
    assert performing.show_next_match(blank.context, 1).startswith("2 of 6: ")
    assert performing.show_next_match(blank.context, -1) == message
    assert performing.show_next_match(blank.context, -1).startswith("6 of 6: ")
    assert performing.show_next_match(blank.context, 1) == message


def test_library_is_browsed_and_a_clip_searched_with(
    find, newcomer, performing, blank, load, monkeypatch
):
    newcomer("walk")
    find()
    listed = blank.context.window_manager.mocap_assist_matches

    shown = performing.show_all(blank.context)

    assert shown.startswith("1 of 6: ") and "%" not in shown and len(listed.rows) == 6
    search = load("mocap_assist.find_similar.searches").listed_search(blank.context)
    ghost, found = load("mocap_assist.find_similar.ghost"), search.finding.found[0]
    last = (found.entry.n_frames - 1) / found.entry.frame_rate * 30.0
    assert ghost.clip_frame(found, last) == pytest.approx(found.entry.n_frames - 1, abs=1.0)
    assert len(ghost.ghost_lines(search.finding.stage, found, 3.0)) == 19

    assert performing.show_next_match(blank.context, 1).startswith("2 of 6: ")
    name = listed.rows[1].name
    with pytest.raises(RuntimeError, match="These clips were not searched for"):
        blank.ops.mocap_assist.learn_from_matches()
    with pytest.raises(RuntimeError, match="These clips were not searched for"):
        blank.ops.mocap_assist.use_matches()
    assert performing.search_with_shown(blank.context).startswith("1 of 5: ")
    assert listed.query == name and name not in [row.name for row in listed.rows]

    monkeypatch.setattr(load("mocap_assist.find_similar.solve_finding"), "MAX_MATCHES", 4)
    monkeypatch.setattr(performing, "MAX_MATCHES", 4)
    monkeypatch.setattr(performing, "run", lambda solve: solve())
    performing.show_all(blank.context)
    assert len(listed.rows) == 4
    back = [performing.show_next_match(blank.context, -1)[:6] for _ in range(3)]
    assert back == ["6 of 6", "5 of 6", "4 of 6"]
    assert performing.show_next_match(blank.context, 1).startswith("5 of 6: ")

    shrunk = performing.show_all(blank.context, first=48, row=-1)
    assert shrunk.startswith("4 of 6: ")
    cache = load("mocap_assist.find_similar.searches")._cache.values()
    assert [each.is_ranked for each in cache].count(False) == 1


class HeldJob:
    """A job that ends once it has an outcome."""

    def __init__(self):
        self.outcome, self.is_cancelled = None, False

    def done(self):
        return self.outcome is not None

    def cancel(self):
        self.is_cancelled = True

    def tidy_up(self):
        assert self.is_cancelled

    def result(self):
        if isinstance(self.outcome, Exception):
            raise self.outcome
        return self.outcome


@pytest.fixture
def jobs(performing, monkeypatch, tmp_path):
    """Start jobs that end when they are made to; `end(*outcomes)` returns how many run."""
    polls, started = [], []

    def start(solve):
        started.append(HeldJob())
        return started[-1]

    def end(*outcomes):
        for job, outcome in zip(started, outcomes, strict=True):
            job.outcome = outcome
        polls[:] = [poll for poll in polls if poll() is not None]
        return len(polls)

    monkeypatch.setattr(performing, "in_background", lambda: False)
    monkeypatch.setattr(performing, "_library", lambda: tmp_path / "clips.library")
    monkeypatch.setattr(performing, "Job", start)
    monkeypatch.setattr(performing.timers, "register", lambda poll, **_: polls.append(poll))
    return end


def test_the_newest_command_fills_the_list_and_reports_its_end(
    performing, performance, jobs, blank, load
):
    finding = load("mocap_assist.find_similar.solve_finding").Finding((), None, 0)
    damaged = load("solvers.errors").InvalidFileError("The library is damaged.")
    listed = blank.context.window_manager.mocap_assist_matches

    assert performing.show_all(blank.context) == "Reading the library..."
    assert performing.search_with(blank.context, performance).startswith("Searching with")
    assert jobs(finding, None) == 1 and performing.new_message() == ""
    assert jobs(finding, finding) == 0
    assert listed.query == "your performance" and performing.new_message() == "No search yet."

    performing.show_all(blank.context)
    assert jobs(finding, finding, damaged) == 0
    assert (
        performing.new_message() == "The library is damaged." and performing.new_message() == ""
    )


def test_waves_while_a_page_is_read_count_from_its_first_or_last_clip(
    find, newcomer, performing, jobs, blank, load
):
    newcomer("walk")
    find()
    listed = blank.context.window_manager.mocap_assist_matches
    found = load("mocap_assist.find_similar.searches").listed_search(blank.context).finding
    page = replace(found, first=0)

    performing.show_all(blank.context)
    assert [performing.show_next_match(blank.context, step) for step in (1, 1)] == ["", ""]
    assert jobs(page) == 0 and listed.active == 2

    performing.show_all(blank.context, row=-1)
    performing.show_next_match(blank.context, -1)
    assert jobs(page, page) == 0 and listed.active == len(listed.rows) - 2

    of_two = replace(page, n_clips=2 * len(page.found))
    performing.show_all(blank.context)
    performing.show_next_match(blank.context, -1)
    performing.show_next_match(blank.context, -1)
    assert jobs(page, page, of_two) == 1
    assert jobs(page, page, of_two, of_two) == 0
    assert listed.active == len(listed.rows) - 2


def test_list_of_find_similar_stays_when_an_older_command_ends(
    find, newcomer, performing, performance, jobs, blank, load
):
    newcomer("walk")
    performing.search_with(blank.context, performance)

    find()

    listed = blank.context.window_manager.mocap_assist_matches
    names, query = [row.name for row in listed.rows], listed.query
    nothing = load("mocap_assist.find_similar.solve_finding").Finding((), None, 0)
    assert performing.show_next_match(blank.context, 1).startswith("2 of ")
    assert jobs(nothing) == 0
    assert [row.name for row in listed.rows] == names and listed.query == query
    assert performing.new_message() == performing.chosen_sentence()


def test_show_library_turns_on_the_ghost(performing, blank):
    blank.context.window_manager.mocap_assist_matches.rows.clear()
    blank.context.window_manager.mocap_assist_ghost = False

    assert "There is no library yet" in performing.show_library(blank.context)
    assert blank.context.window_manager.mocap_assist_ghost
    assert performing.show_next_match(blank.context, 1) == "No search yet."


def test_show_library_leaves_an_open_sidebar_as_it_is(performing, blank):
    class View:
        def __init__(self, is_shown):
            self.sets, self._is_shown = 0, is_shown

        @property
        def show_region_ui(self):
            return self._is_shown

        @show_region_ui.setter
        def show_region_ui(self, value):
            self.sets, self._is_shown = self.sets + 1, value

    views = View(True), View(False)
    areas = [SimpleNamespace(type="VIEW_3D", spaces=SimpleNamespace(active=v)) for v in views]
    window = SimpleNamespace(screen=SimpleNamespace(areas=areas))
    context = SimpleNamespace(window=window, scene=blank.context.scene)

    performing.show_library(context)

    assert [each.sets for each in views] == [0, 1]


def test_performance_reports_a_missing_library(performing, performance, blank, tmp_path):
    blank.context.scene.mocap_assist.library.library_file = str(tmp_path / "none")

    assert "There is no library yet" in performing.search_with(blank.context, performance)
