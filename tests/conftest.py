"""Fixtures of all tests."""

import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

from solvers.errors import SolveCancelled
from solvers.motion import Motion, Skeleton
from solvers.progress import Progress
from solvers.rotations.representations import quaternion_from_rotation_vector

pytest_plugins = ("common_fixtures",)

# The same examples every time, and no clock: a busy machine must not fail a test.
settings.register_profile("repeatable", deadline=None, derandomize=True, database=None)
settings.load_profile("repeatable")

ON_ONE_PYTHON = {
    "command_line/arguments/test_several_bodies.py": (3, 13),
    "command_line/batches/test_bad_files.py": (3, 13),
    "command_line/batches/test_batch.py": (3, 13),
    "command_line/batches/test_faults_in_batches.py": (3, 13),
    "command_line/batches/test_many_machines.py": (3, 11),
    "command_line/batches/test_report.py": (3, 11),
    "command_line/farm": (3, 11),
    "command_line/sharing/test_claims.py": (3, 11),
    "command_line/sharing/test_manifests_and_hooks.py": (3, 13),
    "command_line/sharing/test_shards.py": (3, 13),
    "command_line/test_capture_people_and_cameras.py": (3, 11),
    "command_line/test_capture_verb.py": (3, 11),
    "command_line/test_command_line.py": (3, 11),
    "command_line/test_fix_verb.py": (3, 13),
    "command_line/test_follow.py": (3, 11),
    "command_line/test_library_verbs.py": (3, 11),
    "command_line/test_odd_folders.py": (3, 13),
    "command_line/test_reconstruct_verb.py": (3, 11),
    "command_line/test_replay_verb.py": (3, 13),
    "command_line/test_residuals_verb.py": (3, 11),
    "command_line/test_retarget_verbs.py": (3, 13),
    "command_line/test_simulate_verb.py": (3, 13),
    "command_line/test_solve_verb.py": (3, 11),
    "command_line/test_threads_option.py": (3, 13),
    "command_line/test_vary_verb.py": (3, 13),
    "denoising": (3, 13),
    "depth_scene/test_depth_actor.py": (3, 13),
    "depth_scene/test_depth_floor.py": (3, 11),
    "depth_tracking": (3, 11),
    "feet": (3, 13),
    "gestures": (3, 11),
    "markers": (3, 11),
    "motion/humanoid": (3, 13),
    "motion_fitting": (3, 13),
    "physics": (3, 13),
    "reconstruction": (3, 13),
    "recordings/depth_files": (3, 11),
    "recordings/growing": (3, 11),
    "recordings/joint_files": (3, 11),
    "recordings/marker_files": (3, 13),
    "recordings/skeleton_files/test_acclaim.py": (3, 13),
    "recordings/skeleton_files/bvh/test_reading.py": (3, 13),
    "recordings/skeleton_files/bvh/test_axes.py": (3, 13),
    "recordings/skeleton_files/bvh/test_bodies.py": (3, 13),
    "recordings/skeleton_files/bvh/test_positions.py": (3, 13),
    "recordings/skeleton_files/bvh/test_unit.py": (3, 13),
    "recordings/skeleton_files/bvh/test_writing.py": (3, 13),
    "recordings/skeleton_files/test_kimodo.py": (3, 13),
    "recordings/skeleton_files/test_mvnx.py": (3, 13),
    "recordings/skeleton_files/test_smpl.py": (3, 13),
    "recordings/skeleton_files/test_smpl_converters.py": (3, 13),
    "recordings/skeleton_files/test_vrma.py": (3, 13),
    "recordings/streams": (3, 13),
    "recordings/test_fuzz.py": (3, 13),
    "recordings/test_fuzz_joints.py": (3, 11),
    "recordings/test_streaming.py": (3, 11),
    "retargeting": (3, 13),
    "retrieval": (3, 11),
    "signals/test_noise.py": (3, 11),
    "test_archives.py": (3, 13),
    "test_imports.py": (3, 13),
    "test_solver_contracts.py": (3, 13),
    "variation": (3, 13),
    "workflows/test_capture_recording.py": (3, 11),
    "workflows/test_clean_from_library.py": (3, 13),
    "workflows/test_describe_files.py": (3, 11),
    "workflows/test_fix_lacking_takes.py": (3, 13),
    "workflows/test_fix_take.py": (3, 13),
    "workflows/test_follow_depth.py": (3, 11),
    "workflows/test_index_at_once.py": (3, 11),
    "workflows/test_index_files.py": (3, 11),
    "workflows/test_joints_from_source.py": (3, 11),
    "workflows/test_live_session.py": (3, 11),
    "workflows/test_live_take.py": (3, 11),
    "workflows/test_motion_from_markers.py": (3, 11),
    "workflows/test_pose_take.py": (3, 11),
    "workflows/test_prior_validation.py": (3, 13),
    "workflows/test_reconstruct_from_library.py": (3, 13),
    "workflows/test_reconstruct_recording.py": (3, 13),
    "workflows/test_reliability_terms.py": (3, 13),
    "workflows/test_vary_motions.py": (3, 13),
}
"""Below tests/solvers: families of pure numpy, readers, and long files, which run on one Python
where there are two, unless they are named. What they test runs in both Blenders."""
HERE = Path(__file__).parent
ONLY_ON = {HERE / "solvers" / name: where for name, where in ON_ONE_PYTHON.items()}
assert all(path.exists() for path in ONLY_ON)
HAS_BOTH = (HERE.parent / ".venv-5.2" / "ready").exists()


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Skip what runs on another Python, which then need not be imported here."""
    own = sys.version_info[:2]
    if not HAS_BOTH or ONLY_ON.get(collection_path, own) == own:
        return None
    named = [
        (config.invocation_params.dir / arg.split("::")[0]).resolve() for arg in config.args
    ]
    return not any(path.is_relative_to(collection_path) for path in named) or None


def pytest_report_header() -> str:
    own = sys.version_info[:2]
    n_elsewhere = sum(HAS_BOTH and where != own for where in ONLY_ON.values())
    return f"{n_elsewhere} files and folders run on another Python (tests/conftest.py)"


@pytest.fixture
def cancel() -> Progress:
    """A progress that cancels at its first report."""

    def raise_cancelled(fraction: float, message: str = "") -> None:
        raise SolveCancelled("Cancelled.")

    return raise_cancelled


@pytest.fixture
def leg() -> Skeleton:
    """A hip, a knee, an ankle and an end site, hanging down from 0.9 m."""
    offsets = np.array([[0, 0, 0.9], [0, 0, -0.45], [0, 0, -0.42], [0, -0.15, -0.03]])
    return Skeleton(("hip", "knee", "ankle", "ankle_end"), (-1, 0, 1, 2), offsets)


@pytest.fixture
def swinging_leg(leg) -> Motion:
    """Two seconds at 60 Hz: the leg swings once a second and moves forward at 1 m/s."""
    time = np.arange(120) / 60.0
    vectors = np.zeros((120, 4, 3))
    vectors[:, 0, 0] = 0.5 * np.sin(2 * np.pi * time)
    vectors[:, 1, 0] = -0.4 * (1 + np.cos(2 * np.pi * time))
    vectors[:, 2, 0] = 0.2 * np.sin(2 * np.pi * time + 1)
    root_positions = np.stack([0 * time, -time, 0.9 + 0.02 * np.cos(4 * np.pi * time)], axis=-1)
    return Motion(leg, quaternion_from_rotation_vector(vectors), root_positions, 60.0)
