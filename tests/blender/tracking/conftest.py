"""A short depth recording with true joints, as points in the scene."""

from types import SimpleNamespace

import numpy as np
import pytest

FAST_SETTINGS = {"backward": False, "refine": False, "plant_feet": False}


@pytest.fixture(autouse=True)
def end_is_noticed_late(load, monkeypatch):
    """Report the end one check late; a solve may end before the first check."""
    job, ended = load("mocap_assist.jobs.job").Job, set()
    done = job.done

    def done_since_last_time(self):
        if not done(self):
            return False
        late = id(self) in ended
        ended.add(id(self))
        return late

    monkeypatch.setattr(job, "done", done_since_last_time)


@pytest.fixture
def n_frames():
    return 6


@pytest.fixture
def truth(recordings, n_frames):
    """The first frames of a walk toward the camera: pictures, joints, camera."""
    with np.load(recordings / "depth" / "truth" / "walk_front.npz") as archive:
        return {
            name: archive[name][:n_frames] if archive[name].ndim > 2 else archive[name]
            for name in archive.files
        }


@pytest.fixture
def points(truth, blank, tmp_path):
    """The object that Import makes of the recording."""
    path = tmp_path / "walk.npz"
    np.savez_compressed(path, **truth)
    blank.context.scene.render.fps = 30
    status = blank.ops.mocap_assist.import_recording(filepath=str(path))
    assert status == {"FINISHED"}
    return blank.context.object


@pytest.fixture(scope="session")
def shelf(tmp_path_factory):
    """A cache of scenes that take long to make, for all tests that start with the same one."""
    return tmp_path_factory.mktemp("shelf")


@pytest.fixture
def walk(truth, n_frames, blank, shelf):
    """The scene with points and the armature that Track made of them, tracked but once."""
    folder = shelf / str(n_frames)
    path, scene = folder / "walk.npz", folder / "tracked.blend"
    if not scene.exists():
        folder.mkdir(exist_ok=True)
        np.savez_compressed(path, **truth)
        blank.context.scene.render.fps = 30
        blank.ops.mocap_assist.import_recording(filepath=str(path))
        assert blank.ops.mocap_assist.track_depth(**FAST_SETTINGS) == {"FINISHED"}
        blank.ops.wm.save_as_mainfile(filepath=str(scene), copy=True)
    blank.ops.wm.open_mainfile(filepath=str(scene))
    objects = {each.type: each for each in blank.data.objects}
    return SimpleNamespace(points=objects["MESH"], armature=objects["ARMATURE"])
