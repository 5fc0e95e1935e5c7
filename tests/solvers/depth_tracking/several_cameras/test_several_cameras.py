"""One body in the images of two cameras: exact where one camera is, better where limbs hide."""

from dataclasses import replace

import numpy as np
import pytest
from drawn_bodies import NATURAL, observed, posed, recorded, waving
from numpy.testing import assert_allclose, assert_array_equal

from solvers.depth_scene import DepthRecording, FloorPlane
from solvers.depth_tracking.body.coordinates import COORDINATES
from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.body.pose_priors import stay_near
from solvers.depth_tracking.body.segment_kinematics import joint_positions, segment_frames
from solvers.depth_tracking.body.tables import JOINTS
from solvers.depth_tracking.capturing import CaptureMethod, CaptureSettings, capture
from solvers.depth_tracking.several_cameras import CameraAlignment, capture_cameras
from solvers.depth_tracking.several_cameras.align_tracks import FIRST_CAMERA
from solvers.depth_tracking.several_cameras.capture_cameras import floor_of_first_camera
from solvers.depth_tracking.several_cameras.capture_views import capture_views
from solvers.depth_tracking.several_cameras.refine_alignment import refine_alignment
from solvers.depth_tracking.several_cameras.register_views import register_views
from solvers.depth_tracking.several_cameras.track_views import ViewedActor, velocities
from solvers.depth_tracking.several_cameras.transfer_poses import poses_at, transfer_poses
from solvers.depth_tracking.several_cameras.views import CameraTake, View, render_view
from solvers.depth_tracking.terms import DEFAULT_TRACKER
from solvers.depth_tracking.tracking import register_pose
from solvers.errors import InvalidMotionError, InvalidSettingError, SolveCancelled
from solvers.progress import unwatched

BODY = default_body()
FAST = CaptureSettings(backward=False, check_every=1000)
OFFSET_S = 6.5 / 30.0
SIDE = np.array([
    [0.0, 0.0, 1.0, -2.8],
    [0.0, 1.0, 0.0, 0.1],
    [-1.0, 0.0, 0.0, 2.9],
    [0.0, 0.0, 0.0, 1.0],
])
"""camera_from_first of a camera at the right of the actor, 2.9 m away."""
FIRST = np.eye(4)
HAND = JOINTS.index("leftHand")


def joints_of(poses):
    return joint_positions(BODY, segment_frames(BODY, poses))


def view_of(pose, transform=FIRST, displacement=None):
    moved = transfer_poses(BODY, pose[None], transform)[0]
    none = np.zeros(len(pose)) if displacement is None else displacement
    return View(observed(moved), transform, none)


def hiding(n_frames):
    """Return an actor who turns the left side away, swings the left arm behind and waves."""
    poses = waving(n_frames)
    poses[:, COORDINATES.index("yaw")] = -1.2
    swing = np.sin(np.arange(n_frames) / 6.0)
    poses[:, 0] += 0.25 * np.sin(np.arange(n_frames) / 5.0)
    poses[:, 2] += 0.01 * np.arange(n_frames)
    poses[:, COORDINATES.index("leftHumerusX")] = 0.4 * swing
    poses[:, COORDINATES.index("leftHumerusZ")] = 0.3
    return poses


def both_recordings(poses):
    """Return the recordings of both cameras; the second begins six and a half frames later."""
    side = transfer_poses(BODY, poses_at(poses, np.arange(len(poses) - 7) + 6.5), SIDE)
    return recorded(poses), recorded(side)


@pytest.fixture(scope="module")
def takes():
    poses = hiding(32)
    recordings = both_recordings(poses)
    return poses, capture_cameras(recordings, BODY, settings=FAST)


def test_one_view_at_the_first_camera_gives_the_pose_of_one_camera_to_the_bit():
    start = NATURAL + 0.03

    def prior(pose):
        return stay_near(pose, start, np.full(36, 3.0))

    view = view_of(NATURAL)
    alone = register_pose(BODY, start, view.observation, prior)
    seen = register_views(BODY, start, [view], prior)

    assert_array_equal(seen.pose, alone.pose)
    assert seen.iterations == alone.iterations


def test_twists_are_the_derivatives_in_the_frame_of_the_camera():
    displacement = 0.02 * np.cos(np.arange(36.0))
    hypothesis = render_view(BODY, NATURAL, view_of(NATURAL, SIDE, displacement))
    step = 1e-6
    for coordinate in range(36):
        change = step * np.eye(36)[coordinate]
        ahead, behind = (
            SIDE @ segment_frames(BODY, NATURAL + displacement + sign * change)
            for sign in (1.0, -1.0)
        )
        points = hypothesis.frames[:, :3, 3]
        twist = hypothesis.twists[:, :, coordinate]
        expected = (ahead - behind)[:, :3, 3] / (2.0 * step)
        assert_allclose(np.cross(twist[:, :3], points) + twist[:, 3:], expected, atol=1e-6)


