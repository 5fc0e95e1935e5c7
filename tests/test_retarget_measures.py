"""What the retargeting benchmark measures is what its columns say."""

import numpy as np
import pytest

from solvers.motion import Motion, Skeleton, find_humanoid_map
from solvers.rotations.representations import multiply, quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait
from tests.benchmarks.retarget.part_unbake import to_and_fro
from tests.benchmarks.retarget.retarget_measures import acted, ik_figures, world_figures

WALK = walking_gait(GaitSettings(duration=2.0, frame_rate=30.0))
ROLES = find_humanoid_map(WALK.skeleton)
SOURCE = acted(WALK, ROLES)


def grown(by: float, sunk: float = 0.0, rotations=None) -> Motion:
    """The walk of a body of another size, so much lower than it should be."""
    body = WALK.skeleton
    larger = Skeleton(body.names, body.parents, by * body.offsets)
    positions = by * WALK.root_positions - (0.0, 0.0, sunk)
    rotations_ = WALK.rotations if rotations is None else rotations
    return Motion(larger, rotations_, positions, WALK.frame_rate)


def test_scaled_body_has_no_error():
    given = acted(grown(1.3), ROLES)

    figures, reached = world_figures(SOURCE, given), ik_figures(SOURCE, given)

    ratios = {"knee acceleration", "elbow acceleration"}
    assert [figures[name] for name in ratios] == pytest.approx([1.0, 1.0])
    assert max(figure for name, figure in figures.items() if name not in ratios) < 1e-4
    slides = reached.pop("slide of source cm/s"), reached.pop("slide cm/s")
    assert slides[0] == pytest.approx(slides[1])
    assert max(reached.values()) < 1e-6


def test_sunken_body_is_measured_although_its_limbs_reach():
    given = acted(grown(1.0, sunk=0.3), ROLES)
    lowest = 100.0 * SOURCE.poses.positions[..., 2].min()

    figures, reached = world_figures(SOURCE, given), ik_figures(SOURCE, given)

    assert reached["IK: foot cm"] == pytest.approx(0.0, abs=1e-9)
    assert figures["hand cm"] == pytest.approx(30.0) and figures["head cm"] == pytest.approx(
        30.0
    )
    assert figures["path at most"] == pytest.approx(0.0, abs=1e-9)
    assert figures["below floor cm"] == pytest.approx(30.0 - max(lowest, 0.0), abs=1.0)


def test_leaning_trunk_is_measured():
    """By less than the ten degrees of the spine, which begins above the hips."""
    spine = ROLES.indices(WALK.skeleton)["spine"]
    rotations = WALK.rotations.copy()
    lean = quaternion_from_rotation_vector([np.radians(10.0), 0.0, 0.0])
    rotations[:, spine] = multiply(rotations[:, spine], lean)

    figures = world_figures(SOURCE, acted(grown(1.0, rotations=rotations), ROLES))

    assert 5.0 < figures["trunk at most"] <= 10.1
    assert figures["head cm"] > 2.0


def test_extended_take_has_no_jumps():
    longer = to_and_fro(WALK, 500)

    step = np.abs(np.diff(WALK.root_positions, axis=0)).max()
    assert longer.n_frames == 500
    assert np.abs(np.diff(longer.root_positions, axis=0)).max() == pytest.approx(step)
    assert np.array_equal(longer.root_positions[: WALK.n_frames], WALK.root_positions)
