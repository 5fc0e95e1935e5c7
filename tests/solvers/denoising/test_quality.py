"""Each quality figure must equal its definition."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising.quality.bone_drift import measure_bone_drifts
from solvers.denoising.quality.foot_slide import FootPoints, measure_foot_slide
from solvers.denoising.quality.jitter import measure_jitter
from solvers.denoising.quality.measure import QualitySettings, measure_quality
from solvers.denoising.quality.report import compare_quality
from solvers.errors import InvalidMotionError, InvalidSettingError, SolveCancelled
from solvers.motion import Motion, Tracks, forward_kinematics
from solvers.rotations.representations import multiply, quaternion_from_rotation_vector, rotate
from solvers.samples import GaitSettings, walking_gait


def test_jitter_of_a_cubic_is_its_third_derivative():
    time = np.arange(50) / 120.0
    positions = (time**3)[:, None, None] * np.array([[[1.0, 2.0, 2.0]]])

    assert_allclose(measure_jitter(positions, 120.0), 6.0 * 3.0, rtol=1e-6)


def test_jitter_skips_missing_samples(rng):
    positions = rng.normal(size=(40, 2, 3))
    gapped = positions.copy()
    gapped[20:, 0] = np.nan

    assert_allclose(measure_jitter(gapped, 30.0)[0], measure_jitter(positions[:20], 30.0)[0])


def test_jitter_of_three_frames_is_unknown():
    assert np.isnan(measure_jitter(np.zeros((3, 2, 3)), 30.0)).all()


def test_finds_spikes_and_gaps(swinging_leg):
    rotations = swinging_leg.rotations.copy()
    jump = quaternion_from_rotation_vector([0.0, 0.7, 0.0])
    rotations[60, 1] = multiply(rotations[60, 1], jump)
    rotations[20:30, 2] = np.nan

    quality = measure_quality(swinging_leg.with_poses(rotations))

    assert np.argwhere(quality.spikes).tolist() == [[60, 1]]
    assert np.argwhere(quality.gaps).tolist() == [[frame, 2] for frame in range(20, 30)]
    knee = next(signal for signal in quality.signals if signal.joint == "knee")
    assert_allclose(knee.deviation[60], 0.7, atol=0.01)


def test_jump_of_the_root_is_a_spike_of_the_root(swinging_leg):
    root_positions = swinging_leg.root_positions.copy()
    root_positions[40] += [0.0, 0.0, 0.3]

    quality = measure_quality(swinging_leg.with_poses(root_positions=root_positions))

    assert np.argwhere(quality.spikes).tolist() == [[40, 0]]


def test_clean_take_has_no_spikes_or_gaps(swinging_leg):
    quality = measure_quality(swinging_leg)

    assert not quality.spikes.any()
    assert not quality.gaps.any()


@pytest.mark.parametrize("rate", [30.0, 60.0, 120.0])
def test_noise_is_measured_at_any_frame_rate(rng, leg, rate):
    time = np.arange(int(4 * rate)) / rate
    vectors = np.zeros((len(time), 4, 3))
    vectors[:, 1, 0] = 0.5 * np.sin(2 * np.pi * time)
    vectors[:, :3] += rng.normal(scale=0.05, size=(len(time), 3, 3))
    motion = Motion(
        leg, quaternion_from_rotation_vector(vectors), np.zeros((len(time), 3)), rate
    )

    noise = [signal.noise for signal in measure_quality(motion).signals if signal.is_rotation]

    assert_allclose(noise, 0.05, rtol=0.3)


def test_quality_is_invariant_to_position_and_heading(swinging_leg, rng):
    rotation = quaternion_from_rotation_vector([0.0, 0.0, 1.0])
    rotations = multiply(
        swinging_leg.rotations,
        quaternion_from_rotation_vector(rng.normal(scale=0.03, size=(120, 4, 3))),
    )
    take = swinging_leg.with_poses(rotations)
    rotated = rotations.copy()
    rotated[:, 0] = multiply(rotation, rotated[:, 0])
    elsewhere = take.with_poses(rotated, np.add(take.root_positions, (3.0, -2.0, 0.0)))

    a, b = measure_quality(take), measure_quality(elsewhere)

    assert (a.spikes == b.spikes).all()
    assert_allclose(a.jitter[1], b.jitter[1], rtol=1e-9)


def test_slide_is_the_distance_in_contact():
    """A foot at 0.3 m/s to the side: 0.3 m/s, and 0.3 m in 100 steps at 100 Hz."""
    points = np.zeros((201, 2, 3))
    points[:, :, 0] = 0.003 * np.arange(201)[:, None]
    contact = np.arange(201) >= 100

    slide = measure_foot_slide(FootPoints("left", "foot", points), contact, 100.0)

    assert_allclose(slide.mean_speed, 0.3, rtol=1e-9)
    assert_allclose(slide.distance, 0.3, rtol=1e-9)
    assert_allclose(slide.longest, 0.3, rtol=1e-9)


def test_longest_slide_ends_at_a_cut():
    """A foot slips by 40 cm, 10 and 30 cm of it in two segments of a joined take."""
    points = np.zeros((41, 2, 3))
    points[:, :, 0] = 0.01 * np.arange(41)[:, None]
    foot = FootPoints("left", "foot", points)

    complete = measure_foot_slide(foot, np.ones(41, dtype=bool), 60.0)
    parts = measure_foot_slide(foot, np.ones(41, dtype=bool), 60.0, cuts=(11,))

    assert_allclose(complete.longest, 0.4, rtol=1e-9)
    assert_allclose(parts.longest, 0.29, rtol=1e-9)


def test_foot_that_rolls_over_its_toe_does_not_slide():
    points = np.zeros((50, 2, 3))
    points[:, 0, 1] = -0.01 * np.arange(50)

    slide = measure_foot_slide(
        FootPoints("left", "foot", points), np.ones(50, dtype=bool), 60.0
    )

    assert slide.distance == 0.0


def test_foot_that_turns_on_the_tips_of_its_toes_does_not_slide():
    """Only the tip, which no joint of the map marks, stays in place."""
    walk = walking_gait(GaitSettings(duration=1.0, frame_rate=60.0))
    skeleton = walk.skeleton
    toes = skeleton.index("LeftToeBase")
    assert skeleton.children[toes]
    tip = skeleton.children[toes][0]
    standing = np.zeros((walk.n_frames, 2), dtype=bool)
    standing[:, 0] = True
    angle = np.linspace(0.0, 1.0, walk.n_frames)
    rotation = np.stack([np.cos(angle), 0 * angle, 0 * angle, np.sin(angle)], axis=-1)
    rotations = np.repeat(walk.rotations[:1], walk.n_frames, axis=0)
    rotations[:, 0] = multiply(rotation, rotations[:, 0])
    turning = walk.with_poses(rotations, np.zeros((walk.n_frames, 3)))
    tips = forward_kinematics(turning).positions[:, tip]
    turning = turning.with_poses(rotations, turning.root_positions - tips)

    left = measure_quality(turning, contacts=standing).feet[0]

    assert left.distance < 1e-9


def test_skating_walk_slides_and_planted_walk_does_not():
    walk = walking_gait(GaitSettings(duration=3.0, frame_rate=60.0))
    root_positions = walk.root_positions.copy()
    root_positions[:, 1] -= (
        0.1 * np.arange(walk.n_frames) / 60.0
    )  # everything drifts at 10 cm/s

    clean, skating = (
        measure_quality(motion)
        for motion in (walk, walk.with_poses(root_positions=root_positions))
    )

    assert clean.foot_slide < 0.02
    assert_allclose(skating.foot_slide, 0.1, atol=0.03)
    assert [foot.side for foot in skating.feet] == ["left", "right"]


def test_points_named_like_joints_have_feet():
    walk = walking_gait(GaitSettings(duration=3.0, frame_rate=60.0))
    points = Tracks(walk.skeleton.names, forward_kinematics(walk).positions, 60.0)

    from_points, from_joints = measure_quality(points), measure_quality(walk)

    assert_allclose(from_points.foot_slide, from_joints.foot_slide, atol=0.01)
    bones = {(bone.first, bone.second) for bone in from_points.bones}
    assert ("LeftUpLeg", "LeftLeg") in bones and ("RightForeArm", "RightHand") in bones
    assert max(bone.drift for bone in from_points.bones) < 1e-9


@pytest.mark.parametrize(("first", "second"), [("a", "b"), ("leftFoot", "leftToes")])
def test_bones_are_found_and_their_drift_measured(rng, first, second):
    """Two rigid rods drift away from each other; one point moves along its rod by 4 cm."""
    n_frames = 400
    origins = np.cumsum(rng.normal(scale=0.05, size=(n_frames, 2, 3)), axis=0)
    rotations = quaternion_from_rotation_vector(rng.normal(size=(n_frames, 2, 3)))
    rods = rotate(rotations, [0.3, 0.0, 0.0])
    rods[:, 1] *= np.linspace(1.0, 1.0 + 0.04 / 0.3, n_frames)[:, None]
    positions = np.stack(
        [origins[:, 0], origins[:, 0] + rods[:, 0], origins[:, 1], origins[:, 1] + rods[:, 1]],
        axis=1,
    )
    tracks = Tracks((first, second, "c", "d"), positions, 60.0)

    bones = {(bone.first, bone.second): bone for bone in measure_bone_drifts(tracks)}

    assert (first, second) in bones and ("c", "d") in bones
    assert_allclose(bones[first, second].length, 0.3, rtol=1e-6)
    assert bones[first, second].drift < 1e-9
    assert_allclose(bones["c", "d"].drift, 0.9 * 0.04, rtol=0.02)
    assert len(bones) == 2  # points that drift away from each other are no bone


def test_bone_of_constant_length_is_preferred_to_a_nearer_point(rng):
    """A point jitters halfway between the ends of a rod."""
    start = np.cumsum(rng.normal(scale=0.05, size=(300, 3)), axis=0)
    stop = start + rotate(
        quaternion_from_rotation_vector(rng.normal(size=(300, 3))), [0.3, 0, 0]
    )
    hovering = 0.5 * (start + stop) + rng.normal(scale=0.01, size=(300, 3))
    tracks = Tracks(("a", "b", "c"), np.stack([start, stop, hovering], axis=1), 60.0)

    assert ("a", "b") in {(bone.first, bone.second) for bone in measure_bone_drifts(tracks)}


def test_markers_are_connected_by_their_distances_though_two_have_names_of_a_body(rng):
    positions = np.cumsum(rng.normal(scale=0.05, size=(200, 4, 3)), axis=0)
    positions[:, 1] = positions[:, 0] + [0.3, 0.0, 0.0]

    bones = measure_bone_drifts(Tracks(("a", "b", "Head", "Neck"), positions, 60.0))

    assert ("a", "b") in {(bone.first, bone.second) for bone in bones}


def test_tracks_with_gaps_are_measured(rng):
    positions = np.cumsum(rng.normal(scale=0.001, size=(200, 3, 3)), axis=0)
    positions[:, 1] = positions[:, 0] + [0.3, 0.0, 0.0]
    positions[50:80, 1] = np.nan
    positions[:, 2] = np.nan

    quality = measure_quality(Tracks(("a", "b", "c"), positions, 60.0))

    assert quality.gaps.sum(axis=0).tolist() == [0, 30, 200]
    assert "never" not in quality.report()
    assert [(bone.first, bone.second) for bone in quality.bones] == [("a", "b")]


def test_the_report_names_every_joint_and_the_figures_fit_in_json(swinging_leg):
    quality = measure_quality(swinging_leg)

    report = quality.report()
    figures = json.loads(json.dumps(quality.figures(), allow_nan=False))

    assert all(name in report for name in ("hip", "knee", "ankle"))
    assert "120 frames at 60 Hz (2.0 s)" in report
    assert figures["spikes"] == 0
    assert set(figures["joints"]) == set(quality.names)


def test_comparison_lists_both_takes(swinging_leg, rng):
    noise = quaternion_from_rotation_vector(rng.normal(scale=0.05, size=(120, 4, 3)))
    noisy = swinging_leg.with_poses(multiply(swinging_leg.rotations, noise))

    table = compare_quality(measure_quality(noisy), measure_quality(swinging_leg))

    assert "before" in table and "after" in table
    assert "foot slide" in table


@pytest.mark.parametrize("n_frames", [1, 2, 3, 5])
def test_short_takes_are_measured(swinging_leg, n_frames):
    quality = measure_quality(swinging_leg.slice(0, n_frames))

    assert quality.n_frames == n_frames
    assert not quality.spikes.any()
    json.dumps(quality.figures(), allow_nan=False)
    quality.report()


def test_wrong_contacts_are_refused(swinging_leg):
    with pytest.raises(InvalidMotionError, match=r"Contacts need shape \(.*, 2\)"):
        measure_quality(swinging_leg, contacts=np.ones((3, 2), dtype=bool))


def test_a_threshold_below_the_noise_is_refused():
    with pytest.raises(InvalidSettingError, match="spike_threshold is 0"):
        QualitySettings(spike_threshold=0.0)


def test_progress_rises_to_one_and_can_cancel(swinging_leg, cancel):
    fractions = []
    measure_quality(
        swinging_leg, progress=lambda fraction, message="": fractions.append(fraction)
    )

    assert fractions == sorted(fractions) and fractions[-1] == 1.0

    with pytest.raises(SolveCancelled):
        measure_quality(swinging_leg, progress=cancel)
