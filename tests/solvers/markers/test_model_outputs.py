"""Points that a model computed, and sticks between markers of known sets."""

import pytest

from solvers.markers import find_marker_sticks, find_model_outputs
from solvers.markers.marker_sets import SETS
from solvers.recordings import read_recording

# Vicon Plug-in Gait Reference Guide: segment, then origin and three axes.
PELVIS = ["PELO", "PELA", "PELL", "PELP"]


@pytest.mark.parametrize("prefix", ["", "Anna:", "trial 3 "])
def test_segments_of_plug_in_gait_are_computed(prefix):
    names = ["LASI", *PELVIS, "RTOE", "LTOO", "LTOA", "LTOL", "LTOP", "CentreOfMassFloor"]

    found = find_model_outputs([prefix + name for name in names])

    assert [names[index] for index in found] == [
        name for name in names if name not in {"LASI", "RTOE"}
    ]


@pytest.mark.parametrize("names", SETS.values(), ids=SETS)
def test_no_marker_of_a_known_set_is_computed(names):
    assert find_model_outputs([*names, "LCLA", "RCLA", "*0", "Head1", "WRIST"]) == ()


@pytest.mark.parametrize(
    "name", ["LHipAngles", "RKneeMoment", "LAnkleForce", "RHipPower", "V_Mid_ASIS", "L_HJC"]
)
def test_results_of_models_are_computed(name):
    assert find_model_outputs(["LASI", name]) == (1,)


@pytest.mark.parametrize(
    ("file", "n_computed", "markers"),
    [
        ("PiG_Motion-FlatFoot-Hole.c3d", 78, {"LTOE", "LASI", "CLAV"}),
        ("PlugInC3D.c3d", 36, {"RCLA", "LCLA", "LTOE", "LASI", "SACR"}),
    ],
)
def test_recorded_takes_keep_their_markers(file, n_computed, markers, recordings):
    names = read_recording(recordings / "formats" / "c3d" / file).names

    computed = {names[index] for index in find_model_outputs(names)}

    assert len(computed) == n_computed
    assert markers <= {*names} - computed


@pytest.mark.parametrize("prefix", ["", "Anna:"])
@pytest.mark.parametrize("title", SETS)
def test_sticks_connect_every_known_marker_in_one_body(title, prefix):
    names = [prefix + name for name in SETS[title]]

    pairs = find_marker_sticks(names)

    assert len(set(pairs)) == len(pairs)
    assert all(one < other for one, other in pairs)
    reached, edge = {0}, {0}
    while edge:
        touched = {index for pair in pairs if set(pair) & edge for index in pair}
        edge = touched - reached
        reached |= touched
    assert reached == set(range(len(names)))


def test_sticks_of_left_and_right_are_the_same():
    names = list(SETS["Plug-in-Gait"])
    pairs = {frozenset((names[one], names[other])) for one, other in find_marker_sticks(names)}

    def swap(name):
        return {"L": "R", "R": "L"}[name[0]] + name[1:] if name[:1] in "LR" else name

    without = {pair for pair in pairs if "RBAK" not in pair}
    assert {frozenset(map(swap, pair)) for pair in without} == without


def test_sticks_pass_over_missing_markers():
    assert find_marker_sticks(["LSHO", "LELB"]) == ((0, 1),)
    assert find_marker_sticks(["LSHO", "LUPA", "LELB"]) == ((0, 1), (1, 2))


def test_sticks_stay_within_each_subject():
    names = [f"{who}:{name}" for who in ("Anna", "Ben") for name in ("LASI", "RASI", "LKNE")]

    pairs = find_marker_sticks(names)

    assert pairs == ((0, 1), (0, 2), (3, 4), (3, 5))


def test_unknown_sets_have_no_sticks():
    assert find_marker_sticks(["point_1", "M1", "*2", ""]) == ()
