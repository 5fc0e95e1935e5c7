"""`capture`: from pictures of depth to a file of motion."""

import json
import shutil

import numpy as np
import pytest
from depth_folders import open3d, save_png
from drawn_bodies import CAMERA, NATURAL, drawn, waving

from solvers.depth_tracking.body.model import default_body, load_body_model
from solvers.depth_tracking.body.ray_capsules import cast_rays
from solvers.depth_tracking.body.segment_kinematics import segment_frames
from solvers.depth_tracking.several_cameras.transfer_poses import transfer_poses
from solvers.recordings import read_bvh, read_recording

FAST_OPTIONS = ("--no-backward", "--no-refine", "--no-feet", "--check-every", "1000")


@pytest.fixture(scope="module")
def take(tmp_path_factory):
    """Four frames of our own body, standing three meters away."""
    body = default_body()
    depth = cast_rays(body, segment_frames(body, NATURAL), CAMERA).depth_image()
    path = tmp_path_factory.mktemp("depth") / "standing.npz"
    pictures = np.repeat(np.round(1000 * depth)[None], 4, axis=0).astype(np.uint16)
    camera = {name: getattr(CAMERA, name) for name in ("fx", "fy", "cx", "cy")}
    np.savez(path, depth=pictures, frame_rate=30.0, **camera)
    return path


def test_a_standing_body_is_written_as_a_skeleton_with_its_figures(call, take, tmp_path):
    target, body_file = tmp_path / "out.bvh", tmp_path / "body.npz"

    status, out, err = call(
        "capture", take, target, "--keep-body", body_file, "--json", *FAST_OPTIONS
    )

    assert (status, err) == (0, "")
    figures = json.loads(out)
    assert figures["n_frames"] == 4 and figures["residual_m"] < 0.03
    assert any("No floor is visible" in remark for remark in figures["remarks"])
    motion = read_bvh(target)
    assert motion.n_frames == 4 and 1.3 < motion.skeleton.height < 2.1

    joints = tmp_path / "joints"
    again = call(
        "capture",
        take,
        "--output-folder",
        joints,
        "--joints",
        "--body",
        body_file,
        *FAST_OPTIONS,
    )
    assert again[0] == 0
    found = read_recording(next(joints.glob("*.csv")))
    assert found.tracks.confidence is not None
    assert load_body_model(body_file).lengths.shape == default_body().lengths.shape


@pytest.mark.parametrize("method", ["wei", "lou"])
def test_published_methods_can_be_chosen(call, take, tmp_path, method):
    body = tmp_path / "body.npz"
    default_body().save(body)
    given = ("--body", body, "--json", *FAST_OPTIONS)

    runs = [
        call("capture", take, tmp_path / f"{name}.bvh", "--method", name, *given)
        for name in ("default", method)
    ]

    default, published = (json.loads(out)["residual_m"] for _, out, _ in runs)
    assert published != default and published < 0.03


def test_capture_reports_missing_depth_and_missing_actor_in_one_sentence(call, take, tmp_path):
    (tmp_path / "no.bvh").write_text("HIERARCHY\n")
    for source, words in (
        (tmp_path / "no.bvh", "holds no depth"),
        (None, "No person is visible"),
    ):
        empty = tmp_path / "empty.npz"
        if source is None:
            with np.load(take) as archive:
                arrays = dict(archive)
            np.savez(empty, **(arrays | {"depth": 0 * arrays["depth"]}))
        status, _, err = call("capture", source or empty, tmp_path / "out.bvh", *FAST_OPTIONS)
        assert status == 2 and err.count("\n") == 1 and words in err
        assert not (tmp_path / "out.bvh").exists()


