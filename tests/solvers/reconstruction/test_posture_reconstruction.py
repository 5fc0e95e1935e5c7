"""Complete missing joints from a library and keep observed ones."""

import numpy as np
import pytest

from solvers.errors import InvalidMotionError, SolveCancelled
from solvers.motion import SENSOR_JOINTS, JointRecording, Sensor, Tracks, forward_kinematics
from solvers.motion.humanoid.posture_heading import rotate_about_vertical
from solvers.motion.humanoid.posture_joints import (
    POSTURE_JOINTS,
    posture_joint_indices,
    postures_from_motion,
)
from solvers.reconstruction.joint_rotations.other_joints import (
    find_anchors,
    positions_from_postures,
)
from solvers.reconstruction.pose_completion.complete_postures import complete_postures
from solvers.reconstruction.pose_completion.reconstruct_postures import reconstruct_postures
from solvers.reconstruction.pose_completion.settings import PostureSettings
from solvers.reconstruction.pose_library.posture_library import build_posture_library
from solvers.reconstruction.published.posture_reconstruction import search_as_published
from solvers.reconstruction.reliability.scores import Reliability
from solvers.recordings import read_bvh, read_recording
from solvers.samples import GaitSettings, walking_gait

LEG = [POSTURE_JOINTS.index(f"left{part}") for part in ("LowerLeg", "Foot", "Toes")]
GAP = slice(30, 60)
KINECT = SENSOR_JOINTS[Sensor.KINECT_V1]


def recorded(positions, names=KINECT):
    return JointRecording(Tracks(names, positions, 30.0), None, Sensor.KINECT_V1)


def given_reliability(reliability):
    return Reliability(reliability, reliability, reliability, reliability)


def reconstructed(positions, library, complete=complete_postures, **settings):
    """Reconstruct with reliability 0 for missing (NaN) and 1 for observed joints."""
    reliability = np.isfinite(positions).all(axis=-1).astype(float)
    return reconstruct_postures(
        recorded(positions), library, settings=PostureSettings(**settings),
        reliability=given_reliability(reliability), complete=complete,
    )  # fmt: skip


@pytest.fixture(scope="module")
def library():
    gaits = [
        walking_gait(GaitSettings(duration=3.0, frame_rate=30.0, speed=speed))
        for speed in (0.9, 1.2, 1.5)
    ]
    return build_posture_library(gaits)


@pytest.fixture(scope="module")
def walk():
    return postures_from_motion(
        walking_gait(GaitSettings(duration=3.0, frame_rate=30.0, speed=1.1))
    )


@pytest.fixture
def walk_without_leg(walk):
    observed = walk.copy()
    observed[GAP, LEG] = np.nan
    return observed


def test_missing_leg_walks_on_and_observed_joints_stay(walk, walk_without_leg, library):
    result = reconstructed(walk_without_leg, library)
    errors = np.linalg.norm(result.tracks.positions - walk, axis=-1)
    is_observed = np.isfinite(walk_without_leg).all(axis=-1)
    assert np.quantile(errors[is_observed], 0.99) < 0.02
    straight = walk.copy()
    frames = np.arange(len(walk))
    observed = np.setdiff1d(frames, frames[GAP])
    for joint in LEG:
        for axis in range(3):
            straight[:, joint, axis] = np.interp(frames, observed, walk[observed, joint, axis])
    default = np.linalg.norm(straight - walk, axis=-1)[~is_observed].mean()
    assert default > 0.1
    assert errors[~is_observed].mean() < 0.3 * default


@pytest.mark.parametrize(
    "settings", [{}, {"complete": search_as_published}, {"causal": True}], ids=str
)
def test_every_method_fills_every_frame_plausibly(walk, walk_without_leg, library, settings):
    result = reconstructed(walk_without_leg, library, **settings)
    errors = np.linalg.norm(result.tracks.positions - walk, axis=-1)
    assert np.isfinite(errors).all()
    assert errors[GAP][:, LEG].mean() < 0.15
    assert ((result.confidence >= 0.0) & (result.confidence <= 1.0)).all()
    assert np.isfinite(result.motion.rotations).all()


