"""Bodies that share one depth buffer: hidden limbs, owners of pixels, complete captures."""

from dataclasses import replace

import numpy as np
import pytest
from drawn_bodies import CAMERA, NATURAL, drawn, posed, recorded, waving

from solvers.depth_scene.find_people import find_people
from solvers.depth_scene.recording import DepthRecording
from solvers.depth_scene.share_pixels import NO_OWNER
from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.body.segment_kinematics import joint_positions, segment_frames
from solvers.depth_tracking.body.tables import CAPSULES, JOINTS
from solvers.depth_tracking.capturing.capture import CaptureSettings, capture
from solvers.depth_tracking.capturing.capture_method import CaptureMethod
from solvers.depth_tracking.several_bodies.capture_people import capture_people
from solvers.depth_tracking.several_bodies.shared_images import SharedImages
from solvers.depth_tracking.several_bodies.surface_distances import surface_distances
from solvers.depth_tracking.terms.hypothesis import render_hypothesis
from solvers.depth_tracking.tracking.track_pose import track_pose
from solvers.errors import InvalidMotionError, InvalidSettingError

BODY = default_body()
UP = np.array([0.0, -1.0, 0.0])
FORWARD = CaptureSettings(backward=False, check_every=1000)


def joints_of(poses):
    return joint_positions(BODY, segment_frames(BODY, poses))


def placed(poses, right=0.0, farther=0.0):
    """Return poses that are moved to the right and away from the camera, meters."""
    moved = np.array(poses)
    moved[..., 0] += right
    moved[..., 2] += farther
    return moved


def merged(*people):
    """Return the depth of all people in one pose each, and who is visible, -1 for none."""
    depths = np.stack([
        drawn(pose) if pose is not None else np.zeros((120, 160)) for pose in people
    ])
    depths = np.where(depths > 0.0, depths, np.inf)
    nearest = depths.min(axis=0)
    seen = np.isfinite(nearest)
    return np.where(seen, nearest, 0.0), np.where(seen, depths.argmin(axis=0), NO_OWNER)


def recorded_together(*people, frame_rate=30.0):
    """Return the recording of people in these poses, each (n_frames, 36); NaN is absent."""
    images = [
        merged(*(pose if np.isfinite(pose).all() else None for pose in poses))[0].astype("f4")
        for poses in zip(*people, strict=True)
    ]
    return DepthRecording(CAMERA, len(images), frame_rate, images.__getitem__)


def shared(recording, *centers):
    centers = np.array([np.broadcast_to(one, (recording.n_frames, 3)) for one in centers])
    return SharedImages(recording, (BODY,) * len(centers), centers, UP, 160)


def test_what_is_behind_occluders_is_not_rendered():
    """The z-buffer of two bodies is what each shows in front of the other."""
    front, back = placed(NATURAL, 0.1), placed(NATURAL, -0.1, 0.6)
    _, owners = merged(front, back)

    for pose, other, index in ((front, back, 0), (back, front, 1)):
        image = render_hypothesis(BODY, pose, CAMERA, drawn(other)).image

        visible = np.zeros(120 * 160, dtype=bool)
        visible[image.pixels] = True
        np.testing.assert_array_equal(visible.reshape(120, 160), owners == index)


def test_without_occluders_everything_is_rendered():
    image = render_hypothesis(BODY, NATURAL, CAMERA, np.zeros((120, 160))).image

    np.testing.assert_array_equal(image.depth_image(), drawn(NATURAL))


def test_hidden_half_is_no_evidence_against_a_pose():
    """A board covers the left half; if it is unknown, the body is pulled to the right half."""
    poses = waving(16)
    board = np.where(np.arange(160) < 80, 2.0, 0.0) * np.ones((120, 1), dtype="f4")
    images = [np.where(board > 0.0, 0.0, drawn(pose)).astype("f4") for pose in poses]
    cut = DepthRecording(CAMERA, len(images), 30.0, images.__getitem__)
    hidden = replace(cut, read_occluders=lambda frame: board)

    found = [track_pose(one, BODY, poses[0]) for one in (hidden, cut)]

    errors = [
        np.linalg.norm(one.joints.positions - joints_of(poses), axis=-1).mean() for one in found
    ]
    assert errors[0] < 0.02 and errors[1] > 0.06
    assert found[0].coverage.mean() > 0.98 > 0.9 > found[1].coverage.mean()


def test_distances_to_the_surface():
    """Zero on it; outside and inside the head nearly as far, where no neck is nearer."""
    hypothesis = render_hypothesis(BODY, NATURAL, CAMERA)
    points, normals = hypothesis.points, hypothesis.normals

    assert np.abs(surface_distances(BODY, NATURAL, points)).max() < 1e-9

    head = hypothesis.image.capsules == CAPSULES.index("head")
    outside = surface_distances(BODY, NATURAL, (points + 0.05 * normals)[head])
    inside = surface_distances(BODY, NATURAL, (points - 0.02 * normals)[head])
    assert outside.max() < 0.052 and np.median(outside) == pytest.approx(0.05, abs=0.001)
    assert np.median(inside) == pytest.approx(-0.02, abs=0.001)


