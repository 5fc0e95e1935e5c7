"""How often the up axis of points is right where neither the file nor their names state it.

    make bench-up-axis
    make bench-up-axis ARGUMENTS=--docs    # into docs/benchmarks/importing.md

The points are the joints of the takes of the first press, whole and in cuts of three seconds,
turned about the vertical and given with Y and with Z up. The origin of some files is on the
floor, that of others at the camera or at the hips.
"""

import argparse
from collections.abc import Callable, Iterator
from time import perf_counter

import numpy as np

from solvers.arrays import Array
from solvers.motion import find_humanoid_map, forward_kinematics
from solvers.recordings.conventions import y_up_from_z_up
from solvers.recordings.conventions.points import estimate_axes_of_points

from ..first_press.takes import DEVELOPMENT, SCORED, Take, read
from ..shared.report import DOCS, Report
from ..shared.tables import table

CUT_S = 3.0
CAMERA_M = np.array([0.0, 3.0, 1.3])
"""From the first position of the hips on the ground to the camera."""
FULL = 0.99
"""Confidence from which no question is asked."""
ORIGINS: dict[str, Callable[[Array, int], Array]] = {
    "on the floor": lambda points, hips: points,
    "at the camera": lambda points, hips: points - points[0, hips] * [1, 1, 0] - CAMERA_M,
    "at the hips": lambda points, hips: points - points[:, [hips]],
}


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--docs", action="store_true", help="rewrite docs/benchmarks/importing.md"
    )
    arguments, started = parser.parse_args(), perf_counter()
    clips = [clip for take in (*DEVELOPMENT, *SCORED) for clip in _cut(take)]
    header = ["origin", "cuts", "wrong", "wrong, no question", "right, with a question"]
    rows = {name: _judge(clips, move) for name, move in ORIGINS.items()}
    report = Report(arguments.docs, DOCS / "benchmarks" / "importing.md")
    report.part("up axis", [table(header, rows)], perf_counter() - started)


def _cut(take: Take) -> Iterator[tuple[Array, int]]:
    """Return a take and its cuts, shape (n_frames, n_joints, 3), with the index of the hips."""
    motion = read(take)
    points = forward_kinematics(motion).positions
    hips = motion.skeleton.names.index(find_humanoid_map(motion.skeleton).joints["hips"])
    length = round(CUT_S * motion.frame_rate)
    yield points, hips
    for start in range(0, len(points) - length, length):
        yield points[start : start + length], hips


def _judge(clips: list[tuple[Array, int]], move: Callable[[Array, int], Array]) -> list[str]:
    rng, verdicts = np.random.default_rng(0), []
    for points, hips in clips:
        angle = rng.uniform(0.0, 2.0 * np.pi)
        cosine, sine = np.cos(angle), np.sin(angle)
        turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        moved = move(points @ turn.T, hips)
        for up, given in (("Z", moved), ("Y", y_up_from_z_up(moved))):
            estimate = estimate_axes_of_points(given, "", 1.0)
            verdicts.append((estimate.up[-1] == up, estimate.confidence >= FULL))
    is_right, is_sure = np.array(verdicts).T
    counts = len(verdicts), (~is_right).sum(), (~is_right & is_sure).sum()
    return [str(count) for count in (*counts, (is_right & ~is_sure).sum())]


if __name__ == "__main__":
    main()
