"""Takes to export, the button, and what the file shows when it is imported again."""

import numpy as np
import pytest


@pytest.fixture
def walk(make_dancer):
    """A figure of 13 bones, 1.7 m tall, in smooth motion for two seconds at 30 Hz."""
    return make_dancer(60)


@pytest.fixture
def export(blank, tmp_path):
    """Press Export Clean Take; return the file."""

    def press(name="out.fbx", **settings):
        path = tmp_path / name
        done = blank.ops.mocap_assist.export_take(filepath=str(path), **settings)
        assert done == {"FINISHED"}
        return path

    return press


@pytest.fixture
def bring(blank):
    """Import a file with our own importer, at its own rate; return the armature."""

    def press(path, **settings):
        settings = {"place_on_floor": "NEVER", "frame_rate": "UPDATE"} | settings
        blank.context.scene.render.fps, blank.context.scene.render.fps_base = 24, 1.0
        assert blank.ops.mocap_assist.import_recording(filepath=str(path), **settings) == {
            "FINISHED"
        }
        return blank.context.object

    return press


@pytest.fixture
def heads(blank):
    """World positions of the heads of bones as shown, (n_frames, n_bones, 3), scene units."""

    def shown(armature, frames, bones):
        found = []
        for frame in frames:
            blank.context.scene.frame_set(int(frame))
            found.append([
                np.array(armature.matrix_world @ armature.pose.bones[bone].head)
                for bone in bones
            ])
        return np.array(found)

    return shown
