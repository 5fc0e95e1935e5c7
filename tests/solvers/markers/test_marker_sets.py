"""Which marker sits where, from names alone."""

import pytest

from solvers.markers import find_marker_set
from solvers.markers.marker_sets import SETS
from solvers.recordings.joint_files.ui_prmd import MARKERS


@pytest.mark.parametrize("title", SETS)
def test_finds_each_set_whole(title):
    found = find_marker_set(list(SETS[title]))

    assert (found.name, found.score, found.lacks()) == (title, 1.0, ())


def test_the_sets_are_as_large_as_they_are_said_to_be():
    assert len(SETS["CMU 41"]) == 41
    assert set(SETS["Plug-in-Gait"]) == set(MARKERS)


def test_case_and_prefixes_do_not_count():
    names = ["anna:lfwt", "anna:RFWT", "ANNA_LBWT", "anna.rbwt", "LKNE"]

    found = find_marker_set(names)

    assert found.markers["LASI"] == "anna:lfwt"
    assert found.name == "CMU 41"


def test_of_two_people_the_one_with_more_markers_wins_unless_the_other_is_named():
    names = ["Ben:LASI", "Ben:RASI"] + [f"Anna:{name}" for name in MARKERS]

    assert find_marker_set(names).markers["LASI"] == "Anna:LASI"
    assert find_marker_set(names, "ben").markers == {"LASI": "Ben:LASI", "RASI": "Ben:RASI"}


def test_says_what_a_body_cannot_do_without():
    names = [name for name in MARKERS if name not in {"RKNE", "LPSI"}]

    assert find_marker_set(names).lacks() == ("RKNE", "LPSI and RPSI, or SACR")


@pytest.mark.parametrize("names", [[], ["point_1"], ["Hips", ""], ["  "]])
def test_unknown_names_are_no_set(names):
    found = find_marker_set(names)

    assert found.score == 0.0 and not found.markers and len(found.lacks()) > 5
