"""The button Import, pressed by a script or in a window."""

from types import SimpleNamespace

import numpy as np
import pytest
from depth_files import depth_npz

WALK = "07_01.bvh"


@pytest.fixture
def bring(blank):
    """Press Import; return the active object."""

    def press(*paths, **settings):
        files = [{"name": path.name} for path in paths]
        status = blank.ops.mocap_assist.import_recording(
            directory=str(paths[0].parent), files=files, **settings
        )
        assert status == {"FINISHED"}
        return blank.context.object

    return press


@pytest.fixture
def markers_of(load):
    """The markers below an object."""
    return load("mocap_assist.actions.markers.holders").markers_of


@pytest.fixture
def key_times():
    """Scene frames of the keys of an armature's root."""

    def read(armature):
        action = armature.animation_data.action
        bag = action.layers[0].strips[0].channelbag(armature.animation_data.action_slot)
        curve = next(each for each in bag.fcurves if each.data_path.endswith("location"))
        return np.array([key.co.x for key in curve.keyframe_points])

    return read


@pytest.fixture
def walks(recordings, tmp_path):
    """Three files of a folder of their own: two walks, and between them one that is cut."""
    content = (recordings / "mocap" / "cmu_walk" / WALK).read_bytes()
    for name in ("first.bvh", "second.bvh"):
        (tmp_path / name).write_bytes(content)
    (tmp_path / "cut.bvh").write_bytes(content[:9000])
    return tmp_path


@pytest.fixture
def press(load, window, walks):
    """Import files of the folder; return the operator, which waits."""
    button_settings = load("mocap_assist.importing.button_settings")
    module = load("mocap_assist.importing.dialog.operators")

    def start(*names, **chosen):
        class Operator(module.WaitingImport):
            directory, filepath = str(walks), ""
            files = tuple(SimpleNamespace(name=name) for name in names)
            poll_message_set = window.reports.append

            def settings(self):
                return button_settings.ImportBundle(button_settings.ImportChoices(**chosen))

            def report(self, kind, message):
                window.reports.append((kind, message))

        operator = Operator()
        assert operator.invoke(window.context, None) == {"RUNNING_MODAL"}
        return operator

    return start


@pytest.fixture
def depth() -> np.ndarray:
    """A wall three meters away that comes nearer by a decimeter each frame; a hole in it."""
    pictures = np.full((8, 60, 80), 3000, np.uint16)
    pictures -= np.arange(8, dtype=np.uint16)[:, None, None] * 100
    pictures[:, 10:20, 10:20] = 0
    return pictures


@pytest.fixture
def archive(tmp_path, depth):
    path = tmp_path / "wall.npz"
    content = depth_npz(depth, fx=90.0, fy=90.0, cx=39.5, cy=29.5, frame_rate=30.0)
    path.write_bytes(content)
    return path
