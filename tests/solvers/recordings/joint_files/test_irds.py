"""IRDS text: what the camera saw, upright, with gaps where it did not."""

import re

import numpy as np
import pytest
from joint_files import read_with
from numpy.testing import assert_allclose

from solvers.errors import InvalidFileError
from solvers.motion import SENSOR_JOINTS, JointRecording, Sensor
from solvers.recordings import read_recording
from solvers.recordings.joint_files import open_irds

NAMES = SENSOR_JOINTS[Sensor.KINECT_V2]


def irds(frames: list[tuple[int, int, dict[str, tuple[str, float, float, float]]]]) -> str:
    """Write (body, milliseconds, joints); what is not given stands at (0.5, 1, 2)."""
    lines = ["Version0.1"]
    for count, (body, time, joints) in enumerate(frames):
        texts = []
        for name in NAMES:
            state, *position = joints.get(name, ("Tracked", 0.5, 1.0, 2.0))
            texts.append(
                f"({name},{state},{position[0]},{position[1]},{position[2]},191.7,205.5)"
            )
        lines.append(f"{count},{body},{time}," + ",".join(texts))
    return "\r\n".join(lines)


@pytest.fixture
def read(tmp_path):
    def read_text(text: str, **options):
        (tmp_path / "take.txt").write_text(text, newline="")
        return read_with(open_irds)(tmp_path / "take.txt", **options)

    return read_text


def test_joints_come_out_upright_and_on_their_side(read):
    """To the camera's left, up, and away from it: -X, +Z and +Y."""
    recording = read(
        irds([(5, 33 * n, {"Head": ("Inferred", -0.25, 0.75, 3)}) for n in range(4)])
    )

    head = NAMES.index("Head")
    assert_allclose(recording.tracks.positions[0, head], (0.25, 3, 0.75))
    assert recording.tracking_state[0, head] == 1
    assert recording.tracks.names == NAMES
    assert recording.sensor is Sensor.KINECT_V2
    assert recording.frame_rate == 30.0


def test_what_was_not_tracked_is_nan(read):
    missing = {"Head": ("NotTracked", 1, 1, 1), "Neck": ("Tracked", 0, 0, 0)}

    recording = read(irds([(1, 33 * n, missing if n == 2 else {}) for n in range(5)]))

    indices = [NAMES.index(name) for name in missing]
    assert np.isnan(recording.tracks.positions[2, indices]).all()
    assert (recording.tracking_state[2, indices] == 0).all()
    assert recording.tracks.visible.sum() == recording.tracks.visible.size - 2


def test_missing_frame_is_a_gap(read):
    recording = read(irds([(1, time, {}) for time in (0, 33, 67, 167, 200)]))

    assert recording.tracks.visible[:, 0].tolist() == [True] * 3 + [False] * 2 + [True] * 2


def test_longest_observed_body_is_selected(read):
    other = {"Head": ("Tracked", 9, 9, 9)}

    recording = read(irds([(body, 33 * n, other if body == 2 else {}) for n, body in
                           enumerate([1, 1, 2, 1, 1, 2, 1])]))  # fmt: skip

    assert np.nanmax(recording.tracks.positions) < 3
    assert recording.n_frames == 7


def test_scale_multiplies_positions(read):
    text = irds([(1, 33 * n, {}) for n in range(3)])

    assert_allclose(read(text, scale=2.0).tracks.positions, 2 * read(text).tracks.positions)


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (lambda text: text[:-500], r"take\.txt, line 5: .* 25 joints are required"),
        (lambda text: text.replace("0.5", "O.5"), r"line 2: 'O\.5' is not a number"),
        (
            lambda text: text.replace("Head", "Heed", 1),
            "line 2: 'Heed,Tracked.* not a joint",
        ),
        (lambda text: text.replace("Tracked", "NotTracked"), "no joint that is observed"),
        (lambda text: text + "\r\nand so on", "line 6: there are no joints"),
        (lambda text: "Version0.1", "not an IRDS recording"),
        (lambda text: re.sub("^1,1,33,", "1,1,", text, flags=re.M), "line 3: number, body"),
    ],
)
def test_damage_is_named(read, spoil, sentence):
    with pytest.raises(InvalidFileError, match=sentence):
        read(spoil(irds([(1, 33 * n, {}) for n in range(4)])))


def test_real_takes_agree_with_a_naive_reader(recordings):
    """Where a frame's stamp lies on the grid, it is there as it stands in the file."""
    for path in sorted((recordings / "kinect" / "irds").iterdir()):
        recording = read_recording(path)
        assert isinstance(recording, JointRecording)
        triples = re.findall(r"\(SpineBase,\w+,([^,]+),([^,]+),([^,]+)", path.read_text())
        x, y, z = np.array(triples, dtype=float)[0]
        assert_allclose(recording.tracks.positions[0, 0], (-x, z, y))
        feet, head = (NAMES.index(name) for name in ("FootLeft", "Head"))
        height = recording.tracks.positions[:, head] - recording.tracks.positions[:, feet]
        assert 0.8 < np.nanmedian(height[:, 2]) < 1.9
        left, right = (NAMES.index(name) for name in ("HipLeft", "HipRight"))
        assert np.nanmedian(np.diff(recording.tracks.positions[:, [right, left], 0])) > 0.05
