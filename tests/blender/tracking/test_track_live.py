"""Track Live: a folder that a recorder writes becomes an armature, as Track makes one."""

import json
import threading
import time

import numpy as np
import pytest
from depth_folders import save_png

RATE_HZ = 30.0
CAMERA = {"unit": "MILLIMETRES", "focal_length": 285.63}
FAST = {"calibration": 0.5, "max_silence": 1.0, "max_wait": 20.0, "refine": False}


@pytest.fixture
def n_frames():
    return 76


@pytest.fixture
def images(truth):
    """A walk toward the camera, and back."""
    return [*truth["depth"], *truth["depth"][::-1]]


@pytest.fixture
def recorder(images, tmp_path):
    """Start to write images into a folder at the rate of a camera; return the folder."""
    threads, ended = [], threading.Event()

    def start(n_images=None, rate=RATE_HZ):
        folder = tmp_path / "take"

        def write():
            for number, image in enumerate(images[:n_images]):
                save_png(folder / f"{number:06}.png", image)
                if ended.wait(1.0 / rate):
                    return

        threads.append(threading.Thread(target=write))
        threads[-1].start()
        return folder

    yield start
    ended.set()
    for thread in threads:
        thread.join()


def test_armature_of_a_followed_recording(recorder, blank, truth):
    folder = recorder()
    began = time.monotonic()
    print(blank.ops.mocap_assist.track_live(recording_file=str(folder), **CAMERA, **FAST))
    print(time.monotonic() - began)
    armature = blank.context.object
    print(armature, armature.animation_data.action.frame_range[:])
    print(json.loads(armature.animation_data.action["mocap_assist_captured"]))
    print(blank.context.scene.mocap_assist.report)
    print(
        blank.context.scene.frame_end, blank.context.scene.render.fps, list(blank.data.objects)
    )
