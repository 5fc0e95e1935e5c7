"""A Kinect walk with an occluded left forearm, as an armature; and the button Reconstruct."""

import pytest
from kinect_walks import tracked_walk, true_positions


@pytest.fixture
def truth(load):
    """Where the twenty joints truly are, shape (90, 20, 3)."""
    return true_positions(
        load("solvers.samples"), load("solvers.motion.humanoid.posture_joints")
    )


@pytest.fixture
def bring(blank):
    """Press Import; return the active object."""

    def press(path, **settings):
        blank.context.scene.render.fps = 30
        status = blank.ops.mocap_assist.import_recording(filepath=str(path), **settings)
        assert status == {"FINISHED"}
        return blank.context.object

    return press


@pytest.fixture
def walk_file(load, truth, tmp_path):
    """The recording, in a file."""
    path = tmp_path / "walk.csv"
    load("solvers.recordings").write_joint_csv(
        tracked_walk(load("solvers.motion"), truth), path
    )
    return path


@pytest.fixture
def walk(bring, walk_file):
    """The armature."""
    return bring(walk_file)


@pytest.fixture
def reconstruct(blank):
    """Press Reconstruct; return the action that is played then."""

    def press(**settings):
        settings = {"plant_feet": False} | settings
        assert blank.ops.mocap_assist.reconstruct(**settings) == {"FINISHED"}
        return blank.context.object.animation_data.action

    return press