def test_transferred_poses_have_the_moved_joints():
    poses = waving(40)
    poses[:, COORDINATES.index("yaw")] += np.linspace(0.0, 7.0, 40)

    moved = transfer_poses(BODY, poses, SIDE)

    expected = joints_of(poses) @ SIDE[:3, :3].T + SIDE[:3, 3]
    assert_allclose(joints_of(moved), expected, atol=1e-9)
    assert np.abs(np.diff(moved[:, 3:6], axis=0)).max() < 1.0
    back = transfer_poses(BODY, moved, np.linalg.inv(SIDE))
    assert_allclose(joints_of(back), joints_of(poses), atol=1e-9)


def test_poses_between_frames_are_means_and_missing_outside():
    found = poses_at(np.array([[0.0], [2.0], [3.0]]), np.array([-0.1, 0.0, 0.5, 2.0, 2.1]))

    assert_array_equal(found[:, 0], [np.nan, 0.0, 1.0, 3.0, np.nan])


def test_second_view_moves_a_hidden_arm_to_its_place():
    truth = posed(yaw=-1.5, leftHumerusZ=0.5, leftRadius=0.3)
    start = posed(yaw=-1.5, leftHumerusZ=0.2, leftRadius=0.3)

    def prior(pose):
        return stay_near(pose, start, np.array([0.0] * 6 + [1.0] * 30))

    def hand_error(views):
        found = register_views(BODY, start, views, prior)
        return np.linalg.norm(joints_of(found.pose) - joints_of(truth), axis=-1)[HAND]

    front, side = view_of(truth), view_of(truth, SIDE)
    assert hand_error([front]) > 0.08
    assert hand_error([front, side]) < 0.02


def test_images_between_frames_are_compared_at_their_own_time():
    """The second image is half a frame late; without the velocity the pose is a mean."""
    rate = np.zeros(36)
    rate[COORDINATES.index("rootX")] = 0.04
    late = view_of(NATURAL + rate / 2.0, SIDE)

    def prior(pose):
        return stay_near(pose, NATURAL, np.zeros(36))

    def error(view):
        found = register_views(BODY, NATURAL, [view], prior).pose
        return np.abs(found - NATURAL)[:3].max()

    assert error(late) > 0.015
    assert error(replace(late, displacement=rate / 2.0)) < 0.003


def test_two_cameras_are_aligned_and_show_what_one_hides(takes):
    poses, found = takes
    truth = joints_of(poses)

    alignment = found.alignments[1]
    assert alignment.offset == pytest.approx(OFFSET_S, abs=0.01)
    assert alignment.angle_to(SIDE) < 1.5
    assert np.linalg.norm(np.linalg.inv(alignment.camera_from_first)[:3, 3]
                          - np.linalg.inv(SIDE)[:3, 3]) < 0.06  # fmt: skip
    alone, both = (
        np.linalg.norm(each.joints.positions - truth, axis=-1)[8:]
        for each in (found.alone[0], found.captured)
    )
    assert both[:, HAND].mean() < 0.5 * alone[:, HAND].mean()
    assert both.mean() < alone.mean()


def test_result_has_the_frames_and_the_frame_of_the_first_camera(takes):
    poses, found = takes
    assert found.captured.motion.n_frames == len(poses)
    assert found.captured.joints.names == JOINTS
    assert found.alignments[0] is FIRST_CAMERA
    assert found.captured.body is BODY
    for own, recording in zip(found.alone, both_recordings(poses), strict=True):
        expected = capture(recording, BODY, settings=FAST)
        assert_array_equal(own.joints.positions, expected.joints.positions)


def test_images_correct_a_displaced_camera_and_time():
    poses = hiding(24)
    wrong = SIDE.copy()
    wrong[:3, 3] += (0.05, -0.04, 0.06)
    alignment = CameraAlignment(wrong, OFFSET_S + 0.008, 0.02)
    first, second = both_recordings(poses)
    actor = ViewedActor(
        (CameraTake(first, FIRST_CAMERA), CameraTake(second, alignment)), BODY, DEFAULT_TRACKER
    )
    given = {frame: poses[frame] for frame in range(7, 23)}

    refined = refine_alignment(actor, given, velocities(poses), unwatched)

    found = refined.cameras[1].alignment
    assert np.abs(found.camera_from_first[:3, 3] - SIDE[:3, 3]).max() < 0.01
    assert abs(found.offset - OFFSET_S) < 0.008
    assert refined.cameras[0].alignment is FIRST_CAMERA


