"""The pictures of the first press show the takes, joints and frames that are worst."""

import numpy as np
import pytest
from PIL import Image

from solvers.motion import Motion
from solvers.rotations import multiply, quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait
from tests.benchmarks.first_press.bench_first_press import Scores
from tests.benchmarks.first_press.conditions import CONDITIONS, Case
from tests.benchmarks.first_press.draw_worst import draw_worst, find_moment, nearest_turn
from tests.benchmarks.first_press.filters import METHODS, OURS, Result
from tests.benchmarks.first_press.measures import measure
from tests.benchmarks.first_press.takes import Take

PEER, FRAME = "GCV spline", 30
CLEAN, NOISY = CONDITIONS[:2]
TAKES = [Take(name, 30) for name in ("good", "bad", "worse", "worst", "fair")]
OFF_DEG = {"good": 0.0, "bad": 20.0, "worse": 30.0, "worst": 40.0, "fair": 10.0}


@pytest.fixture
def walk(monkeypatch) -> Motion:
    """Each take is a walk; ours turns one elbow by OFF_DEG, and the peer returns the truth."""
    motion = walking_gait(GaitSettings(duration=2.0))
    monkeypatch.setattr("tests.benchmarks.first_press.conditions.read", lambda take: motion)
    monkeypatch.setitem(METHODS, OURS, lambda case: Result(_rotated(case.truth, case.take)))
    monkeypatch.setitem(METHODS, PEER, lambda case: Result(case.truth))
    return motion


@pytest.mark.parametrize("measured", ["angle", "position", "excursion_loss"])
def test_the_worst_joint_and_frame_are_found(walk, measured):
    case = Case(TAKES[3], CLEAN)

    moment = find_moment(case, measured, METHODS[OURS](case).motion, case.truth)

    assert (moment.joint, moment.frame) == (_elbow(walk), FRAME)


def test_three_worst_takes_of_a_condition_are_drawn(walk, monkeypatch, tmp_path):
    scores, drawn = _scores(CLEAN), []
    monkeypatch.setitem(
        METHODS,
        OURS,
        lambda case: drawn.append(case) or Result(_rotated(case.truth, case.take)),
    )

    paths = draw_worst(scores, TAKES, tmp_path)

    assert [each.take.name for each in drawn[:3]] == ["worst", "worse", "bad"]
    assert paths[0] == tmp_path / "worst_clean.png"
    assert all(path.exists() for path in paths)
    with Image.open(paths[0]) as picture:
        assert picture.size[1] > 3 * 250


def test_nothing_is_drawn_of_a_condition_in_which_ours_is_best(walk, tmp_path):
    paths = draw_worst(_scores(NOISY, swapped=True), TAKES, tmp_path)

    assert "worst_sigma_1.png" not in {path.name for path in paths}


def test_curves_of_one_rotation_do_not_part_by_a_turn():
    spin = np.radians([[0.0, 0.0, 350.0], [0.0, 0.0, 370.0]])
    same_but_short = np.radians([[0.0, 0.0, -20.0], [0.0, 0.0, 15.0]])

    vectors = np.degrees(nearest_turn(same_but_short, spin))

    assert vectors == pytest.approx(np.array([[0.0, 0.0, 340.0], [0.0, 0.0, 375.0]]))


def _scores(condition, swapped: bool = False) -> Scores:
    scores = Scores()
    names = (PEER, OURS) if swapped else (OURS, PEER)
    for one in CONDITIONS:
        for take in TAKES if one == condition else ():
            case = Case(take, one)
            for name, method in zip(names, (OURS, PEER), strict=True):
                found = measure(case, METHODS[method](case).motion)
                scores.figures[name][str(one)][str(take)] = found
    return scores


def _rotated(motion: Motion, take: Take) -> Motion:
    rotations = motion.rotations.copy()
    rotation = quaternion_from_rotation_vector(np.radians([OFF_DEG[take.name], 0.0, 0.0]))
    rotations[FRAME, _elbow(motion)] = multiply(rotations[FRAME, _elbow(motion)], rotation)
    return motion.with_poses(rotations)


def _elbow(motion: Motion) -> int:
    return motion.skeleton.index("LeftForeArm")