@pytest.fixture
def takes(take, tmp_path):
    """A folder as it grows on a set: recordings of two kinds, and much else."""
    folder = tmp_path / "takes"
    (folder / "monday").mkdir(parents=True)
    shutil.copy(take, folder / "monday" / "standing.npz")
    with np.load(take) as archive:
        depth = archive["depth"]
    lens = CAMERA.fx, CAMERA.fy, CAMERA.cx, CAMERA.cy
    open3d(folder / "tuesday" / "pictures", depth, lens)
    (folder / "walk.bvh").write_text("HIERARCHY\n")
    np.savez(folder / "patterns.npz", values=np.ones(3))
    save_png(folder / "stills" / "1.png", np.zeros((4, 4, 3), np.uint8))
    shutil.copytree(folder / "tuesday", folder / ".trash")
    return folder


@pytest.fixture
def with_body(tmp_path):
    """The options by which a body need not be looked for."""
    default_body().save(tmp_path / "known.npz")
    return ("--body", tmp_path / "known.npz", *FAST_OPTIONS)


def test_a_folder_of_takes_is_captured_take_by_take(call, takes, with_body):
    out = takes / "captured"
    words = ("capture", takes, "--output-folder", out, *with_body)

    status, printed, err = call(*words, "--jobs", 2, "--report")

    assert (status, err) == (0, "")
    assert printed.count("4 frames, ") == 2
    made = {path.relative_to(out).as_posix() for path in out.rglob("*.bvh")}
    assert made == {"monday/standing.bvh", "tuesday/pictures.bvh"}
    assert (
        len(list(out.rglob("*.png"))) == 2 and "pictures" in (out / "report.html").read_text()
    )

    again = call(*words)[1]
    assert again.count("Already made.") == 2


