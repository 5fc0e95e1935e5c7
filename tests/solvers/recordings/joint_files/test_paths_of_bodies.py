"""Joints that are relative to the body come in where the file says that the body is."""

import io
import json

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.motion import roles_by_name
from solvers.recordings.conventions.camera_paths import CROPPED

F = 40
AS_Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
SMPL = (
    "hips", "leftUpperLeg", "rightUpperLeg", "spine", "leftLowerLeg", "rightLowerLeg", "chest",
    "leftFoot", "rightFoot", "upperChest", "leftToes", "rightToes", "neck", "leftShoulder",
    "rightShoulder", "head", "leftUpperArm", "rightUpperArm", "leftLowerArm", "rightLowerArm",
    "leftHand", "rightHand",
)  # fmt: skip


@pytest.fixture(scope="module")
def walk(walker):
    """Positions of the joints of SMPL in meters, Y up, shape (F, 22, 3)."""
    return np.stack([walker[role][:F] for role in SMPL], axis=1) @ AS_Y_UP.T


@pytest.fixture(scope="module")
def relative(walk):
    return walk - walk[:, :1]


def check(recording, walk):
    """The actor does not stand in place with the hips at the origin."""
    roles = roles_by_name(recording.names)
    found = recording.tracks.positions[:, [recording.names.index(roles[r]) for r in SMPL]]
    assert_allclose(found, walk @ AS_Y_UP, atol=1e-4)


@pytest.mark.parametrize("key", ["root_translation", "rootPosition", "pred_cam_t", "transl"])
@pytest.mark.parametrize("nest", ["frame", "person", "take"])
def test_json_states_the_path_of_the_body(read_any, walk, relative, key, nest):
    points, path = relative.tolist(), walk[:, 0].tolist()
    frames = [{"joints3d": p, key: r} for p, r in zip(points, path, strict=True)]
    content = {
        "frame": {"fps": 30, "frames": frames},
        "person": {"fps": 30, "frames": [{"people": [{"id": 3, **f}]} for f in frames]},
        "take": {"fps": 30, "joints3d": points, key: path},
    }

    check(read_any(json.dumps(content[nest])), walk)


@pytest.mark.parametrize("key", ["pred_cam_t", "cam_t_full", "transl", "root_translation"])
@pytest.mark.parametrize("nest", ["frame", "member", "person", "joints", "listed", "names"])
def test_named_joints_may_be_next_to_the_path_of_the_body(read_any, walk, relative, key, nest):
    """Joints keyed by name do not stand in place."""
    points, path = relative.tolist(), walk[:, 0].tolist()
    named = [dict(zip(SMPL, frame, strict=True)) for frame in points]
    frames = [{key: where, **joints} for where, joints in zip(path, named, strict=True)]
    pairs = zip(points, path, strict=True)
    content = {
        "frame": {"fps": 30, "frames": frames},
        "member": {"fps": 30, "frames": [{key: f[key], "pose": f} for f in frames]},
        "person": {"fps": 30, "frames": [{"people": [{"id": 3, **f}]} for f in frames]},
        "joints": {name: relative[:, at].tolist() for at, name in enumerate(SMPL)}
        | {key: path},
        "listed": {"fps": 30, "joint_names": SMPL, key: path, "pred_joints": points},
        "names": [{"joint_names": SMPL, "points": p, key: r} for p, r in pairs],
    }

    check(read_any(json.dumps(content[nest])), walk)


@pytest.mark.parametrize("key", ["pred_cam_t", "cam_t", "transl", "root_pos"])
def test_columns_of_joints_may_be_next_to_the_path_of_the_body(read_any, walk, relative, key):
    """The `t` of `cam_t_x` is a part of the name."""
    titles = [f"{name}_{axis}" for name in (*SMPL, key) for axis in "xyz"]
    rows = np.concatenate([relative.reshape(F, -1), walk[:, 0]], axis=1)
    lines = [",".join(f"{x:.5f}" for x in row) for row in rows]

    check(read_any("\n".join([",".join(titles), *lines])), walk)


