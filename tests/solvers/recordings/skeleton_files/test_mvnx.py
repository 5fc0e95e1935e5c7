"""A take of Xsens MVN is the same from its .mvnx as from its BVH."""

import numpy as np
import pytest

from solvers.errors import InvalidFileError
from solvers.motion import find_humanoid_map, world_poses
from solvers.recordings import read_recording


@pytest.fixture
def path(recordings):
    return recordings / "corpus/lab/xsens_mvnx/test_mocap.mvnx"


def positions(motion):
    found = world_poses(motion.skeleton, motion.rotations, motion.root_positions).positions
    return found - found[:, :1]


def test_the_same_take_as_bvh_agrees(path, recordings):
    motion = read_recording(path)
    bvh = read_recording(recordings / "corpus/bvh/xsens_mvn/test_mocap.bvh")

    assert motion.n_frames == bvh.n_frames == 112
    assert motion.frame_rate == 60.0
    ours, theirs = (
        find_humanoid_map(each.skeleton).indices(each.skeleton) for each in (motion, bvh)
    )
    for role in ("leftHand", "rightLowerArm", "head"):
        offset = positions(motion)[1:, ours[role]] - positions(bvh)[1:, theirs[role]]
        assert np.abs(offset).max() < 0.06, role  # the BVH has other joints in the trunk


def test_scale_multiplies_lengths(path):
    assert read_recording(path, scale=2.0).skeleton.height == pytest.approx(
        2.0 * read_recording(path).skeleton.height
    )


@pytest.mark.parametrize("end", [0.2, 0.6, 0.9])
def test_a_file_cut_short_is_refused(path, tmp_path, end):
    text = path.read_text(encoding="utf-8")
    (tmp_path / "cut.mvnx").write_text(text[: int(end * len(text))], encoding="utf-8")

    with pytest.raises(InvalidFileError, match=r"cut\.mvnx is damaged or cut short"):
        read_recording(tmp_path / "cut.mvnx")


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("<mvnx ", "<!DOCTYPE x [<!ENTITY a 'aaaa'>]><mvnx ", "declares a document type"),
        ("<mvnx ", f"<!-- <mvnx {70_000 * 'x'} --><!DOCTYPE x []><mvnx ", "a document type"),
        ('type="normal"', 'type="tpose"', "no positions and orientations"),
        ("<orientation>", "<orientation>x ", "damaged"),
        ('frameRate="60"', 'frameRate="0"', "damaged"),
        ('frameRate="60"', 'frameRate="nan"', "damaged"),
        ("position>", "place>", "no positions and orientations"),
        ('<segment label="Pelvis"', '<segment label="Prop1"', "no positions and orientations"),
    ],
)
def test_what_is_no_body_is_refused_in_a_sentence(path, tmp_path, old, new, sentence):
    text = path.read_text(encoding="utf-8")
    (tmp_path / "bad.mvnx").write_text(text.replace(old, new), encoding="utf-8")

    with pytest.raises(InvalidFileError, match=sentence):
        read_recording(tmp_path / "bad.mvnx")