def test_causal_frames_ignore_the_future(walk_without_leg, library):
    """Except for bone lengths and mean errors of limbs, which need the complete take."""
    complete = reconstructed(walk_without_leg, library, causal=True).tracks.positions
    changed = walk_without_leg.copy()
    changed[70:, POSTURE_JOINTS.index("rightHand")] = np.nan
    other = reconstructed(changed, library, causal=True).tracks.positions
    np.testing.assert_allclose(other[:60], complete[:60], atol=0.03)


def test_confidence_is_high_where_observed_and_low_inside_a_gap(walk_without_leg, library):
    found = reconstructed(walk_without_leg, library).confidence
    assert found[:20].min() > 0.9
    assert found[45, LEG[1]] < 0.8 < found[10, LEG[1]]
    assert found[45, LEG[1]] < found[31, LEG[1]]


def test_position_and_heading_do_not_matter(walk_without_leg, library):
    moved = rotate_about_vertical(
        walk_without_leg, np.full(len(walk_without_leg), 1.9)
    ) + np.array([2.0, 3.0, 0.0])
    one, other = reconstructed(walk_without_leg, library), reconstructed(moved, library)
    back = rotate_about_vertical(
        other.tracks.positions - np.array([2.0, 3.0, 0.0]), np.full(len(walk_without_leg), -1.9)
    )
    np.testing.assert_allclose(back, one.tracks.positions, atol=1e-3)


def test_larger_bodies_are_reconstructed_equally_well(walk, walk_without_leg, library):
    errors = [
        np.linalg.norm(
            reconstructed(size * walk_without_leg, library).tracks.positions / size - walk,
            axis=-1,
        ).mean()
        for size in (1.0, 1.3)
    ]
    assert errors[1] < 1.3 * errors[0]


def test_reconstruction_repeats_and_does_not_modify_the_take(walk_without_leg, library):
    before = walk_without_leg.copy()
    one, other = (
        reconstructed(walk_without_leg, library),
        reconstructed(walk_without_leg, library),
    )
    np.testing.assert_array_equal(walk_without_leg, before)
    np.testing.assert_array_equal(one.tracks.positions, other.tracks.positions)


def test_missing_hips_follow_the_joints_around_them(walk, library):
    """The body bobs, so linear interpolation of the gap would be inaccurate."""
    bob = 0.15 * np.sin(2.0 * np.pi * np.arange(len(walk)) / 30.0)
    truth = walk + bob[:, None, None] * (0.0, 0.0, 1.0)
    observed = truth.copy()
    observed[GAP, 0] = np.nan
    errors = np.linalg.norm(reconstructed(observed, library).tracks.positions - truth, axis=-1)
    assert errors[GAP, 0].max() < 0.06


def test_constant_offset_of_a_limb_is_learned_where_observed(walk, library):
    """The tracker offsets a leg by 10 cm, and the leg is missing for a long time."""
    truth = walk.copy()
    truth[:, LEG] += (0.1, 0.0, 0.0)
    observed = truth.copy()
    observed[15:75, LEG] = np.nan
    differences = (reconstructed(observed, library).tracks.positions - truth)[35:55, LEG]
    assert np.abs(differences.mean(axis=(0, 1))[0]) < 0.05


def test_motion_has_constant_bone_lengths_and_follows(walk_without_leg, library):
    result = reconstructed(walk_without_leg, library)
    world = forward_kinematics(result.motion).positions
    order = [result.motion.skeleton.index(name) for name in result.tracks.names]
    assert np.linalg.norm(world[:, order] - result.tracks.positions, axis=-1).mean() < 0.03


