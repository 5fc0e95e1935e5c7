"""`capture`: from pictures of depth to a file of motion."""

import json
import shutil

import numpy as np
import pytest
from depth_folders import open3d, save_png
from drawn_bodies import CAMERA, NATURAL

from solvers.depth_tracking.body.model import default_body, load_body_model
from solvers.depth_tracking.body.ray_capsules import cast_rays
from solvers.depth_tracking.body.segment_kinematics import segment_frames
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