def test_one_bad_take_does_not_stop_the_others(call, takes, with_body, tmp_path):
    complete = (takes / "monday" / "standing.npz").read_bytes()
    (takes / "monday" / "cut short.npz").write_bytes(complete[: len(complete) // 2])
    for picture in (takes / "tuesday" / "pictures" / "depth").iterdir():
        picture.write_bytes(picture.read_bytes()[:40])

    status, printed, err = call(
        "capture", takes, "--output-folder", tmp_path / "out", *with_body
    )

    assert status == 2 and printed.count("4 frames, ") == 1
    messages = err.strip().split("\n")
    assert len(messages) == 2 and all(line.endswith(".") for line in messages)
    assert (
        "cut short.npz" in messages[0] and "4 of 4 depth images are missing or" in messages[1]
    )


def test_folder_that_is_one_take_is_captured(call, takes, with_body, tmp_path):
    take = takes / "tuesday" / "pictures"

    assert call("capture", take, "--output-folder", tmp_path / "out", *with_body)[0] == 0
    assert (tmp_path / "out" / "pictures.bvh").is_file()

    status, _, err = call(
        "capture", takes / "stills", "--output-folder", tmp_path, *FAST_OPTIONS
    )
    assert status == 2 and "There is no recording in the folder" in err


def test_two_takes_into_one_file_are_refused(call, takes, tmp_path):
    words = ("--keep-body", tmp_path / "body.npz")

    status, _, err = call("capture", takes, "--output-folder", tmp_path / "out", *words)

    assert status == 2 and err.count("\n") == 1 and "can hold one body" in err
    assert not (tmp_path / "body.npz").exists()


@pytest.fixture(scope="module")
def two_people(tmp_path_factory):
    """Four frames of two bodies, who stand next to each other."""
    body, depths = default_body(), []
    for right in (-0.7, 0.7):
        pose = NATURAL.copy()
        pose[0] += right
        depths.append(cast_rays(body, segment_frames(body, pose), CAMERA).depth_image())
    path = tmp_path_factory.mktemp("depth") / "two.npz"
    pictures = np.repeat(np.round(1000 * sum(depths))[None], 4, axis=0).astype(np.uint16)
    camera = {name: getattr(CAMERA, name) for name in ("fx", "fy", "cx", "cy")}
    np.savez(path, depth=pictures, frame_rate=30.0, **camera)
    return path


def test_each_person_is_written_to_a_file_and_a_second_run_keeps_both(
    call, two_people, tmp_path
):
    folder = tmp_path / "out"
    words = ("capture", two_people, "--people", "all", "--output-folder", folder, "--json")

    status, out, err = call(*words, *FAST_OPTIONS)

    assert (status, err) == (0, "")
    figures = json.loads(out)["people"]
    written = [folder / "two.bvh", folder / "two_person2.bvh"]
    assert [each["output"] for each in figures] == [str(path) for path in written]
    hips = [read_bvh(path).root_positions[0] for path in written]
    assert np.linalg.norm(hips[0] - hips[1]) == pytest.approx(1.4, abs=0.05)

    assert "already_made" in call(*words, *FAST_OPTIONS)[1]


def test_numbers_of_people_are_checked(call, two_people, tmp_path):
    target = tmp_path / "out.bvh"
    for words, sentence in (
        (("--people", "none"), "'none' is no number of people"),
        (("--people", "3"), "Only 2 of 3 people are found."),
        (("--people", "2", "--keep-body", tmp_path / "body.npz"), "Leave out --body and"),
        (("--people", "2", "--method", "wei"), "The method wei tracks one person."),
    ):
        status, out, err = call("capture", two_people, target, *words, *FAST_OPTIONS)
        assert (status, out) == (2, "") and sentence in err and err.count("\n") == 1
    assert not target.exists()


def two_cameras(tmp_path_factory):
    """The same walk before two cameras; the second is at the right of the actor."""
    poses = waving(26)
    poses[:, 0] = 0.3 * np.sin(np.arange(26) / 5.0)
    right = np.array([[0, 0, 1, -2.8], [0, 1, 0, 0.1], [-1, 0, 0, 2.9], [0, 0, 0, 1.0]])
    folder = tmp_path_factory.mktemp("cameras")
    camera = {name: getattr(CAMERA, name) for name in ("fx", "fy", "cx", "cy")}
    for name, each in (
        ("front", poses), ("side", transfer_poses(default_body(), poses, right)[4:])
    ):  # fmt: skip
        images = np.stack([1000.0 * drawn(pose) for pose in each]).round().astype(np.uint16)
        np.savez(folder / f"{name}.npz", depth=images, frame_rate=30.0, **camera)
    default_body().save(folder / "actor.npz")
    return folder


def test_second_camera_is_found_and_reported(call, two_cameras, tmp_path):
    words = ("capture", two_cameras / "front.npz", tmp_path / "out.bvh")
    given = ("--camera", two_cameras / "side.npz", "--body", two_cameras / "actor.npz")

    status, out, err = call(*words, *given, "--json", *FAST_OPTIONS)

    assert (status, err) == (0, "")
    figures = json.loads(out)
    assert figures["n_frames"] == 26
    first, second = figures["cameras"]
    assert first["first_from_camera"] == np.eye(4).tolist() and first["offset_s"] == 0.0
    assert abs(second["offset_s"] - 4.0 / 30.0) < 0.02
    position = np.array(second["first_from_camera"])[:3, 3]
    assert np.abs(position - (2.9, -0.1, 2.8)).max() < 0.15
    assert any("Camera 2 is 4.0" in remark for remark in figures["remarks"])
    assert read_bvh(tmp_path / "out.bvh").n_frames == 26


def test_second_camera_without_a_common_motion_is_refused(call, take, two_cameras, tmp_path):
    words = ("capture", two_cameras / "front.npz", tmp_path / "out.bvh")
    given = ("--body", two_cameras / "actor.npz", *FAST_OPTIONS)

    status, _, err = call(*words, "--camera", take, *given)
    assert status == 2 and err.count("\n") == 1 and "Camera 2: " in err

    status, _, err = call(
        "capture", two_cameras, "--output-folder", tmp_path / "all", "--camera", take, *given
    )
    assert status == 2 and "adds a recording to one take" in err

    status, _, err = call(*words, "--camera", tmp_path / "none.npz", *given)
    assert status == 2 and err.count("\n") == 1 and "none.npz" in err
    assert not (tmp_path / "out.bvh").exists()