def test_joints_that_are_not_posture_joints_follow_neighbors():
    names = SENSOR_JOINTS[Sensor.KINECT_V2]
    found = dict(zip(names, find_anchors(names), strict=True))
    assert POSTURE_JOINTS[found["HandTipLeft"]] == "leftHandEnd"
    assert POSTURE_JOINTS[found["ThumbRight"]] == "rightHand"
    assert POSTURE_JOINTS[found["Neck"]] in {"chest", "head"}
    azure = SENSOR_JOINTS[Sensor.AZURE_KINECT]
    found = dict(zip(azure, find_anchors(azure), strict=True))
    assert POSTURE_JOINTS[found["Nose"]] == "head"


def _joint_order(names):
    found = posture_joint_indices(names)
    return [found[role] for role in POSTURE_JOINTS]


def test_attached_joints_keep_their_offset_from_the_anchor(walk):
    order = SENSOR_JOINTS[Sensor.KINECT_V2]
    names = tuple(order[index] for index in _joint_order(order))
    names = (*names, "HandTipLeft")
    hand = POSTURE_JOINTS.index("leftHandEnd")
    tip = walk[:, hand] + np.array([0.0, 0.0, -0.08])
    observed = np.concatenate([walk, tip[:, None]], axis=1)
    reliability = np.ones((len(walk), 21))
    moved = walk + np.array([0.1, 0.2, 0.3])
    found = positions_from_postures(names, observed, reliability, walk, moved)
    np.testing.assert_allclose(found[:, 20], tip + np.array([0.1, 0.2, 0.3]), atol=1e-9)
    observed[20:40, 20] = np.nan
    found = positions_from_postures(names, observed, reliability, walk, walk)
    assert np.linalg.norm(found[20:40, 20] - tip[20:40], axis=-1).max() < 0.06


def test_reconstruction_raises_for_a_take_without_a_body(walk, library):
    unobserved = np.full_like(walk, np.nan)
    unobserved[:, :2] = walk[:, :2]
    with pytest.raises(InvalidMotionError, match="No frame shows 3 joints"):
        reconstructed(unobserved, library)


@pytest.mark.parametrize("n_frames", [1, 2, 5])
def test_short_takes_are_reconstructed(walk_without_leg, library, n_frames):
    result = reconstructed(walk_without_leg[40 : 40 + n_frames], library)
    assert np.isfinite(result.tracks.positions[:, :12]).all()


def test_reconstruction_can_be_cancelled(walk, library, cancel):
    with pytest.raises(SolveCancelled):
        reconstruct_postures(recorded(walk), library, progress=cancel)


def test_real_walks_of_another_actor_are_reconstructed(recordings, library):
    folder = recordings / "mocap" / "cmu_walk"
    clips = [read_bvh(path, scale=0.0254 / 0.45) for path in sorted(folder.glob("3[25]*.bvh"))]
    learned = build_posture_library([clip.slice(1, clip.n_frames) for clip in clips[:12]])
    clip = read_bvh(folder / "07_03.bvh", scale=0.0254 / 0.45)
    walk = postures_from_motion(clip.slice(1, clip.n_frames))[::4]
    observed = walk.copy()
    observed[20:50, LEG] = np.nan
    errors = np.linalg.norm(reconstructed(observed, learned).tracks.positions - walk, axis=-1)
    assert errors[20:50][:, LEG].mean() < 0.12


def test_shipped_library_reconstructs_a_real_kinect_take(recordings):
    take = read_recording(next((recordings / "kinect" / "kimore").glob("*.csv")))
    result = reconstruct_postures(take.slice(0, 120))
    assert result.tracks.names == take.names
    assert np.isfinite(result.tracks.positions).all()
    certain = result.reliability.combined > 0.9
    moved = np.linalg.norm(result.tracks.positions - take.tracks.positions[:120], axis=-1)
    assert np.median(moved[certain]) < 0.03
    assert "CMU" in result.method
