"""Previews show every pose, and the last ones are the result."""

from importlib import import_module

import numpy as np
import pytest
from drawn_bodies import CAMERA, recorded, waving
from numpy.testing import assert_allclose, assert_array_equal

from solvers.depth_scene.recording import DepthRecording
from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.capturing.capture import CaptureSettings, capture
from solvers.depth_tracking.capturing.unfinished_capture import unfinished_capture
from solvers.depth_tracking.tracking.pose_preview import offset_frames
from solvers.errors import InvalidMotionError


def test_previews_cover_every_pass_and_end_with_the_result():
    observed = []
    found = capture(recorded(waving(6)), default_body(), on_pose=observed.append)

    frames = [one.frame for one in observed]
    assert frames == [*range(6), *range(5, -1, -1), *range(6)]
    last = {one.frame: one.pose for one in observed}
    assert_array_equal(np.array([last[frame] for frame in range(6)]), found.poses)
    assert all(one.body is found.body for one in observed)
    assert all(one.quality.confidence.shape == (21,) for one in observed)


def test_previews_have_recording_frames_during_body_estimation(monkeypatch):
    """The actor approaches and is visible from frame 4 on."""
    module = import_module("solvers.depth_tracking.capturing.find_body")
    monkeypatch.setattr(module, "CLIP_FRAMES", 4)
    truth = waving(8)
    truth[:, 2] = np.linspace(3.2, 2.8, 8)
    drawn = recorded(truth)

    def read(frame):
        return np.zeros((120, 160), np.float32) if frame < 4 else drawn.frame(frame)

    observed = []
    settings = CaptureSettings(backward=False, smoothing=0.0)
    found = capture(DepthRecording(CAMERA, 8, 30.0, read), settings=settings,
                    on_pose=observed.append)  # fmt: skip

    looked_for = [one for one in observed if one.body is not found.body]
    frames = [one.frame for one in looked_for]
    assert set(frames) <= {4, 5, 6, 7} and len(frames) >= 4
    assert_allclose([one.pose[2] for one in looked_for], truth[frames, 2], atol=0.04)


def test_offset_frames_shifts_previews():
    observed = []
    one = capture(
        recorded(waving(2)), default_body(),
        settings=CaptureSettings(backward=False), on_pose=offset_frames(observed.append, 7),
    )  # fmt: skip
    assert [each.frame for each in observed] == [7, 8, 7, 8] and len(one.poses) == 2


def test_unfinished_capture_keeps_tracked_frames():
    """Of 10 frames tracked forward and backward, the last 7 were tracked twice."""
    truth = waving(10)
    observed = []
    complete = capture(recorded(truth), default_body(), on_pose=observed.append,
                    settings=CaptureSettings(smoothing=0.0))  # fmt: skip

    first, some = unfinished_capture(observed[:6], 30.0)
    assert first == 0 and some.motion.n_frames == 6
    assert_array_equal(some.poses, [one.pose for one in observed[:6]])
    _, unfinished = unfinished_capture(observed[:17], 30.0)
    assert unfinished.motion.n_frames == 10
    assert_array_equal(unfinished.poses[:3], [one.pose for one in observed[:3]])
    _, all_of_it = unfinished_capture(observed[:20], 30.0)
    assert_array_equal(all_of_it.poses, complete.poses)
    assert_allclose(all_of_it.motion.rotations, complete.motion.rotations, atol=1e-12)


def test_unfinished_capture_ignores_earlier_bodies_and_raises_without_poses():
    observed = []
    capture(recorded(waving(4)), default_body(), on_pose=observed.append,
            settings=CaptureSettings(backward=False, smoothing=0.0))  # fmt: skip
    other = default_body(1.6)
    before = [one._replace(body=other, frame=one.frame + 20) for one in observed]

    repeated = [one._replace(frame=7) for one in observed[:1]]
    first, unfinished = unfinished_capture([*before, *repeated],
                                     30.0)  # fmt: skip

    assert (
        first == 7 and unfinished.motion.n_frames == 1 and unfinished.body is observed[0].body
    )
    with pytest.raises(InvalidMotionError, match="No pose was tracked yet"):
        unfinished_capture([], 30.0)