@pytest.mark.parametrize("key", ["position", "transform"])
def test_other_values_next_to_names_are_no_path_of_the_body(read_any, walk, relative, key):
    """A `position` may be that of a camera, and text is none."""
    for other, values in ((key, walk[:, 0].tolist()), ("root", [["a"] * 3] * F)):
        take = {"joint_names": SMPL, other: values, "pred_joints": relative.tolist()}

        recording = read_any(json.dumps({"fps": 30, **take}))

        check(recording, relative)


@pytest.mark.parametrize("nest", ["json", "npz"])
def test_the_camera_of_a_cropped_picture_is_no_path(read_any, relative, walk, nest):
    path = walk[:, 0] + (0.0, 0.0, 43.0)
    buffer = io.BytesIO()
    np.savez(buffer, joints3d=relative, pred_cam_t=path, fps=np.array(30.0))
    frames = [
        {"joints3d": points, "pred_cam_t": position}
        for points, position in zip(relative.tolist(), path.tolist(), strict=True)
    ]
    content = json.dumps({"fps": 30, "frames": frames}) if nest == "json" else buffer.getvalue()

    check(read_any(content), relative)


@pytest.mark.parametrize("nest", ["frames", "take"])
def test_a_path_away_from_the_camera_is_one_path(
    make_reader, collected_messages, walk, relative, nest
):
    """Judged each by itself, frames on both sides of 25 m jump by 25 m."""
    path = walk[:, 0] + np.linspace((0.0, 0.0, 22.0), (0.0, 0.0, 29.0), F)
    points, stated = relative.tolist(), path.tolist()
    content = {
        "frames": {"frames": [{"joints3d": p, "pred_cam_t": r}
                              for p, r in zip(points, stated, strict=True)]},
        "take": {"joints3d": points, "pred_cam_t": stated},
    }  # fmt: skip
    messages, progress = collected_messages
    read = make_reader("take.json")

    check(read(json.dumps({"fps": 30, **content[nest]}), progress=progress), relative)

    assert CROPPED in messages


def test_a_person_with_arrays_states_the_path(read_any, walk, relative):
    person = {"joints3d": relative.tolist(), "trans": walk[:, 0].tolist()}

    check(read_any(json.dumps({"fps": 30, "person_1": person})), walk)


@pytest.mark.parametrize("batch", [False, True])
def test_archives_state_the_path(read_any, walk, relative, batch):
    file = io.BytesIO()
    arrays = {"joints3d": relative, "pred_cam_t": walk[:, 0], "fps": np.array(30.0)}
    np.savez(file, **{key: each[None] if batch and each.ndim else each
                      for key, each in arrays.items()})  # fmt: skip

    check(read_any(file.getvalue()), walk)


def test_tables_state_the_path(read_any, walk, relative):
    names = [*SMPL, "root_translation"]
    points = np.concatenate([relative, walk[:, :1]], axis=1).reshape(F, -1)
    titles = ",".join(["time", *(f"{name}_{axis}" for name in names for axis in "xyz")])
    rows = [
        f"{k / 30:.4f}," + ",".join(f"{v:.6f}" for v in row) for k, row in enumerate(points)
    ]

    check(read_any("\n".join([titles, *rows])), walk)


@pytest.mark.parametrize("flat", [True, False])
def test_joints_are_turned_with_the_transform_of_the_body(read_any, walk, relative, flat):
    """ARKit writes matrices by columns; those of joints are relative to the body."""
    frames = []
    for k, angle in enumerate(np.linspace(0.0, 1.0, F)):
        c, s = np.cos(angle), np.sin(angle)
        turn = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
        body = [_matrix(turn, walk[k, 0], flat)]
        joints = [_matrix(np.eye(3), point, flat) for point in relative[k] @ turn]
        frames.append({"time": k / 30, "bodyTransform": body[0], "joints": [
            {"name": name, "modelTransform": joint}
            for name, joint in zip(SMPL, joints, strict=True)
        ]})  # fmt: skip

    check(read_any(json.dumps({"frames": frames})), walk)


