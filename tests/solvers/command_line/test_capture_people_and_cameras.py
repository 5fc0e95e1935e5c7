"""`capture` of several people, and by several cameras."""

import json

import numpy as np
import pytest
from drawn_bodies import CAMERA, NATURAL, drawn, waving

from solvers.command_line import capture_verb
from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.body.ray_capsules import cast_rays
from solvers.depth_tracking.body.segment_kinematics import segment_frames
from solvers.depth_tracking.several_cameras.transfer_poses import transfer_poses
from solvers.recordings import read_bvh

FAST_OPTIONS = ("--no-backward", "--no-refine", "--no-feet", "--check-every", "1000")


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
    written[1].unlink()
    assert "already_made" not in call(*words, *FAST_OPTIONS)[1]
    assert written[1].exists()


def test_person_that_another_process_wrote_meanwhile_is_not_replaced(
    call, two_people, tmp_path, monkeypatch
):
    captured, other = capture_verb.capture_every_person, tmp_path / "out_person2.bvh"

    def capture(*arguments, **options):
        other.write_text("of another process")
        return captured(*arguments, **options)

    monkeypatch.setattr(capture_verb, "capture_every_person", capture)
    words = ("capture", two_people, tmp_path / "out.bvh", "--people", "all")

    status, _, err = call(*words, *FAST_OPTIONS)

    assert status == 2 and f"{other} exists, and would be replaced" in err
    assert other.read_text() == "of another process"


def test_numbers_of_people_are_checked(call, two_people, tmp_path):
    target = tmp_path / "out.bvh"
    for words, sentence in (
        (("--people", "none"), "'none' is no number of people"),
        (("--people", "3"), "Only 2 of 3 people are found."),
        (("--people", "2", "--keep-body", tmp_path / "body.npz"), "Leave out --body and"),
        (("--people", "2", "--method", "wei"), "The method wei tracks one person in the"),
    ):
        status, out, err = call("capture", two_people, target, *words, *FAST_OPTIONS)
        assert (status, out) == (2, "") and sentence in err and err.count("\n") == 1
    assert not target.exists()


@pytest.fixture(scope="module")
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


def test_second_camera_without_a_common_motion_is_refused(call, two_cameras, tmp_path):
    words = ("capture", two_cameras / "front.npz", tmp_path / "out.bvh")
    given = ("--body", two_cameras / "actor.npz", *FAST_OPTIONS)

    take = tmp_path / "standing.npz"
    with np.load(two_cameras / "front.npz") as front:
        np.savez(take, **{**front, "depth": np.repeat(front["depth"][:1], 8, axis=0)})

    status, _, err = call(*words, "--camera", take, *given)
    assert status == 2 and err.count("\n") == 1 and "Camera 2: " in err

    status, _, err = call(
        "capture", two_cameras, "--output-folder", tmp_path / "all", "--camera", take, *given
    )
    assert status == 2 and "adds a recording to one take" in err

    status, _, err = call(*words, "--camera", tmp_path / "none.npz", *given)
    assert status == 2 and err.count("\n") == 1 and "none.npz" in err
    assert not (tmp_path / "out.bvh").exists()


def test_recordings_of_several_people_may_not_share_a_file(call, two_people, tmp_path):
    folder = tmp_path / "takes"
    folder.mkdir()
    for name in ("two.npz", "two_person2.npz"):
        (folder / name).write_bytes(two_people.read_bytes())

    status, _, err = call(
        "capture", folder, "--people", "2", "--output-folder", tmp_path / "out", *FAST_OPTIONS
    )

    assert status == 2 and "would be written to one file" in err and err.count("\n") == 1
    assert not list((tmp_path / "out").glob("*.bvh"))


def test_same_recording_is_no_second_camera(call, two_cameras, tmp_path):
    front = two_cameras / "front.npz"

    status, _, err = call("capture", front, tmp_path / "out.bvh", "--camera", front)

    assert status == 2 and "The same recording is given for two cameras" in err


def test_camera_without_a_person_is_named(call, two_cameras, tmp_path):
    camera = {name: getattr(CAMERA, name) for name in ("fx", "fy", "cx", "cy")}
    empty = tmp_path / "room.npz"
    np.savez(empty, depth=np.zeros((8, 60, 80), np.uint16), frame_rate=30.0, **camera)

    status, _, err = call(
        "capture", two_cameras / "front.npz", tmp_path / "out.bvh", "--camera", empty,
        "--body", two_cameras / "actor.npz", *FAST_OPTIONS,
    )  # fmt: skip

    assert status == 2 and "Camera 2: " in err and err.count("\n") == 1