def test_pixels_belong_to_the_nearest_surface():
    front, back = placed(NATURAL, 0.25), placed(waving(20)[-1], -0.25, 0.3)
    depth, owners = merged(front, back)
    images = shared(DepthRecording(CAMERA, 1, 30.0, lambda _: depth), front[:3], back[:3])

    found = images.owners(0, [front, back])

    seen = depth > 0.0
    assert (found[seen] == owners[seen]).mean() > 0.99


def test_untracked_person_owns_the_component_at_the_center():
    left, right = placed(NATURAL, -0.7), placed(NATURAL, 0.7)
    depth, owners = merged(left, right)
    images = shared(DepthRecording(CAMERA, 1, 30.0, lambda _: depth), left[:3], right[:3])

    found = images.owners(0, [left, None])

    seen = depth > 0.0
    assert (found[seen] == owners[seen]).all()


def test_what_is_far_from_all_bodies_has_no_owner():
    depth, _ = merged(placed(NATURAL, -0.8), placed(NATURAL, 0.8))
    left = placed(NATURAL, -0.8)
    images = shared(DepthRecording(CAMERA, 1, 30.0, lambda _: depth), left[:3])

    found = images.owners(0, [left])

    right_half = depth[:, 80:] > 0.0
    assert (found[:, 80:][right_half] == NO_OWNER).all()
    recording = images.recording_of(0, lambda frame: found)
    assert not recording.frame(0)[:, 80:].any()
    assert (recording.occluders(0)[:, 80:][right_half] > 0.0).all()


def test_one_person_is_captured_to_the_bit_as_by_capture():
    recording = recorded(waving(6))
    alone = capture(recording, BODY)

    (found,) = capture_people(find_people(recording), [BODY])

    np.testing.assert_array_equal(found.poses, alone.poses)
    np.testing.assert_array_equal(found.joints.confidence, alone.joints.confidence)
    np.testing.assert_array_equal(found.motion.rotations, alone.motion.rotations)


@pytest.fixture(scope="module")
def passing():
    """One waves in place; the other passes behind from left to right within a second."""
    n_frames = 30
    behind = placed(np.tile(posed(yaw=1.2), (n_frames, 1)), farther=0.9)
    behind[:, 0] = np.linspace(-1.0, 1.0, n_frames)
    return waving(n_frames), behind


def test_person_passing_behind_keeps_the_identity(passing):
    recording = recorded_together(*passing)

    found = capture_people(find_people(recording), [BODY, BODY], settings=FORWARD)

    assert len(found) == 2
    depths = [one.joints.positions[..., 2].mean() for one in found]
    for one, poses in zip(np.array(found)[np.argsort(depths)], passing, strict=True):
        errors = np.linalg.norm(one.joints.positions - joints_of(poses), axis=-1)
        assert errors.mean(axis=1).max() < 0.25
        assert errors.mean() < 0.08


def test_person_who_enters_late_does_not_change_the_other(passing):
    front, behind = passing
    behind = behind.copy()
    behind[:12] = np.nan
    recording = recorded_together(front, behind)
    (alone,) = capture_people(find_people(recorded(front)), [BODY], settings=FORWARD)

    found = capture_people(find_people(recording), [BODY, BODY], settings=FORWARD)

    near, far = sorted(found, key=lambda one: one.joints.positions[..., 2].mean())
    change = np.linalg.norm(near.joints.positions - alone.joints.positions, axis=-1)
    assert change.max() < 0.03
    assert (far.joints.confidence[:8] == 0.0).all()
    assert far.joints.confidence[20:, JOINTS.index("hips")].max() > 0.3


def test_person_who_has_left_owns_no_pixels():
    """The other walks to the empty place more than a second later."""
    n_frames = 24
    walker = placed(np.tile(NATURAL, (n_frames, 1)))
    walker[:, 0] = np.linspace(-0.8, 0.7, n_frames)
    leaver = placed(np.tile(posed(yaw=-0.5), (n_frames, 1)), 0.7)
    leaver[5:] = np.nan
    recording = recorded_together(walker, leaver, frame_rate=10.0)

    found = capture_people(find_people(recording), [BODY, BODY], settings=FORWARD)

    errors = np.linalg.norm(found[0].joints.positions - joints_of(walker), axis=-1)
    assert errors.mean(axis=1).max() < 0.03
    assert (found[1].joints.confidence[12:] == 0.0).all()


def test_wrong_numbers_and_methods_are_refused():
    people = find_people(recorded(waving(4)))
    with pytest.raises(InvalidMotionError, match="2 bodies do not match 1 people"):
        capture_people(people, [BODY, BODY])
    wei = CaptureSettings(method=CaptureMethod.REGISTRATION)
    with pytest.raises(InvalidSettingError, match="The method wei tracks one person"):
        capture_people(people, [BODY], settings=wei)