def _matrix(rotation, position, flat):
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation, position
    return matrix.T.ravel().tolist() if flat else matrix.T.tolist()


@pytest.mark.parametrize("in_place", [True, False])
def test_joints_in_the_room_are_where_they_are(read_any, walk, in_place):
    """The path next to them is no second one, also of who stays in place."""
    points = walk - walk[:, :1] * (in_place, 0.0, in_place)
    frames = [{"joints3d": p.tolist(), "root_position": p[0].tolist()} for p in points]

    check(read_any(json.dumps({"fps": 30, "frames": frames})), points)


def test_names_in_archives_come_before_the_order(read_any, walk):
    """Read in the order of UI-PRMD, the head is the neck."""
    file = io.BytesIO()
    order = [SMPL.index(role) for role in sorted(SMPL)]
    np.savez(file, positions=walk[:, order], names=np.array(sorted(SMPL)), fps=30)

    check(read_any(file.getvalue()), walk)


@pytest.mark.parametrize("key", ["joints", "pose3d"])
def test_people_may_be_in_a_scene_and_points_in_a_member(read_any, walk, key):
    frames = [
        {"scene": {"actors": [{"id": 1, key: {"joints": p.ravel().tolist()}}]}} for p in walk
    ]

    check(read_any(json.dumps({"fps": 30, "frames": frames})), walk)


@pytest.mark.parametrize("point", [
    lambda name, p: {"name": name, "pos": p},
    lambda name, p: {"name": name, "px": p[0], "py": p[1], "pz": p[2]},
])  # fmt: skip
def test_segments_with_positions_are_joints(read_any, walk, point):
    frames = [
        {"segments": [point(name, p) for name, p in zip(SMPL, frame.tolist(), strict=True)]}
        for frame in walk
    ]

    check(read_any(json.dumps({"fps": "30", "frames": frames})), walk)


@pytest.mark.parametrize(
    "stated", [{"fps": "50"}, {"rate": 50}, {"metadata": {"frameRate": "50,0"}}]
)
def test_rates_may_be_texts(read_any, walk, stated):
    content = {**stated, "frames": [{"joints3d": frame.tolist()} for frame in walk]}

    assert read_any(json.dumps(content)).frame_rate == 50.0


def test_frames_may_be_keyed_by_their_images(read_any, walk):
    frames = {f"img/{k + 1:06d}.jpg": {"3d_joints": p.tolist()} for k, p in enumerate(walk)}

    check(read_any(json.dumps(frames)), walk)


def test_numbered_names_of_joints_are_recognized(read_any, walk):
    """CMU Panoptic calls them joints19; before, the file was of an unknown format."""
    bodies = [{"id": 0, "joints22": p.ravel().tolist()} for p in walk]

    check(read_any(json.dumps([{"univTime": 33 * k, "bodies": [each]}
                               for k, each in enumerate(bodies)])), walk)  # fmt: skip


def test_who_stands_still_in_the_room_stays_there(read_any, walk):
    """Where the character stands is no second path: no joint follows it."""
    points = np.repeat(walk[:1], F, axis=0) + np.array([5.0, 0.0, 3.0])
    frames = [{"joints3d": p.tolist(), "position": [5.0, 0.0, 3.0]} for p in points]

    check(read_any(json.dumps({"fps": 30, "frames": frames})), points)


@pytest.mark.parametrize("stated", [{"rate": 1.0}, {"metadata": {"rate": 0.98}}])
def test_a_ratio_is_no_rate(read_any, walk, stated):
    content = {**stated, "frames": [{"joints3d": frame.tolist()} for frame in walk]}

    assert read_any(json.dumps(content)).frame_rate == 20.0


def test_bodies_in_a_unit_box_are_no_pictures(read_any, walk):
    """Their third coordinate, from 0 to 1, is depth: bones keep their lengths with it."""
    low = walk.min(axis=(0, 1))
    file = io.BytesIO()
    np.save(file, (walk - low) / np.ptp(walk, axis=(0, 1)).max())

    assert read_any(file.getvalue()).tracks.n_frames == F
