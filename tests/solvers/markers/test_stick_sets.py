"""Sticks between markers of sets that no skeleton is solved from."""

import pytest

from solvers.markers import find_marker_sticks
from solvers.markers.stick_sets import STICK_SETS, chains_of
from solvers.recordings import read_recording


def _words(text):
    return text.split()


MOTIVE = [
    "HeadTop",
    "HeadFront",
    "HeadSide",
    "BackTop",
    "BackLeft",
    "BackRight",
    "Chest",
    "LShoulderTop",
    "LShoulderBack",
    "LUArmHigh",
    "LElbowOut",
    "LWristOut",
    "LWristIn",
    "LHandOut",
    "RShoulderTop",
    "RShoulderBack",
    "RUArmHigh",
    "RElbowOut",
    "RWristOut",
    "RWristIn",
    "RHandOut",
    "WaistLFront",
    "WaistLBack",
    "WaistRBack",
    "WaistRFront",
    "LThigh",
    "LKneeOut",
    "LShin",
    "LAnkleOut",
    "LHeel",
    "LToeIn",
    "LToeTip",
    "LToeOut",
    "RThigh",
    "RKneeOut",
    "RShin",
    "RAnkleOut",
    "RHeel",
    "RToeIn",
    "RToeTip",
    "RToeOut",
]
QUALISYS = [
    "HeadTop",
    "HeadFront",
    "HeadL",
    "HeadR",
    "SpineTop",
    "Chest",
    "BackL",
    "BackR",
    "WaistLFront",
    "WaistLBack",
    "WaistRFront",
    "WaistRBack",
    "LShoulderTop",
    "LShoulderBack",
    "LArm",
    "LElbowOut",
    "LWristIn",
    "LWristOut",
    "LHandIn",
    "LHandOut",
    "RShoulderTop",
    "RShoulderBack",
    "RArm",
    "RElbowOut",
    "RWristIn",
    "RWristOut",
    "RHandIn",
    "RHandOut",
    "LThigh",
    "LKneeOut",
    "LShin",
    "LAnkleOut",
    "LHeelBack",
    "LForefootIn",
    "LForefootOut",
    "LToeTip",
    "RThigh",
    "RKneeOut",
    "RShin",
    "RAnkleOut",
    "RHeelBack",
    "RForefootIn",
    "RForefootOut",
    "RToeTip",
]
HELEN_HAYES = [
    "Top.Head",
    "Front.Head",
    "Rear.Head",
    "Offset",
    "R.Shoulder",
    "R.Elbow",
    "R.Wrist",
    "L.Shoulder",
    "L.Elbow",
    "L.Wrist",
    "R.ASIS",
    "L.ASIS",
    "V.Sacral",
    "R.Thigh",
    "R.Knee",
    "R.Shank",
    "R.Ankle",
    "R.Heel",
    "R.Toe",
    "L.Thigh",
    "L.Knee",
    "L.Shank",
    "L.Ankle",
    "L.Heel",
    "L.Toe",
]
DAVIS = ["c7", "sacrum"] + [
    f"{side} {label}"
    for side in "rl"
    for label in ("should", "asis", "thigh", "bar 1", "knee 1", "bar 2", "mall", "met")
]
SETS = {"Motive": MOTIVE, "Qualisys": QUALISYS, "Helen Hayes": HELEN_HAYES, "Davis": DAVIS}


@pytest.mark.parametrize("prefix", ["", "Anna:", "Q_"])
@pytest.mark.parametrize("names", SETS.values(), ids=SETS)
def test_sticks_connect_every_marker_in_one_body(names, prefix):
    pairs = find_marker_sticks([prefix + name for name in names])

    assert len(set(pairs)) == len(pairs)
    assert all(one < other for one, other in pairs)
    assert reached_from_the_first(pairs) == set(range(len(names)))


@pytest.mark.parametrize("names", [MOTIVE, QUALISYS], ids=["Motive", "Qualisys"])
def test_no_stick_joins_left_and_right_limbs(names):
    ends = [(names[one], names[other]) for one, other in find_marker_sticks(names)]

    assert not any({one[:1], other[:1]} == {"L", "R"} for one, other in ends)


def test_two_actors_are_not_connected():
    names = [f"{who}_{name}" for who in ("Anna", "Ben") for name in MOTIVE]

    pairs = find_marker_sticks(names)

    assert len(pairs) == 2 * len(find_marker_sticks(MOTIVE))
    assert all((one < len(MOTIVE)) == (other < len(MOTIVE)) for one, other in pairs)


def test_a_few_common_words_are_no_set():
    assert find_marker_sticks(["LKnee", "RKnee", "Chest", "LThigh", "Offset"]) == ()


@pytest.mark.parametrize("title", STICK_SETS)
def test_sides_have_the_same_chains(title):
    chains = set(chains_of(title))
    with_side = {chain for chain in chains if all(label[:1] in "LR" for label in chain)}

    assert {tuple(swap(label) for label in chain) for chain in with_side} >= {
        chain for chain in with_side if chain[0][0] == "R" and chain[-1][0] == "R"
    }


@pytest.mark.parametrize(
    ("file", "min_sticks"),
    [
        ("formats/trc/leg39_swing.trc", 40),
        ("formats/trc/static_walk_1.trc", 25),
        ("corpus/lab/c3d_bts/BTS.c3d", 15),
    ],
)
def test_recorded_sets_have_sticks(file, min_sticks, recordings):
    recording = read_recording(recordings / file)

    assert len(find_marker_sticks(recording.names)) >= min_sticks


def swap(label):
    return {"L": "R", "R": "L"}[label[0]] + label[1:]


def reached_from_the_first(pairs):
    reached, edge = {0}, {0}
    while edge:
        touched = {index for pair in pairs if set(pair) & edge for index in pair}
        edge = touched - reached
        reached |= touched
    return reached
