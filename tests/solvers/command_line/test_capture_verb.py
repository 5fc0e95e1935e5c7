"""`capture`: from pictures of depth to a file of motion."""

import json

import numpy as np
import pytest
from drawn_bodies import CAMERA, NATURAL

from solvers.depth_tracking.body_kinematics import segment_frames
from solvers.depth_tracking.body_model import load_body_model, usual_body
from solvers.depth_tracking.ray_capsules import cast_rays
from solvers.recordings import read_bvh, read_recording

QUICK = ("--no-backward", "--no-refine", "--no-feet", "--check-every", "1000")


@pytest.fixture(scope="module")
def take(tmp_path_factory):
    """Four frames of our own body, standing three metres away."""
    body = usual_body()
    depth = cast_rays(body, segment_frames(body, NATURAL), CAMERA).depth_picture()
    path = tmp_path_factory.mktemp("depth") / "standing.npz"
    pictures = np.repeat(np.round(1000 * depth)[None], 4, axis=0).astype(np.uint16)
    camera = {name: getattr(CAMERA, name) for name in ("fx", "fy", "cx", "cy")}
    np.savez(path, depth=pictures, frame_rate=30.0, **camera)
    return path


def test_a_standing_body_is_written_as_a_skeleton_with_its_figures(call, take, tmp_path):
    target, kept = tmp_path / "out.bvh", tmp_path / "body.npz"

    status, out, err = call("capture", take, target, "--keep-body", kept, "--json", *QUICK)

    assert (status, err) == (0, "")
    figures = json.loads(out)
    assert figures["n_frames"] == 4 and figures["residual_m"] < 0.03
    assert any("No floor is seen" in remark for remark in figures["remarks"])
    motion = read_bvh(target)
    assert motion.n_frames == 4 and 1.3 < motion.skeleton.height < 2.1

    joints = tmp_path / "joints"
    again = call("capture", take, "--output-folder", joints, "--joints", "--body", kept, *QUICK)
    assert again[0] == 0
    found = read_recording(next(joints.glob("*.csv")))
    assert found.tracks.confidence is not None
    assert load_body_model(kept).lengths.shape == usual_body().lengths.shape


def test_what_is_no_depth_and_who_is_not_there_are_said_in_a_sentence(call, take, tmp_path):
    (tmp_path / "no.bvh").write_text("HIERARCHY\n")
    for source, words in ((tmp_path / "no.bvh", "holds no depth"), (None, "Nobody is seen")):
        empty = tmp_path / "empty.npz"
        if source is None:
            with np.load(take) as archive:
                arrays = dict(archive)
            np.savez(empty, **(arrays | {"depth": 0 * arrays["depth"]}))
        status, _, err = call("capture", source or empty, tmp_path / "out.bvh", *QUICK)
        assert status == 2 and err.count("\n") == 1 and words in err
        assert not (tmp_path / "out.bvh").exists()
