"""Bodies of a camera that looks down or up come in upright, or with a question."""

import numpy as np
import pytest

from solvers.motion import JointRecording, Motion, Sensor, world_poses
from solvers.recordings import Axis, FloorPlacement, ReadingSettings, read_as
from solvers.recordings.conventions import level
from solvers.rotations import (
    quaternion_from_euler,
    rotate,
    rotation_vector_from_quaternion,
)

F = 60
LEANS = "degrees while standing, as where a camera is tilted"
LIMBS = ("UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot")


def joints(path, walker, tilt_deg, bend_deg=0.0):
    """Write the joints of a walker, Z up, as a table that has no floor.

    Trunk and arms lean by `tilt_deg`, the legs by that and `bend_deg`.
    """
    names = ["hips", "head", *(side + part for side in ("left", "right") for part in LIMBS)]
    tilt, leg = (
        quaternion_from_euler(np.radians([[each, 0.0, 0.0]]), "XYZ")[0]
        for each in (tilt_deg, tilt_deg + bend_deg)
    )
    hips = walker["hips"][:F]
    points = np.stack([
        hips + rotate(leg if name.endswith(("Leg", "Foot")) else tilt, walker[name][:F] - hips)
        for name in names
    ], axis=1)  # fmt: skip
    titles = ",".join(f"{name}_{axis}" for name in names for axis in "xyz")
    np.savetxt(path, points.reshape(F, -1), delimiter=",", header=titles, comments="")
    return path


def parameters(path, tilt_deg):
    """Write SMPL of an actor who walks away from a camera, with Y down, that looks down."""
    swing = 0.3 * np.sin(np.linspace(0.0, 12.0, F))
    body = np.zeros((F, 63))
    body[:, 0], body[:, 3] = swing, -swing
    turn = quaternion_from_euler(np.radians([[180.0 + tilt_deg, 0.0, 0.0]]), "XYZ")[0]
    steps = np.stack([np.zeros(F), np.zeros(F), np.linspace(0.0, 2.0, F)], axis=1)
    np.savez(
        path,
        global_orient=np.tile(rotation_vector_from_quaternion(turn), (F, 1)),
        body_pose=body,
        transl=rotate(turn, steps) + np.array([0.0, 0.0, 4.0]),
    )
    return path


def read(path, floor=FloorPlacement.AUTO, **settings):
    said: list[str] = []
    recording = read_as(
        path,
        ReadingSettings(**settings),
        floor=floor,
        progress=lambda _, text="": said.append(str(text)),
    )
    return recording, " ".join(said)


def trunk(recording, low, high):
    """Return the mean direction between two joints."""
    if isinstance(recording, Motion):
        names = recording.skeleton.names
        poses = world_poses(recording.skeleton, recording.rotations, recording.root_positions)
        points = poses.positions
    else:
        names, points = recording.names, recording.tracks.positions
    along = (points[:, names.index(high)] - points[:, names.index(low)]).mean(axis=0)
    return along / np.linalg.norm(along)


@pytest.mark.parametrize("tilt_deg", [-25.0, 0.0, 25.0])
def test_joints_of_a_tilted_camera_stand(tmp_path, walker, tilt_deg):
    recording, said = read(joints(tmp_path / "take.csv", walker, tilt_deg))

    assert trunk(recording, "pelvis", "head")[2] > np.cos(np.radians(8.0))
    assert (LEANS in said) == (tilt_deg != 0.0)
    assert ("is turned upright" in said) == (tilt_deg != 0.0)


@pytest.mark.parametrize("sensor", [Sensor.KINECT_V2, Sensor.OTHER])
def test_a_small_lean_is_that_of_a_kinect(tmp_path, walker, sensor):
    """Its axes are always those of the camera; of others the actor may lean."""
    tilted, _ = read(joints(tmp_path / "take.csv", walker, 7.0), FloorPlacement.NEVER)
    said: list[str] = []

    turned = level(
        JointRecording(tilted.tracks, None, sensor), lambda _, text="": said.append(str(text))
    )

    before, after = (trunk(each, "pelvis", "head")[2] for each in (tilted, turned))
    assert before < np.cos(np.radians(8.0))
    assert (after > np.cos(np.radians(5.0))) == bool(said) == (sensor is Sensor.KINECT_V2)


def test_who_sits_with_straight_legs_leans_by_intention(tmp_path, walker):
    recording, said = read(joints(tmp_path / "take.csv", walker, 0.0, bend_deg=60.0))

    assert trunk(recording, "pelvis", "head")[2] > np.cos(np.radians(8.0))
    assert LEANS not in said


def test_smpl_in_the_axes_of_a_tilted_camera_stands_on_a_level_floor(tmp_path):
    motion, said = read(parameters(tmp_path / "take.npz", 25.0))

    assert trunk(motion, "pelvis", "head")[2] > np.cos(np.radians(5.0))
    assert np.ptp(motion.root_positions[:, 2]) < 0.1
    assert "is turned upright" in said


@pytest.mark.parametrize("keeps", [{"floor": FloorPlacement.NEVER}, {"up": Axis.Z}])
def test_axes_that_are_kept_are_questioned(tmp_path, walker, keeps):
    recording, said = read(joints(tmp_path / "take.csv", walker, 25.0), **keeps)

    assert trunk(recording, "pelvis", "head")[2] < np.cos(np.radians(15.0))
    assert LEANS in said
    assert "is turned upright" not in said
