"""Good takes hardly change, and noisy ones stand on the ground."""

import numpy as np
import pytest

from solvers.denoising import measure_quality
from solvers.motion import (
    Motion,
    detect_contacts,
    forward_kinematics,
    joint_parents,
    motion_from_points,
)
from solvers.physics import Ground, SimulateSettings, simulate
from solvers.recordings import read_recording

UNDER_FEET = SimulateSettings(ground=Ground.FEET)
GOOD = {
    "walk": "mocap/cmu_walk/10_04.bvh",
    "kick": "mocap/hdm05/HDM_bd_kickLFront1Reps_*",
    "grab": "mocap/hdm05/HDM_dg_grabHighR_*",
    "jog": "mocap/hdm05/HDM_dg_jogLeftCircle4StepsRstart_*",
}


@pytest.fixture(scope="module")
def good_takes(recordings):
    """Each take and its simulation."""
    takes = {}
    for name, pattern in GOOD.items():
        motion = read_recording(sorted(recordings.glob(pattern))[0])
        motion = motion.slice(1, min(motion.n_frames, 481))
        takes[name] = motion, simulate(motion, settings=UNDER_FEET)
    return takes


@pytest.mark.parametrize("clip", GOOD)
def test_good_take_changes_little_and_shakes_less(good_takes, clip):
    motion, result = good_takes[clip]

    assert result.followed.all()
    assert result.distance < 0.03
    assert result.penetration_after < 0.006
    assert jerk(result.motion) < 0.7 * jerk(motion)


def test_feet_slide_less_by_an_independent_measure(good_takes):
    before, after = 0.0, 0.0
    for motion, result in good_takes.values():
        contacts = detect_contacts(motion)
        before += slide(measure_quality(motion, contacts=contacts))
        after += slide(measure_quality(result.motion, contacts=contacts))

    assert after < 0.8 * before


def test_feet_rest_while_loaded(good_takes):
    """Compare with friction only, by contacts that do not depend on the take."""
    for motion, planted in good_takes.values():
        settings = SimulateSettings(ground=Ground.FEET, plant=False)
        free = simulate(motion, settings=settings)
        loaded = planted.foot_loads > 0.1
        creeps, rests = (
            sum(foot.distance for foot in measure_quality(each.motion, contacts=loaded).feet)
            for each in (free, planted)
        )

        assert loaded.any() and np.array_equal(free.foot_loads, planted.foot_loads)
        assert rests < 0.85 * creeps
        assert jerk(planted.motion) < 1.1 * jerk(free.motion)


def test_planting_does_not_sink_knees(recordings):
    """In a low squat, the unloaded foot moves, and its knee is near the ground."""
    path = recordings / "mocap" / "hdm05" / "HDM_bd_squat1Reps_006_120.amc"

    result = simulate(read_recording(path), settings=UNDER_FEET)

    assert result.penetration_after < 0.003


@pytest.mark.parametrize("folder", ["irds", "msr_action3d"])
def test_depth_camera_take_stands_still_on_the_ground(recordings, folder):
    path = sorted((recordings / "kinect" / folder).glob("*"))[0]
    joints = read_recording(path).tracks
    motion = motion_from_points(joints, joint_parents(joints.names))

    result = simulate(motion, settings=UNDER_FEET)

    assert result.followed.all()
    assert result.penetration_after < 0.006
    assert result.slide_after < 0.7 * result.slide_before
    assert jerk(result.motion) < 0.8 * jerk(motion)
    assert result.distance < 0.1


def slide(quality) -> float:
    return sum(foot.distance for foot in quality.feet)


def jerk(motion: Motion) -> float:
    positions = forward_kinematics(motion).positions
    thirds = np.diff(positions, 3, axis=0) * motion.frame_rate**3
    return float(np.nanmean(np.linalg.norm(thirds, axis=-1)))
