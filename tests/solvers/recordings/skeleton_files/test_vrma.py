"""VRM animations: rest poses of any kind, roles, rates and what is damaged."""

import numpy as np
import pytest
from exports.vrma_files import ROLES, glb, vrma
from numpy.testing import assert_allclose

from solvers.errors import InvalidFileError
from solvers.motion import find_humanoid_map, world_poses
from solvers.recordings import read_recording
from solvers.recordings.skeleton_files.vrma import read_vrma


def joints(motion):
    poses = world_poses(motion.skeleton, motion.rotations, motion.root_positions)
    return dict(zip(motion.skeleton.names, np.moveaxis(poses.positions, 1, 0), strict=True))


@pytest.mark.parametrize("seed", [None, 4])
def test_the_motion_does_not_depend_on_how_the_rest_pose_is_stored(read_any, seed):
    motion = read_any(vrma(seed=seed))

    assert motion.n_frames == 31
    assert motion.frame_rate == 30.0
    assert set(find_humanoid_map(motion.skeleton).joints) == set(ROLES)
    found = joints(motion)
    angle = np.arange(31) / 30.0
    forward = -np.linspace(0.0, 1.0, 31)
    hand = np.stack(
        [0.17 + 0.53 * np.cos(angle), forward, 1.47 + 0.53 * np.sin(angle)], axis=-1
    )
    assert_allclose(found["leftHand"], hand, atol=1e-5)
    assert_allclose(found["rightFoot"], [(-0.09, y, 0.08) for y in forward], atol=1e-5)


def test_the_rest_pose_is_a_t_pose_in_which_nothing_turns(read_any):
    motion = read_any(vrma())

    assert_allclose(motion.rotations[:, 0, 0], 1.0, atol=1e-6)
    head = motion.skeleton.rest_positions[motion.skeleton.names.index("head")]
    assert_allclose(head, (0.0, 0.0, 1.62), atol=1e-6)


@pytest.mark.parametrize("size", [0.0, 1e-200])
def test_rest_rotations_without_length_are_none(read_any, size):
    """The square of 1e-200 is 0, and a rotation divided by it is no number."""

    def rest(rotation):
        def change(document):
            for node in document["nodes"]:
                node["rotation"] = rotation

        return read_any(vrma(change)).rotations

    assert_allclose(rest([0.0, size, 0.0, 0.0]), rest([0.0, 0.0, 0.0, 1.0]), atol=1e-9)


def test_centimeters_are_recognized_and_reported(tmp_path):
    """A VRM animation is in meters by definition, but not every converter minded it."""

    def enlarge(document):
        for node in document["nodes"]:
            node["translation"] = [100.0 * each for each in node["translation"]]

    (tmp_path / "take.vrma").write_bytes(vrma(enlarge))
    messages = []

    motion = read_vrma(
        tmp_path / "take.vrma", progress=lambda _, message="": messages.append(message)
    )

    head = motion.skeleton.rest_positions[motion.skeleton.names.index("head")]
    assert_allclose(head, (0.0, 0.0, 1.62), atol=1e-6)
    assert any("Lengths are interpreted as centimeters" in each for each in messages)
    assert read_vrma(tmp_path / "take.vrma", scale=1.0).skeleton.rest_positions.max() > 100.0


@pytest.mark.parametrize(("rate", "expected"), [(24.0, 24.0), (60.0, 60.0), (37.0, 60.0)])
def test_the_rate_is_the_one_on_which_all_keys_are(read_any, rate, expected):
    motion = read_any(vrma(rate=rate))

    assert motion.frame_rate == expected
    assert motion.n_frames == round(30.0 / rate * expected) + 1


def test_keys_of_steps_hold_their_value(read_any):
    def step(document):
        document["animations"][0]["samplers"][1]["interpolation"] = "STEP"

    motion = read_any(vrma(step, rate=0.5, n_keys=2))

    assert_allclose(np.ptp(motion.root_positions[:-1], axis=0), 0.0, atol=1e-9)
    assert_allclose(motion.root_positions[-1], (0.0, -1.0, 0.95), atol=1e-5)


def test_the_sample_of_pixiv_stands_and_moves(recordings):
    motion = read_recording(recordings / "corpus/vrm/vrma_pixiv/test.vrma")

    assert (motion.n_frames, motion.frame_rate) == (91, 30.0)
    assert len(find_humanoid_map(motion.skeleton).joints) == 51
    hips = motion.skeleton.names.index("hips")
    assert_allclose(joints(motion)["hips"][0], (0.0, 0.0, 0.85), atol=1e-5)
    assert hips == 0


def without(*keys):
    def change(document):
        inner = document
        for key in keys[:-1]:
            inner = inner[key]
        del inner[keys[-1]]

    return change


def put(value, *keys):
    def change(document):
        inner = document
        for key in keys[:-1]:
            inner = inner[key]
        inner[keys[-1]] = value

    return change


BONES = ("extensions", "VRMC_vrm_animation", "humanoid", "humanBones")


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (without(*BONES, "hips"), "without hips"),
        (put([], "animations"), "no animation of a bone"),
        (put({"node": 900}, *BONES, "head"), "damaged"),
        (put([0], "nodes", 3, "children"), "damaged"),
        (put([900], "nodes", 3, "children"), "damaged"),
        (put(10**9, "accessors", 0, "count"), "damaged"),
        (put(-1, "accessors", 0, "byteOffset"), "damaged"),
        (put("VEC4", "accessors", 2, "type"), "damaged"),
        (put(7, "accessors", 0, "componentType"), "damaged"),
        (put({"uri": "file:///etc/passwd"}, "buffers", 0), "another file"),
        (put({}, "accessors", 1, "sparse"), "another file"),
        (put("five", "nodes"), "damaged"),
        (put(99, "animations", 0, "channels", 0, "sampler"), "damaged"),
    ],
)
def test_what_is_damaged_is_refused_in_a_sentence(read_any, change, sentence):
    with pytest.raises(InvalidFileError, match=sentence):
        read_any(vrma(change))


def test_too_many_nodes_are_refused(read_any):
    with pytest.raises(InvalidFileError, match="10,000 can be read"):
        read_any(vrma(lambda document: document["nodes"].extend([{}] * 10_000)))


def test_shared_numbers_and_few_keys_use_no_memory(read_any, monkeypatch):
    def share(document):
        moves = document["animations"][0]["channels"]
        moves.extend(moves[:1] * 1000)

    monkeypatch.setattr("solvers.recordings.skeleton_files.vrma.MAX_POSES", 10_000)
    read_any(vrma(n_keys=301))

    with pytest.raises(
        InvalidFileError, match=r"has 10,\d+ poses .* read\. Export a shorter part"
    ):
        read_any(vrma(share, n_keys=301))
    with pytest.raises(InvalidFileError, match="has 285,019 poses of joints"):
        read_any(vrma(rate=0.002, n_keys=2))


@pytest.mark.parametrize("fraction", [0.95, 0.999])
def test_a_file_cut_short_is_refused(read_any, fraction):
    content = vrma()

    with pytest.raises(InvalidFileError, match="damaged or cut short"):
        read_any(content[: int(fraction * len(content))])


def test_other_gltf_files_still_name_blender(read_any):
    with pytest.raises(InvalidFileError, match="Blender's own importers"):
        read_any(glb({"asset": {"version": "2.0"}, "nodes": []}, b""))
