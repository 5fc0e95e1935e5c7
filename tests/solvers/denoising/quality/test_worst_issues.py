"""The list must contain every issue, worst first, and nothing else."""

import re

import numpy as np
import pytest

from solvers.denoising.quality.measure import measure_quality
from solvers.denoising.quality.worst_issues import IssueSettings, find_worst_issues
from solvers.motion import Motion, Tracks, forward_kinematics
from solvers.recordings.skeleton_files import read_bvh
from solvers.rotations.representations import multiply, quaternion_from_rotation_vector


def with_jitter(motion: Motion, joint: int, frames: slice, scale: float, rng) -> Motion:
    rotations = motion.rotations.copy()
    size = (*rotations[frames, joint].shape[:-1], 3)
    noise = quaternion_from_rotation_vector(rng.normal(scale=scale, size=size))
    rotations[frames, joint] = multiply(rotations[frames, joint], noise)
    return motion.with_poses(rotations)


def test_clean_take_has_no_issues(swinging_leg):
    assert find_worst_issues(swinging_leg) == ()


def test_spike_is_listed_with_its_frames_and_size(swinging_leg):
    rotations = swinging_leg.rotations.copy()
    jump = quaternion_from_rotation_vector([0.0, np.radians(40.0), 0.0])
    rotations[70:72, 1] = multiply(rotations[70:72, 1], jump)

    (issue,) = find_worst_issues(swinging_leg.with_poses(rotations))

    assert (issue.joint, issue.start_frame, issue.stop_frame, issue.kind) == (
        "knee",
        70,
        72,
        "spike",
    )
    assert issue.sentence.startswith("knee jumps by 4")
    assert issue.severity > 3.0


def test_consecutive_spikes_are_one_issue(swinging_leg):
    rotations = swinging_leg.rotations.copy()
    jump = quaternion_from_rotation_vector([0.0, np.radians(40.0), 0.0])
    for frame in (60, 66):
        rotations[frame, 1] = multiply(rotations[frame, 1], jump)

    (issue,) = find_worst_issues(swinging_leg.with_poses(rotations))

    assert (issue.start_frame, issue.stop_frame) == (60, 67)
    assert issue.sentence.startswith("knee jumps 2 times, by up to ")


def test_longer_gap_is_worse(swinging_leg):
    rotations = swinging_leg.rotations.copy()
    rotations[10:20, 2] = np.nan
    rotations[50:90, 1] = np.nan

    issues = find_worst_issues(swinging_leg.with_poses(rotations))

    assert [(issue.joint, issue.kind) for issue in issues] == [
        ("knee", "gap"),
        ("ankle", "gap"),
    ]
    assert issues[0].sentence == "knee is missing for 0.67 s."


def test_limb_that_is_lost_together_is_one_issue(swinging_leg):
    rotations = swinging_leg.rotations.copy()
    rotations[50:90, 1:] = np.nan
    rotations[100:105, 2] = np.nan

    issues = find_worst_issues(swinging_leg.with_poses(rotations))

    assert [issue.sentence for issue in issues] == [
        "knee and 1 more are missing for 0.67 s.",
        "ankle is missing for 0.08 s.",
    ]


def test_gaps_of_one_joint_that_are_close_in_time_are_one_issue(swinging_leg):
    """At 60 Hz and a merge time of 0.2 s, pauses of up to 12 frames."""
    rotations = swinging_leg.rotations.copy()
    rotations[20:26, 1:] = np.nan
    rotations[30:36, 1] = np.nan
    rotations[49:52, 1] = np.nan

    issues = find_worst_issues(swinging_leg.with_poses(rotations))

    assert [(each.start_frame, each.stop_frame, each.sentence) for each in issues] == [
        (20, 36, "knee and 1 more are missing for 0.20 s."),
        (49, 52, "knee is missing for 0.05 s."),
    ]