def test_floor_of_another_camera_is_the_same_plane():
    floor = FloorPlane(np.array([0.0, -1.0, 0.0]), 1.2)
    alignment = CameraAlignment(SIDE, 0.0, 0.0)
    points = np.array([[0.2, 0.9, 3.0], [1.0, -0.4, 2.0]])

    moved = floor_of_first_camera(floor, alignment)

    in_camera = points @ SIDE[:3, :3].T + SIDE[:3, 3]
    assert_allclose(moved.heights(points), floor.heights(in_camera))


def test_frames_that_only_the_second_camera_shows_are_tracked(takes):
    poses, known = takes
    first, second = both_recordings(poses)

    def read(frame):
        image = first.frame(frame)
        return np.zeros_like(image) if 14 <= frame < 19 else image

    blind = DepthRecording(first.camera, first.n_frames, first.frame_rate, read)
    cameras = tuple(map(CameraTake, (blind, second), known.alignments))
    actor = ViewedActor(cameras, BODY, DEFAULT_TRACKER)
    found = capture_views(actor, known.alone, settings=FAST)

    errors = np.linalg.norm(found.joints.positions - joints_of(poses), axis=-1)
    assert errors[14:19].mean() < 0.06
    assert np.isfinite(found.residual[14:19]).all()


def test_wrong_requests_are_refused_in_one_sentence():
    poses = hiding(12)
    one = recorded(poses)
    with pytest.raises(InvalidMotionError, match="at least two recordings"):
        capture_cameras([one], BODY)
    published = CaptureSettings(method=CaptureMethod.REGISTRATION)
    with pytest.raises(InvalidSettingError, match="tracks one person in the complete"):
        capture_cameras([one, one], BODY, settings=published)
    still = recorded(np.tile(NATURAL, (16, 1)))
    with pytest.raises(InvalidMotionError, match="Camera 2: The actor stands still"):
        capture_cameras([still, still], BODY, settings=FAST)
    empty = replace(one, read_depth=lambda frame: np.zeros((120, 160), np.float32))
    with pytest.raises(InvalidMotionError, match="Camera 2: No person"):
        capture_cameras([one, empty], BODY, settings=FAST)


def test_cancelled_capture_raises():
    def cancel(fraction, message=""):
        if fraction > 0.1:
            raise SolveCancelled

    with pytest.raises(SolveCancelled):
        capture_cameras(both_recordings(hiding(24)), BODY, settings=FAST, progress=cancel)


def test_straight_walk_keeps_the_time_of_the_skeletons():
    """A body that glides is the same a moment later, at another place."""
    poses = np.tile(NATURAL, (24, 1))
    poses[:, 0] = np.linspace(-0.2, 0.2, 24)
    wrong = SIDE.copy()
    wrong[:3, 3] += (0.05, -0.04, 0.06)
    first, second = both_recordings(poses)
    actor = ViewedActor(
        (
            CameraTake(first, FIRST_CAMERA),
            CameraTake(second, CameraAlignment(wrong, OFFSET_S, 0.02)),
        ),
        BODY,
        DEFAULT_TRACKER,
    )
    given = {frame: poses[frame] for frame in range(7, 23)}

    found = refine_alignment(actor, given, velocities(poses), unwatched).cameras[1].alignment

    assert abs(found.offset - OFFSET_S) < 0.02
    at_this_time = found.camera_from_first[:3, 3] - SIDE[:3, 3]
    assert np.abs(at_this_time[:2]).max() < 0.015


def test_views_move_the_body_to_the_time_of_their_image():
    """The second camera begins 6.5 frames later: its nearest image is half a frame off."""
    alignments = FIRST_CAMERA, CameraAlignment(SIDE, OFFSET_S, 0.02)
    cameras = tuple(map(CameraTake, both_recordings(hiding(12)), alignments))
    actor = ViewedActor(cameras, BODY, DEFAULT_TRACKER)
    rate = np.linspace(-1.0, 1.0, 36)

    own, other = actor.views(9, rate)

    assert_array_equal(own.displacement, 0.0 * rate)
    assert_allclose(np.abs(other.displacement), 0.5 * np.abs(rate), atol=1e-9)
    image = cameras[1].image_at(9 / 30.0)
    assert_allclose(other.displacement, (image + 6.5 - 9.0) * rate, atol=1e-9)
    assert len(actor.views(3, rate)) == 1
