"""Where a file of joints does not say its unit, the size of the body shows it."""

import re
from dataclasses import replace

import numpy as np
import pytest
from kinect_walks import tracked_walk, true_positions

import solvers.motion as motion_module
from solvers import samples
from solvers.errors import MocapAssistError
from solvers.motion import JointRecording, Sensor, Tracks
from solvers.motion.humanoid import posture_joints
from solvers.recordings import read_recording, write_joint_csv
from solvers.recordings.conventions import JointSamples, stature, unit_of_skeleton
from solvers.recordings.conventions.body_unit import convert_to_body_unit
from solvers.recordings.conventions.tracked_joints import joint_recording
from solvers.recordings.conventions.unit_estimate import estimate_unit

WORDS = {1.0: "meters", 0.01: "centimeters", 0.001: "millimeters"}
ALL_WORDS = WORDS | {0.0254: "inches", 0.3048: "feet"}


class KeptMessages:
    """A Progress that keeps its messages."""

    def __init__(self):
        self.messages = []

    def __call__(self, fraction, message=""):
        self.messages.append(message)

    @property
    def units(self):
        return [word for word in self.messages if "Lengths" in word]


@pytest.fixture(scope="module")
def walk():
    return tracked_walk(motion_module, true_positions(samples, posture_joints))


@pytest.mark.parametrize("default", WORDS)
@pytest.mark.parametrize("true", ALL_WORDS)
def test_body_has_human_size_for_any_default_unit(walk, default, true):
    messages = KeptMessages()

    found = joint_recording(
        "take",
        JointSamples(walk.names, walk.tracks.positions / true, Sensor.KINECT_V1),
        scale=None,
        default_unit=default,
        progress=messages,
    )

    assert np.allclose(found.tracks.positions, walk.tracks.positions)
    if true == default:
        assert not messages.units
    else:
        (output,) = messages.units
        assert f"interpreted as {ALL_WORDS[true]}," in output and "give the unit" in output


@pytest.mark.parametrize("size", [0.4, 2.5])
def test_a_child_or_a_giant_stays_what_it_is(walk, size):
    messages = KeptMessages()
    other = walk.with_tracks(walk.tracks.with_positions(size * walk.tracks.positions))

    assert convert_to_body_unit(other, 1.0, messages) is other
    assert not messages.units


@pytest.mark.parametrize("height", [0.84, 1.0, 1.75, 3.5, 4.0])
def test_children_and_giants_stay_what_they_are(height):
    """Inches would make adults of children, a unit of its own of giants."""
    assert estimate_unit(height / 1.75 / 0.01).unit == 0.01


@pytest.mark.parametrize("unit", [0.08, 0.04, 0.15])
def test_rigs_of_another_scale_get_the_size_of_an_adult(unit):
    """One unit of MikuMikuDance has 8 cm; before, such a body was a child in Acclaim's unit."""
    assert estimate_unit(1.0 / unit).unit == pytest.approx(unit)


@pytest.mark.parametrize("unit", ALL_WORDS)
@pytest.mark.parametrize("height", [1.5, 1.6, 1.75, 1.9, 2.0])
def test_the_unit_of_an_adult_is_recognized(height, unit):
    size = height / 1.75 / unit

    assert estimate_unit(size).unit * size == pytest.approx(height / 1.75, rel=0.15)
    assert estimate_unit(size, is_body=False).unit == unit


def test_who_gives_the_unit_is_obeyed(walk):
    messages, positions = KeptMessages(), 1000.0 * walk.tracks.positions

    found = joint_recording(
        "take",
        JointSamples(walk.names, positions, Sensor.KINECT_V1),
        scale=1.0,
        progress=messages,
    )

    assert np.allclose(found.tracks.positions, positions)
    assert not messages.units


@pytest.mark.parametrize("names", [("A", "B", "C"), ("Head", "ElbowLeft", "WristLeft")])
def test_what_is_no_body_keeps_its_unit(names):
    points = Tracks(names, 1000.0 * np.random.default_rng(0).random((4, 3, 3)), 30.0)
    recording = JointRecording(points, None, Sensor.OTHER)

    assert convert_to_body_unit(recording, 1.0, KeptMessages()) is recording


def test_joints_at_one_position_have_no_size(walk):
    flat = walk.with_tracks(walk.tracks.with_positions(np.ones_like(walk.tracks.positions)))

    assert convert_to_body_unit(flat, 1.0, KeptMessages()) is flat