def test_limbs_lost_at_the_same_time_are_listed_each(recordings):
    walk = read_bvh(recordings / "mocap" / "cmu_walk" / "07_01.bvh").slice(1, 120)
    rotations = walk.rotations.copy()
    for arm in ("LeftForeArm", "RightForeArm"):
        rotations[50:90, walk.skeleton.names.index(arm)] = np.nan

    gaps = [
        each for each in find_worst_issues(walk.with_poses(rotations)) if each.kind == "gap"
    ]

    assert {each.sentence for each in gaps} == {
        "LeftForeArm is missing for 0.33 s.",
        "RightForeArm is missing for 0.33 s.",
    }


def test_points_are_listed_each_unless_all_are_lost(swinging_leg):
    positions = np.array(forward_kinematics(swinging_leg).positions)
    positions[20:30, 1:] = np.nan
    positions[50:70] = np.nan
    names = swinging_leg.skeleton.names

    issues = find_worst_issues(Tracks(names, positions, swinging_leg.frame_rate))

    gaps = [each.sentence for each in issues if each.kind == "gap"]
    assert gaps[0] == f"{names[0]} and {len(names) - 1} more are missing for 0.33 s."
    assert sorted(gaps[1:]) == sorted(f"{name} is missing for 0.17 s." for name in names[1:])


def test_jitter_of_one_joint_is_listed(swinging_leg, rng):
    take = with_jitter(swinging_leg, 1, slice(60, 110), 0.05, rng)

    issues = [issue for issue in find_worst_issues(take) if issue.kind == "jitter"]

    assert {issue.joint for issue in issues} == {"knee"}
    assert issues[0].start_frame < 75 and issues[0].stop_frame > 95


@pytest.mark.parametrize(
    ("noise", "text"),
    [
        (0.01, r"knee jitters by \d\.\d°, [2-9] times the typical noise of the take\."),
        (0.0, r"knee jitters by \d\.\d°; most of the take does not jitter\."),
    ],
)
def test_jitter_is_compared_with_that_of_the_take_if_it_has_any(swinging_leg, rng, noise, text):
    noisy = with_jitter(swinging_leg, slice(0, 3), slice(None), noise, rng)

    issues = find_worst_issues(with_jitter(noisy, 1, slice(60, 110), 0.05, rng))

    (sentence, *_) = [issue.sentence for issue in issues if issue.kind == "jitter"]
    assert re.fullmatch(text, sentence), sentence


@pytest.mark.parametrize("scale", [0.005, 0.02, 0.08])
def test_noise_of_the_entire_take_is_no_issue(swinging_leg, rng, scale):
    """It sets the scale of the take; the report states its size."""
    take = with_jitter(swinging_leg, slice(0, 3), slice(None), scale, rng)

    assert not [issue for issue in find_worst_issues(take) if issue.kind == "jitter"]


def test_foot_slide_is_listed(recordings):
    walk = read_bvh(recordings / "mocap" / "cmu_walk" / "07_01.bvh").slice(1, 120)
    contacts = np.zeros((walk.n_frames, 2), dtype=bool)
    contacts[20:60, 0] = True

    quality = measure_quality(walk, contacts=contacts)

    issues = [issue for issue in find_worst_issues(walk, quality) if issue.kind == "foot slide"]
    assert all((issue.start_frame, issue.stop_frame) == (20, 60) for issue in issues)


def test_worst_issue_is_first_and_the_number_is_limited(swinging_leg, rng):
    rotations = swinging_leg.rotations.copy()
    for frame, angle in ((20, 0.3), (50, 0.9), (80, 0.6)):
        jump = quaternion_from_rotation_vector([0.0, angle, 0.0])
        rotations[frame, 1] = multiply(rotations[frame, 1], jump)

    issues = find_worst_issues(
        swinging_leg.with_poses(rotations), settings=IssueSettings(max_issues=2)
    )

    assert [issue.start_frame for issue in issues] == [50, 80]


def test_joint_never_observed_is_one_issue(swinging_leg):
    rotations = swinging_leg.rotations.copy()
    rotations[:, 1] = np.nan

    (issue,) = find_worst_issues(swinging_leg.with_poses(rotations))

    assert issue.sentence == "knee is never observed."
    assert (issue.start_frame, issue.stop_frame) == (0, 120)
