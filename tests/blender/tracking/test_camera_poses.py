"""Points and armature have the same world positions for any camera pose."""

import numpy as np
import pytest
from mathutils import Matrix

MOVED = (
    Matrix.Translation((3.0, 1.0, 0.5)) @ Matrix.Rotation(0.4, 4, "Z") @ Matrix.Scale(2.0, 4)
)


@pytest.fixture
def stood(load):
    """The floor below a camera that was rolled and tilted, in degrees."""

    def stood(roll, tilt):
        floor = load("solvers.depth_scene.floor").FloorPlane
        roll, tilt = np.radians([roll, tilt])
        up = (np.sin(roll) * np.cos(tilt), -np.cos(roll) * np.cos(tilt), -np.sin(tilt))
        return floor(np.array(up), 1.3)

    return stood


@pytest.mark.parametrize("roll, tilt", [(0.0, 20.0), (10.0, 0.0), (5.0, 30.0), (-12.0, 15.0)])
@pytest.mark.parametrize("matrix", [None, MOVED])
def test_armature_and_points_agree_for_any_camera_pose(
    roll, tilt, matrix, stood, write_tracked, given_poses, load, blank
):
    made = write_tracked(floor=stood(roll, tilt), matrix=matrix)
    frames = load("solvers.depth_tracking.body.segment_kinematics").segment_frames(
        made.body, given_poses
    )
    shown = load("mocap_assist.track.tracked_armature.body").posed_frames
    for picture in (0, 11):
        blank.context.scene.frame_set(1 + picture)
        through_points = np.array(made.points.matrix_world) @ frames[picture]
        through_bones = np.array(made.armature.matrix_world) @ shown(made.armature, made.body)
        np.testing.assert_allclose(through_bones, through_points, atol=1e-4)