def test_no_unit_makes_a_man_of_an_ant(walk):
    """The nearest unit makes a mouse of it, and is reported."""
    messages = KeptMessages()
    ant = walk.with_tracks(walk.tracks.with_positions(0.002 * walk.tracks.positions / 100.0))

    assert stature(convert_to_body_unit(ant, 0.001, messages)) < 0.05
    assert len(messages.units) == 1


@pytest.mark.parametrize(
    ("size", "unit"),
    [
        (0.13, 1.0), (0.08, 1.0), (0.1, 1.0), (0.01, 1.0), (1e-4, 1.0), (1e4, 0.001),
        (1e6, 0.001), (5.0, 0.1),
    ],
)  # fmt: skip
def test_the_nearest_unit_is_that_of_what_has_no_typical_size(size, unit):
    """A hand in meters is not one of 2 mm, nor 100 times a person 180 m tall."""
    assert estimate_unit(size, is_body=False).unit == unit


@pytest.mark.parametrize("scale", [1.0, 0.2])
def test_a_stated_unit_yields_to_a_body_alone_and_that_is_reported(scale):
    messages, person = KeptMessages(), samples.walking_gait().skeleton
    unit = 0.0254 / 0.45
    person = replace(person, offsets=scale / unit * person.offsets)
    n_joints = person.n_joints
    names = tuple(f"knot{number}" for number in range(n_joints))
    rope = replace(person, names=names, parents=(-1, *range(n_joints - 1)))

    assert unit_of_skeleton(rope, messages, stated=unit) == unit
    assert not messages.units
    assert unit_of_skeleton(person, messages, stated=unit) == pytest.approx(
        unit / scale, rel=0.15
    )
    assert len(messages.units) == (scale != 1.0)


@pytest.mark.parametrize("of_cmu", [True, False])
def test_only_skeletons_of_cmu_are_in_the_unit_of_acclaim(of_cmu):
    """Half a person in inches is as large as an adult in Acclaim's unit."""
    messages, person = KeptMessages(), samples.walking_gait().skeleton
    names = ("LHipJoint", *person.names[1:]) if of_cmu else person.names
    small = replace(person, names=names, offsets=0.5 / 0.0254 * person.offsets)

    unit = unit_of_skeleton(small, messages)

    assert (unit == 0.0254 / 0.45) == of_cmu
    assert any("may be inches" in message for message in messages.units) == (not of_cmu)


def test_our_own_table_counts_by_its_word_and_is_guessed_without(walk, tmp_path):
    larger = walk.with_tracks(walk.tracks.with_positions(1000.0 * walk.tracks.positions))
    output, silent = tmp_path / "said.csv", tmp_path / "silent.csv"
    write_joint_csv(larger, output)
    text = output.read_text()
    assert "units=m," in text
    silent.write_text(text.replace("units=m,", "", 1))
    messages = KeptMessages()

    by_word, guessed = read_recording(output), read_recording(silent, progress=messages)
    given = read_recording(silent, scale=0.01)

    assert np.allclose(by_word.tracks.positions, larger.tracks.positions, atol=1e-3)
    assert np.allclose(guessed.tracks.positions, walk.tracks.positions, atol=1e-3)
    assert np.allclose(given.tracks.positions, 0.01 * larger.tracks.positions, atol=1e-3)
    assert len(messages.units) == 1


def test_a_kinect_file_in_millimeters_is_the_same_take(recordings, tmp_path):
    path = recordings / "kinect" / "irds" / "215_18_5_8_1_stand.txt"
    true, messages = read_recording(path), KeptMessages()

    def thousandfold(position):
        return position[1] + ",".join(
            f"{1000.0 * float(word):.5f}" for word in position.groups()[1:]
        )

    number = "(-?[0-9.e-]+)"
    text = path.read_text()
    larger = re.sub(rf"(\(\w+,\w+,){number},{number},{number}", thousandfold, text)
    assert larger != text
    (tmp_path / "mm.txt").write_text(larger)

    found = read_recording(tmp_path / "mm.txt", progress=messages)

    assert np.allclose(found.tracks.positions, true.tracks.positions, atol=1e-5, equal_nan=True)
    assert len(messages.units) == 1


def test_no_stated_unit_of_our_recordings_is_estimated_again(recordings):
    """A guess is for files in a unit that is not their format's; these all are in it."""
    paths = sorted((recordings / "kinect").glob("*/*"))
    for path in [each for each in paths if each.is_file()][::9]:
        messages = KeptMessages()
        try:
            read_recording(path, progress=messages)
        except MocapAssistError:  # no recording
            continue
        assert not messages.units, path
