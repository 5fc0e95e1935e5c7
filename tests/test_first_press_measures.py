"""The benchmark of the first press finds a shortened kick, and only a shortened one."""

import numpy as np
import pytest

from solvers.motion import Motion, find_humanoid_map
from solvers.rotations import quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walker_skeleton, walking_gait
from tests.benchmarks.first_press.conditions import CONDITIONS, Case, Condition
from tests.benchmarks.first_press.measures import measure, turning_points
from tests.benchmarks.first_press.takes import DEVELOPMENT, SCORED, Take

RATE = 30.0
KICK_FRAME = 40


@pytest.fixture
def kick(monkeypatch) -> Case:
    """A person who stands still and swings a leg forward once."""
    motion = _swing(60.0)
    monkeypatch.setattr("tests.benchmarks.first_press.conditions.read", lambda take: motion)
    return Case(Take("kick", 30), CONDITIONS[0])


def test_turning_point_is_the_top_of_the_kick(kick):
    points = turning_points(kick.truth)

    assert [point.label for point in points] == [f"leftFoot frame {KICK_FRAME}"]


def test_truth_loses_nothing(kick):
    figures = measure(kick, kick.truth)

    assert figures.angle == pytest.approx(0.0, abs=1e-6)
    assert figures.excursion_loss == pytest.approx(0.0, abs=1e-6)
    assert figures.speed_kept == pytest.approx(1.0)


def test_shortened_kick_loses_reach_and_speed(kick):
    figures = measure(kick, _swing(45.0))

    assert figures.excursion_loss > 5.0
    assert figures.speed_kept < 1.0


def test_body_comes_back_from_below_its_bone(kick):
    case = Case(kick.take, next(one for one in CONDITIONS if one.spin))

    assert case.given.n_joints == case.truth.n_joints + 1
    figures = measure(case, case.body_of(case.given))
    assert figures.angle == pytest.approx(0.0, abs=1e-6)
    assert figures.position == pytest.approx(0.0, abs=1e-6)


def test_arm_in_t_pose_is_wrong_in_three_frames_that_are_not_scored(monkeypatch):
    walk = walking_gait(GaitSettings(duration=2.0, frame_rate=RATE))
    monkeypatch.setattr("tests.benchmarks.first_press.conditions.read", lambda take: walk)
    condition = Condition("arm", t_pose_frames=3)
    case = Case(Take("walk", 30), condition)

    arm = walk.skeleton.index("LeftForeArm")
    assert not case.is_good[:3, arm].any()
    assert case.is_good[3:].all()
    assert measure(case, case.given).angle == pytest.approx(0.0, abs=1e-6)


def test_no_person_but_the_fighter_and_no_take_is_in_both_lists():
    development, scored = ({_person(take) for take in takes} for takes in (DEVELOPMENT, SCORED))
    assert development & scored == {"martial"}
    assert not {take.name for take in DEVELOPMENT} & {take.name for take in SCORED}


def _person(take: Take) -> str:
    """Return the actor of HDM05, the subject of CMU, the dance, or the folder of the corpus."""
    if "/" in take.name:
        return take.name.split("/")[0]
    return take.name.split("_")[1 if take.name.startswith("HDM") else 0]


def _swing(degrees: float) -> Motion:
    skeleton, frames = walker_skeleton(), np.arange(80)
    rotations = np.tile([1.0, 0.0, 0.0, 0.0], (len(frames), skeleton.n_joints, 1))
    vectors = np.zeros((len(frames), 3))
    vectors[:, 0] = np.radians(degrees) * np.exp(-0.5 * ((frames - KICK_FRAME) / 3.0) ** 2)
    leg = skeleton.index(find_humanoid_map(skeleton).joints["leftUpperLeg"])
    rotations[:, leg] = quaternion_from_rotation_vector(vectors)
    return Motion(skeleton, rotations, np.tile([0.0, 0.0, 1.0], (len(frames), 1)), RATE)
