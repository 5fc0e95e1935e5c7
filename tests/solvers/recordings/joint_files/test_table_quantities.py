"""Columns of rotations, velocities and pixels are no positions, however they are called."""

import numpy as np
import pytest

from solvers.errors import InvalidFileError
from solvers.motion import JointRecording, Tracks, find_humanoid_map, forward_kinematics
from solvers.rotations import euler_from_quaternion
from solvers.samples import walking_gait

NAMES = [f"{part}{side}" for side in ("Left", "Right") for part in (
    "UpperArm", "LowerArm", "Hand", "Thigh", "Calf", "Foot")]  # fmt: skip


def table(titles, n_frames=5):
    rows = np.random.default_rng(1).normal(size=(n_frames, len(titles)))
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


def of_gait(quantity):
    """Return a table of the walk with titles that do not say what the numbers are."""
    motion = walking_gait()
    roles = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    columns = quantity(motion)[:, list(roles.values())]
    lines = [",".join(f"{role}_{axis}" for role in roles for axis in "xyz")]
    rows = columns.reshape(len(columns), -1)
    return "\n".join([*lines, *(",".join(f"{x:.4f}" for x in row) for row in rows)])


@pytest.mark.parametrize("unit", [np.degrees, np.asarray])
@pytest.mark.parametrize("order", ["XYZ", "ZXY"])
def test_angles_without_a_word_about_them_are_refused(read_any, unit, order):
    """They came in as a crumpled body."""
    content = of_gait(lambda motion: unit(euler_from_quaternion(motion.rotations, order)))

    with pytest.raises(InvalidFileError, match="holds angles or other numbers instead of"):
        read_any(content)


def standing_almost_still(motion, rng):
    """Return the angles of a pose, with little movement: all lengths between them persist."""
    sides = {
        name: name.replace("Left", "").replace("Right", "") for name in motion.skeleton.names
    }
    pose = {part: rng.normal(scale=30.0, size=3) for part in sorted({*sides.values()})}
    angles = np.array([pose[sides[name]] for name in motion.skeleton.names])
    return angles + rng.normal(scale=1.0, size=(motion.n_frames, *angles.shape))


def test_angles_of_who_hardly_moves_are_refused(read_any, rng):
    """One table of four came in as a body: their numbers change as little as bones."""
    content = of_gait(lambda motion: standing_almost_still(motion, rng))

    with pytest.raises(InvalidFileError, match="holds angles or other numbers instead of"):
        read_any(content)


def test_arms_in_front_of_a_face_are_positions(read_any, rng):
    """Of the upper body alone the hands may be as near to the head as the shoulders."""
    motion = walking_gait()
    roles = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    points = forward_kinematics(motion).positions + np.array([0.0, 3.0, 0.0])
    for side in ("left", "right"):
        points[:, roles[f"{side}Hand"]] = points[:, roles["head"]] + 0.1
        points[:, roles[f"{side}LowerArm"]] = points[:, roles["chest"]] + (0.1, -0.2, 0.0)
    upper = [role for role in roles if not role.endswith(("Leg", "Foot", "Toes"))]
    lines = [",".join(f"{role}_{axis}" for role in upper for axis in "xyz")]
    rows = points[:, [roles[role] for role in upper]].reshape(len(points), -1)
    content = "\n".join([*lines, *(",".join(f"{x:.4f}" for x in row) for row in rows)])

    assert read_any(content)


def without_a_person(positions, rng):
    positions[: len(positions) // 5] = 0.0


def with_lost_joints(positions, rng):
    positions[rng.random(positions.shape[:2]) < 0.6] = 0.0


def with_noise(positions, rng):
    positions += rng.normal(scale=0.12, size=positions.shape)


def with_joints_of_poor_depth(positions, rng):
    depths = positions[:, ::2, 1]
    depths += rng.normal(scale=0.4, size=depths.shape)


@pytest.mark.parametrize(
    "disturb", [without_a_person, with_lost_joints, with_noise, with_joints_of_poor_depth]
)
def test_poor_positions_are_positions(read_any, rng, disturb):
    """Trackers write zeros for what they do not see, and noise; the actor is 3 m away."""

    def disturbed(motion):
        positions = forward_kinematics(motion).positions + np.array([0.0, 3.0, 0.0])
        disturb(positions, rng)
        return positions

    assert isinstance(read_any(of_gait(disturbed)), JointRecording)
