"""Pictures of depth in one file: archives of NumPy's, MATLAB's, and raw frames."""

import pickle
import struct

import numpy as np
import pytest
from depth_files import depth_npz, matlab, pictures
from numpy.testing import assert_allclose, assert_array_equal
from scipy import io

from solvers.depth_scene.camera import Camera
from solvers.errors import InvalidFileError, InvalidSettingError
from solvers.recordings import (
    CameraOrientation,
    DepthSettings,
    is_depth_recording,
    read_depth,
    read_recording,
    read_tracked,
)

SMALL = Camera(9.0, 8.0, 3.5, 2.5, 8, 6)
LENS = DepthSettings(fx=9.0, fy=8.0)


@pytest.fixture
def write(make_writer):
    return make_writer("take.depth")


def all_frames(recording) -> np.ndarray:
    return np.stack([recording.frame(frame) for frame in range(recording.n_frames)])


@pytest.mark.parametrize("take", ["walk_front", "hop"])
def test_rendered_archives_hold_the_millimeters_that_numpy_finds(recordings, take):
    path = recordings / "depth" / "truth" / f"{take}.npz"
    with np.load(path) as archive:
        depth, focal = archive["depth"], archive["fx"]

    recording = read_recording(path)

    assert recording.n_frames == len(depth)
    assert recording.camera.fx == focal
    assert_allclose(all_frames(recording), depth * 0.001, rtol=1e-6)


@pytest.mark.parametrize("take", ["a1_s1_t1", "a22_s7_t1"])
def test_utd_mhad_equals_the_transposed_array_of_scipy(recordings, take):
    path = recordings / "depth" / "utd_mhad" / f"{take}_depth.mat"
    depth = io.loadmat(path)["d_depth"]

    recording = read_recording(path)

    assert recording.n_frames == depth.shape[2]
    assert_allclose(
        all_frames(recording), depth.transpose(2, 0, 1)[..., ::-1] * 0.001, rtol=1e-6
    )


def test_in_utd_mhad_the_joints_of_the_sdk_lie_on_the_actor(recordings):
    """Its x points to the camera's left and its y up; depth[t] fits skeleton[t - 2]."""
    folder = recordings / "depth" / "utd_mhad"
    recording = read_depth(folder / "a3_s3_t1_depth.mat")
    joints = io.loadmat(folder / "a3_s3_t1_skeleton.mat")["d_skel"].transpose(2, 0, 1)
    joints = joints[:, [2, 3, 4]] * (-1.0, -1.0, 1.0)  # spine, hips, left shoulder

    for frame in range(10, recording.n_frames, 10):
        column, row = recording.camera.project(joints[frame - 2]).round().astype(int).T
        seen = recording.frame(frame)[row, column]
        assert_allclose(seen, joints[frame - 2, :, 2], atol=0.2)


def test_in_utd_mhad_the_right_arm_is_at_the_left_of_the_picture(recordings):
    """The actor faces the camera and waves with the right hand (action 3)."""
    recording = read_depth(recordings / "depth" / "utd_mhad" / "a3_s1_t1_depth.mat")

    seen = all_frames(recording) > 0
    moving = seen.mean(axis=0) * (1.0 - seen.mean(axis=0))

    middle = np.average(np.arange(320), weights=seen.sum(axis=(0, 1)))
    assert np.average(np.arange(320), weights=moving.sum(axis=0)) < middle - 10.0


@pytest.mark.parametrize("packed", [True, False])
@pytest.mark.parametrize("kind", ["npz", "mat", "mat of a Mac"])
def test_frames_come_out_in_any_order(write, packed, kind):
    depth = pictures(40)
    order = ">" if "Mac" in kind else "<"
    in_rows = depth.transpose(1, 2, 0)
    content = (
        depth_npz(depth, packed) if kind == "npz" else matlab("d_depth", in_rows, packed, order)
    )

    recording = read_depth(write(content), LENS)

    for frame in [39, 0, 17, 18, 3, 38, 17]:
        assert_allclose(recording.frame(frame), depth[frame] * 0.001, rtol=1e-6)


