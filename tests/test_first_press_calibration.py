"""The measure of calibration distinguishes true confidence from too high and too low."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from solvers.motion import Motion
from solvers.rotations import multiply, quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait
from tests.benchmarks.first_press.calibration import (
    GOOD,
    MISSING,
    OUTLIERS,
    Bins,
    Calibration,
    draw_curve,
)
from tests.benchmarks.first_press.conditions import CONDITIONS, Case
from tests.benchmarks.first_press.takes import Take

MISSING_ARM = next(one for one in CONDITIONS if one.limb == "arm")
BURSTS = next(one for one in CONDITIONS if one.bursts)


@pytest.fixture
def case(monkeypatch) -> Case:
    """A walk whose left arm is missing for a second."""
    motion = walking_gait(GaitSettings(duration=3.0))
    monkeypatch.setattr("tests.benchmarks.first_press.conditions.read", lambda take: motion)
    return Case(Take("walk", 30), MISSING_ARM)


def test_true_confidence_has_no_expected_error(rng):
    reported = rng.uniform(size=200_000)

    bins = _bins(reported, is_right=rng.uniform(size=reported.size) < reported)

    assert bins.expected_error < 0.01
    assert bins.right == pytest.approx(bins.reported, abs=0.02)


def test_boast_is_found_and_so_is_modesty(rng):
    reported = rng.uniform(size=100_000)

    boast = _bins(reported, is_right=rng.uniform(size=reported.size) < reported**2)
    modesty = _bins(reported, is_right=np.ones(reported.size, dtype=bool))

    assert boast.expected_error == pytest.approx(0.5 - 1 / 3, abs=0.01)
    assert modesty.expected_error == pytest.approx(0.5, abs=0.01)
    assert (boast.right < boast.reported).all()


def test_high_confidence_counts_reports_of_nine_tenths_or_more():
    bins = _bins(np.array([0.5, 0.9, 0.95, 1.0]), np.array([True, True, False, True]))

    assert bins.high_confidence == pytest.approx((0.75, 2 / 3))


def test_missing_samples_are_counted_separately(case):
    calibration, reported = Calibration(), np.full(case.truth.rotations.shape[:2], 0.95)

    calibration.add(case, _missing_rotated(case, degrees=20.0), reported)

    n_missing = case.truth.rotations[case.missing_frames][:, case.missing_joints].shape[:2]
    n_all = case.truth.n_frames * int(case.channels.joints.sum())
    assert calibration.kind(GOOD).high_confidence == pytest.approx((1.0, 1.0))
    assert calibration.kind(MISSING).high_confidence == pytest.approx((1.0, 0.0))
    both = calibration.kind(GOOD).joined([calibration.kind(MISSING)])
    assert both.high_confidence[1] == pytest.approx(1.0 - np.prod(n_missing) / n_all)


def test_outliers_are_counted_separately(case):
    case, calibration = replace(case, condition=BURSTS), Calibration()

    calibration.add(case, case.recording, np.ones(case.truth.rotations.shape[:2]))

    assert calibration.kind(GOOD).high_confidence[1] == 1.0
    assert calibration.kind(OUTLIERS).high_confidence[1] < 0.1


def test_tables_and_curve_are_written(case, tmp_path):
    calibration, reported = Calibration(), np.full(case.truth.rotations.shape[:2], 0.95)
    calibration.add(case, case.truth, reported)

    by_bin, by_condition = calibration.tables()
    calibration.draw(tmp_path / "curve.png")

    assert "| 0.9 to 1.0 " in by_bin
    assert "100.0" in by_condition
    assert _pixels(tmp_path / "curve.png").shape[1] > 400


def test_bins_of_chance_are_not_drawn(tmp_path):
    reported = np.append(np.full(20_000, 0.95), 0.05)
    with_one = _bins(reported, is_right=np.ones(reported.size, dtype=bool))
    without = _bins(reported[:-1], is_right=np.ones(reported.size - 1, dtype=bool))

    for name, bins in (("with", with_one), ("without", without)):
        draw_curve({GOOD: bins, MISSING: Bins()}, tmp_path / f"{name}.png")

    left = [_pixels(tmp_path / f"{name}.png")[:, :200] for name in ("with", "without")]
    assert (left[0] == left[1]).all()


def _pixels(path: Path) -> np.ndarray:
    with Image.open(path) as image:
        return np.asarray(image)


def _bins(reported: np.ndarray, is_right: np.ndarray) -> Bins:
    bins = Bins()
    bins.add(reported, np.where(is_right, 1.0, 10.0))
    return bins


def _missing_rotated(case: Case, degrees: float) -> Motion:
    rotations = case.truth.rotations.copy()
    rotation = quaternion_from_rotation_vector(np.radians([degrees, 0.0, 0.0]))
    block = np.ix_(np.arange(case.truth.n_frames)[case.missing_frames], case.missing_joints)
    rotations[block] = multiply(rotations[block], rotation)
    return replace(case.truth, rotations=rotations)
