"""Columns of rotations, velocities and pixels are no positions, however they are called."""

import numpy as np
import pytest

from solvers.errors import InvalidFileError
from solvers.motion import Tracks, find_humanoid_map, forward_kinematics
from solvers.samples import walking_gait

F = 40

NAMES = [f"{part}{side}" for side in ("Left", "Right") for part in (
    "UpperArm", "LowerArm", "Hand", "Thigh", "Calf", "Foot")]  # fmt: skip


@pytest.fixture
def walk():
    """Positions by role, meters, Z up."""
    motion = walking_gait()
    roles = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    positions = forward_kinematics(motion).positions[:F]
    return {role: positions[:, at] for role, at in roles.items()}


def table(titles, n_frames=5):
    """Return a table of points in any places, which sway by hundredths of their distances."""
    rng = np.random.default_rng(1)
    rows = rng.normal(size=len(titles)) + 0.01 * rng.normal(size=(n_frames, len(titles)))
    return "\n".join([",".join(titles), *(",".join(f"{x:.4f}" for x in row) for row in rows)])


def titles(pattern, axes="xyz", names=NAMES):
    return [pattern.format(name=name, axis=axis) for name in names for axis in axes]


QUANTITIES = [
    "{name}_r{axis}", "{name}_r_{axis}", "{name}_q_{axis}", "{name}_R{axis}", "{name}_v{axis}",
    "{name}_v_{axis}", "{name}_a{axis}", "{name}_w{axis}", "{name}_speed_{axis}",
    "{name}_angvel_{axis}", "{name}_force_{axis}", "{name}_deg_{axis}", "{name}Rot_{axis}",
    "{name}_Winkel_{axis}", "{name}_vitesse_{axis}", "{name}_velocidad_{axis}",
    "{name}_{axis} (deg)", "{name}_{axis} (px)", "{name}_Scale3D_{axis}",
]  # fmt: skip


@pytest.mark.parametrize("pattern", QUANTITIES)
def test_other_quantities_are_refused(read_any, pattern):
    with pytest.raises(InvalidFileError):
        read_any(table(titles(pattern)))


@pytest.mark.parametrize("pattern", QUANTITIES)
def test_other_quantities_next_to_positions_are_left_out(read_any, pattern):
    both = titles("{name}_{axis}") + titles(pattern)
    content = table(both)
    alone = "\n".join(
        ",".join(line.split(",")[: 3 * len(NAMES)]) for line in content.split("\n")
    )

    recordings = [read_any(content), read_any(alone)]

    assert np.array_equal(*(each.tracks.positions for each in recordings), equal_nan=True)


def test_numbered_axes_of_rotations_are_refused(read_any):
    with pytest.raises(InvalidFileError):
        read_any(table(titles("{name}_rot_{axis}", "012")))


def test_points_from_a_to_z_are_all_kept(read_any):
    names = [f"Marker_{letter}" for letter in "ABCQRVW"] + ["Stick", "Ball"]

    recording = read_any(table(titles("{name}_{axis}", names=names)))

    assert isinstance(recording, Tracks)
    assert set(recording.names) == {*names} - {"Marker_Q"}


@pytest.mark.parametrize("kind", ["Velocity", "Angles"])
def test_a_quantity_above_the_axes_is_left_out(read_any, kind):
    rows = table(["x"] * 6 * len(NAMES)).split("\n")[1:]
    above = [
        ",".join(name for name in NAMES for _ in range(6)),
        ",".join([kind, "", "", "Position", "", ""] * len(NAMES)),
        ",".join("xyz" * 2 * len(NAMES)),
    ]
    kept = [column for column in range(6 * len(NAMES)) if column % 6 >= 3]
    alone = [",".join(line.split(",")[column] for column in kept) for line in [*above, *rows]]

    recordings = [read_any("\n".join(lines)) for lines in ([*above, *rows], alone)]

    assert np.array_equal(*(each.tracks.positions for each in recordings), equal_nan=True)


def test_a_quantity_above_all_axes_is_refused(read_any):
    rows = table(["x"] * 3 * len(NAMES)).split("\n")[1:]
    above = [
        ",".join(name for name in NAMES for _ in range(3)),
        ",".join(["Angles"] + [""] * (3 * len(NAMES) - 1)),
        ",".join("xyz" * len(NAMES)),
    ]

    with pytest.raises(InvalidFileError):
        read_any("\n".join([*above, *rows]))


@pytest.mark.parametrize("title", ["{}.{}", "{}_{}"])
def test_tables_of_angles_are_refused(read_any, walk, rng, title):
    """Before, a table of angles whose titles do not say so came in as a crumpled body."""
    swing = np.sin(np.linspace(0.0, 6.0, F))[:, None]
    angles = {name: 40.0 * rng.normal(size=3) * swing for name in walk}
    titles = [title.format(name, axis) for name in walk for axis in "xyz"]
    rows = np.concatenate([*angles.values()], axis=1)
    lines = [",".join(f"{x:.3f}" for x in row) for row in rows]

    with pytest.raises(InvalidFileError, match=r"change their length by .*no positions"):
        read_any("\n".join([",".join(titles), *lines]))


@pytest.mark.parametrize("kind", ["zeros", "minus one", "collapsed", "noise", "picture"])
def test_positions_whose_bones_change_their_length_are_read(read_any, walk, rng, kind):
    """Joints that were not observed, depth of one camera, and the picture of a camera."""
    points = np.stack([*walk.values()], axis=1)
    is_lost = rng.random(points.shape[:2]) < 0.3
    if kind in {"zeros", "minus one"}:
        points[is_lost] = 0.0 if kind == "zeros" else -1.0
    elif kind == "collapsed":
        points[: F // 3] = points[: F // 3, :1]
    elif kind == "noise":
        points[..., 1] += rng.normal(scale=0.2, size=points.shape[:2])
    else:
        distance = 6.0 + points[..., 1:2]
        points = np.concatenate([0.9 * points[..., ::2] / distance, distance], axis=2)
    titles = [f"{name}_{axis}" for name in walk for axis in "xyz"]
    lines = [",".join(f"{x:.5f}" for x in row) for row in points.reshape(F, -1)]

    recording = read_any("\n".join([",".join(titles), *lines]))

    assert recording.tracks.n_frames == F
