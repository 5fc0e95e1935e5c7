"""A short recording of depth whose joints are known, as points in the scene."""

import numpy as np
import pytest


@pytest.fixture
def n_frames():
    return 6


@pytest.fixture
def truth(recordings, n_frames):
    """The first frames of a walk towards the camera: pictures, joints, camera."""
    with np.load(recordings / "depth" / "truth" / "walk_front.npz") as archive:
        return {
            name: archive[name][:n_frames] if archive[name].ndim > 2 else archive[name]
            for name in archive.files
        }


@pytest.fixture
def points(truth, blank, tmp_path):
    """The object that Import makes of it."""
    path = tmp_path / "walk.npz"
    np.savez_compressed(path, **truth)
    blank.context.scene.render.fps = 30
    said = blank.ops.mocap_assist.import_recording(filepath=str(path))
    assert said == {"FINISHED"}
    return blank.context.object
