"""Identify marker sets and their landmarks by names."""

import pytest

from solvers.markers import find_marker_set
from solvers.markers.marker_sets import SETS
from solvers.recordings.joint_files.ui_prmd import MARKERS


@pytest.mark.parametrize("title", SETS)
def test_find_marker_set_identifies_each_complete_set(title):
    found = find_marker_set(list(SETS[title]))

    assert (found.name, found.score, found.missing_landmarks()) == (title, 1.0, ())


def test_sets_have_their_documented_sizes():
    assert len(SETS["CMU 41"]) == 41
    assert set(SETS["Plug-in-Gait"]) == set(MARKERS)


def test_case_and_prefixes_are_ignored():
    names = ["anna:lfwt", "anna:RFWT", "ANNA_LBWT", "anna.rbwt", "LKNE"]

    found = find_marker_set(names)

    assert found.markers["LASI"] == "anna:lfwt"
    assert found.name == "CMU 41"


def test_subject_with_more_markers_is_the_default():
    names = ["Ben:LASI", "Ben:RASI"] + [f"Anna:{name}" for name in MARKERS]

    assert find_marker_set(names).markers["LASI"] == "Anna:LASI"
    assert find_marker_set(names, "ben").markers == {"LASI": "Ben:LASI", "RASI": "Ben:RASI"}


def test_missing_landmarks_are_listed():
    names = [name for name in MARKERS if name not in {"RKNE", "LPSI"}]

    assert find_marker_set(names).missing_landmarks() == ("RKNE", "LPSI and RPSI, or SACR")


@pytest.mark.parametrize("names", [[], ["point_1"], ["Hips", ""], ["  "]])
def test_unknown_names_match_no_set(names):
    found = find_marker_set(names)

    assert found.score == 0.0 and not found.markers and len(found.missing_landmarks()) > 5