def test_a_long_archive_is_read_from_the_marks_in_it(write, rng):
    """Twelve megabytes, of which the last picture is asked for first."""
    depth = rng.integers(0, 5000, (40, 300, 500)).astype(np.uint16)
    recording = read_depth(write(depth_npz(depth)))

    for frame in [39, 20, 21, 5, 38]:
        assert_allclose(recording.frame(frame), depth[frame] * 0.001, rtol=1e-6)


def test_a_recording_can_be_sent_to_another_process(write):
    depth = pictures()
    recording = read_depth(write(depth_npz(depth)))
    recording.frame(2)

    sent = pickle.dumps(recording)

    assert len(sent) < 2000
    assert_array_equal(pickle.loads(sent).frame(4), recording.frame(4))


def test_archive_defines_camera_rate_and_color(write, rng):
    color = rng.integers(0, 255, (5, 6, 8, 3)).astype(np.uint8)
    path = write(depth_npz(pictures(), color=color))

    recording = read_depth(path)

    assert recording.camera == SMALL
    assert recording.frame_rate == 25.0
    assert_array_equal(recording.color(3), color[3])
    messages = read_depth(path, DepthSettings(fx=5.0, cx=4.0, frame_rate=12.0, scale=0.01))
    assert (messages.camera, messages.frame_rate) == (Camera(5.0, 5.0, 4.0, 2.5, 8, 6), 12.0)
    assert_allclose(messages.frame(1), 10.0 * recording.frame(1), rtol=1e-6)


def test_arrays_may_come_in_any_order(tmp_path):
    """`frame_rate` is a name of SMPL's archives too."""
    lens = {"fx": 9.0, "fy": 8.0, "cx": 3.5, "cy": 2.5}
    np.savez(tmp_path / "take.npz", frame_rate=25.0, **lens, depth=pictures())

    recording = read_recording(tmp_path / "take.npz")

    assert (recording.n_frames, recording.frame_rate) == (len(pictures()), 25.0)


def test_numbers_with_a_point_are_meters(write):
    depth = pictures().astype(np.float32) / 1000
    depth[2, 3] = np.nan

    frame = read_depth(write(depth_npz(depth))).frame(2)

    assert_allclose(frame, np.nan_to_num(depth[2]))


def overwritten(content: bytes) -> bytes:
    middle = len(content) // 2
    return content[:middle] + b"\xff" * 50 + content[middle + 50 :]


RAW = pictures(1, 480, 640).tobytes()


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (depth_npz(pictures())[:-40], "cut short or of another kind"),
        (overwritten(depth_npz(pictures(400))), "damaged, cut short or of another kind"),
        (depth_npz(pictures()[0]), r"shape \(6, 8\); it must be \(frames, rows, columns\)"),
        (depth_npz(pictures()[:0]), "shape"),
        (depth_npz(pictures(3, 6, 5000)), "5000 x 6 pixels, which no depth camera makes"),
        (depth_npz(pictures(), fx=-1.0), "Give positive focal lengths"),
        (depth_npz(pictures(), fx=[1.0, 2.0]), "fx is not a single number"),
        (depth_npz(pictures(), frame_rate=0.0), "frame rate of 0 Hz"),
        (depth_npz(pictures(), color=pictures()), "of uint16; for this depth it must be"),
        (depth_npz(pictures().astype("U5")), "no readable array called depth"),
        (matlab("d_depth", pictures().transpose(1, 2, 0)), "8 x 6 pixels and does not state"),
        (matlab("d_depth", pictures().transpose(1, 2, 0))[:-9], "cut short"),
        (overwritten(matlab("depth", pictures(400).transpose(1, 2, 0))), "damaged MAT"),
        (matlab("d_skel", pictures()), "no depth of a known format"),
        (b"nothing of the kind", "no depth of a known format"),
        (b"", "no depth of a known format"),
        (b"\0" * 614400, "no depth of a known format"),
        (np.random.default_rng(1).bytes(614400), "no depth of a known format"),
        (RAW, "no depth of a known format"),  # white noise, though of a Kinect's size
    ],
)  # fmt: skip
def test_other_content_than_depth_is_refused(write, content, sentence):
    with pytest.raises(InvalidFileError, match=sentence):
        read_depth(write(content))


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("size", [0, 1, 3])
def test_a_matlab_file_is_damaged_when_its_flags_are_too_short(write, order, size):
    complete = matlab("d_depth", pictures().transpose(1, 2, 0), packed=False, order=order)
    flags = struct.pack(f"{order}II", 6, 8)
    path = write(complete.replace(flags, struct.pack(f"{order}II", 6, size), 1))

    assert is_depth_recording(path)
    with pytest.raises(InvalidFileError, match=r"take\.depth is a damaged MATLAB file"):
        read_depth(path)


