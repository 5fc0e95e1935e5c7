"""Of real takes, the good ones hardly change, and the bad ones come to stand on the ground."""

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
from solvers.reconstruction import Ground, SimulateSettings, simulate
from solvers.recordings import read_recording

UNDER_FEET = SimulateSettings(ground=Ground.FEET)
GOOD = {
    "walk": "mocap/cmu_walk/10_04.bvh",
    "kick": "mocap/hdm05/HDM_bd_kickLFront1Reps_*",
    "grab": "mocap/hdm05/HDM_dg_grabHighR_*",
    "jog": "mocap/hdm05/HDM_dg_jogLeftCircle4StepsRstart_*",
}


@pytest.mark.parametrize("clip", GOOD)
def test_a_good_take_changes_little_and_shakes_and_slides_less(recordings, clip):
    path = sorted(recordings.glob(GOOD[clip]))[0]
    motion = read_recording(path)
    motion = motion.slice(1, min(motion.n_frames, 481))

    result = simulate(motion, settings=UNDER_FEET)

    assert result.followed.all()
    assert result.distance < 0.03
    assert result.penetration_after < 0.006
    contacts = detect_contacts(motion)
    before, after = (
        measure_quality(each, contacts=contacts) for each in (motion, result.motion)
    )
    assert slide(after) < slide(before)
    assert jerk(result.motion) < 0.7 * jerk(motion)


@pytest.mark.parametrize("folder", ["irds", "msr_action3d"])
def test_a_depth_cameras_take_stands_still_on_the_ground(recordings, folder):
    path = sorted((recordings / "kinect" / folder).glob("*"))[0]
    joints = read_recording(path).tracks
    motion = motion_from_points(joints, joint_parents(joints.names))

    result = simulate(motion, settings=UNDER_FEET)

    assert result.followed.all()
    assert result.penetration_after < 0.006
    assert result.slide_after < 0.7 * result.slide_before
    assert jerk(result.motion) < 0.8 * jerk(motion)
    assert result.distance < 0.03


def slide(quality) -> float:
    return sum(foot.distance for foot in quality.feet)


def jerk(motion: Motion) -> float:
    positions = forward_kinematics(motion).positions
    thirds = np.diff(positions, 3, axis=0) * motion.frame_rate**3
    return float(np.nanmean(np.linalg.norm(thirds, axis=-1)))
