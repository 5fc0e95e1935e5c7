"""`vary`: a folder of new motions and a picture of them."""

import json

import numpy as np
import pytest

from solvers.motion import Tracks
from solvers.recordings import read_bvh, write_bvh, write_trc
from solvers.samples import GaitSettings, walking_gait


@pytest.fixture
def walks(tmp_path):
    folder = tmp_path / "walks"
    folder.mkdir()
    for seed, cadence in ((1, 110), (2, 106), (3, 114)):
        walk = walking_gait(
            GaitSettings(duration=1.1, frame_rate=30.0, seed=seed, cadence=cadence)
        )
        write_bvh(walk, folder / f"walk_{seed}.bvh")
    return folder


def test_vary_writes_variants_and_a_picture(call, walks, tmp_path):
    out = tmp_path / "crowd"
    status, printed, err = call("vary", walks, "--output", out, "--number", "3", "--json")
    assert (status, err) == (0, "")
    messages = json.loads(printed)
    assert messages["variants"] == [f"walk_1.{number}.bvh" for number in (1, 2, 3)]
    assert messages["variation_m"] > 0.003
    read = [read_bvh(out / name) for name in messages["variants"]]
    assert all(motion.n_joints == read_bvh(walks / "walk_1.bvh").n_joints for motion in read)
    assert (out / "variants.png").read_bytes().startswith(b"\x89PNG")


def test_amount_zero_is_a_copy(call, walks, tmp_path):
    still = ["--amount", "0", "--timing", "0", "--base", "2", "--no-plant-feet"]
    status, *_ = call("vary", walks, "--output", tmp_path / "out", "--number", "1", *still)
    assert status == 0
    made, base = read_bvh(tmp_path / "out" / "walk_1.1.bvh"), read_bvh(walks / "walk_2.bvh")
    heights = [motion.root_positions[:, 2] for motion in (made, base)]
    assert abs(len(heights[0]) - len(heights[1])) <= 1
    assert np.ptp(heights[0]) == pytest.approx(np.ptp(heights[1]), rel=0.2)


def test_vary_refuses_points_and_a_file_at_the_output_folder(call, walks, tmp_path):
    points = tmp_path / "points.trc"
    write_trc(Tracks(("LASI",), np.ones((5, 1, 3)), 30.0), points)
    status, _, err = call("vary", walks, points, "--output", tmp_path / "out")
    assert status == 2
    assert "motions of skeletons" in err
    status, _, err = call("vary", walks, "--output", points)
    assert status == 2
    assert "is a file; name a folder" in err
    status, _, err = call("vary", walks, "--output", tmp_path / "out", "--number", "0")
    assert status == 2
    assert "request at least one" in err
    assert not (tmp_path / "out").exists()