def test_a_frame_behind_a_cut_is_refused_and_those_before_are_not(write, monkeypatch):
    """As in long files, which are not looked through before the first picture."""
    monkeypatch.setattr("solvers.recordings.containers.stored_bytes.MAX_CHECKED_BYTES", 0)
    content = matlab("depth", pictures(400).transpose(1, 2, 0))
    middle = len(content) // 2
    cut = content[:132] + struct.pack("<I", middle - 136) + content[136:middle]
    recording = read_depth(write(cut), LENS)

    assert recording.frame(0).max() > 0.0
    with pytest.raises(InvalidFileError, match=r"is (damaged|cut short)"):
        all_frames(recording)


def test_a_file_that_was_removed_meanwhile_is_named(write):
    path = write(depth_npz(pictures()))
    recording = read_depth(path)
    path.unlink()

    with pytest.raises(InvalidFileError, match=r"take\.depth cannot be read"):
        recording.frame(0)
    with pytest.raises(InvalidFileError, match="There is no file"):
        read_depth(path)


@pytest.mark.parametrize("scale", [0.0, -1.0, float("nan")])
def test_a_scale_is_above_zero(write, scale):
    with pytest.raises(InvalidSettingError, match="it must be above 0"):
        read_recording(write(depth_npz(pictures())), scale=scale)


def test_reading_joints_from_depth_reports_what_to_do(write):
    with pytest.raises(InvalidFileError, match="Track the actor in it first"):
        read_tracked(write(depth_npz(pictures())))


@pytest.mark.parametrize(
    "held", [CameraOrientation.LEFT, CameraOrientation.RIGHT, CameraOrientation.UPSIDE_DOWN]
)
@pytest.mark.parametrize("mirrored", [False, True])
def test_a_camera_that_was_held_otherwise_sees_the_same_points(write, held, mirrored):
    """Turned about the axis of the camera, and their left and right swapped."""
    path = write(depth_npz(pictures(), cx=2.0, cy=3.0))
    seen, rotated = (
        read_depth(path),
        read_depth(path, DepthSettings(held=held, mirrored=mirrored)),
    )

    points = [
        each.camera.back_project(each.frame(3)).reshape(-1, 3) for each in (seen, rotated)
    ]

    x, y, z = (points[0] * (-1.0 if mirrored else 1.0, 1.0, 1.0)).T
    expected = {
        CameraOrientation.LEFT: (-y, x, z),  # What was at the left, -x, is now above, -y.
        CameraOrientation.RIGHT: (y, -x, z),
        CameraOrientation.UPSIDE_DOWN: (-x, -y, z),
    }[held]
    assert_allclose(in_one_order(np.stack(expected, axis=-1)), in_one_order(points[1]))


def in_one_order(points: np.ndarray) -> np.ndarray:
    points = points[points[:, 2] > 0.0]
    return points[np.lexsort(points.round(9).T)]
