"""Made-up takes that fool a judge of axes, size and floor: none may be wrong in silence."""

import numpy as np
import pytest

from solvers.motion import FileConventions, Motion, Skeleton, world_poses
from solvers.recordings import Axis, FloorPlacement, ReadingSettings, Unit, read_as, write_bvh
from solvers.recordings.conventions import conventions_of, floor_level, stature
from solvers.recordings.skeleton_files.smpl_bodies.joints import smpl_joints
from solvers.rotations import multiply, quaternion_from_euler

F, RATE = 120, 30.0
NAMES, PARENTS, Y_UP_OFFSETS = smpl_joints(hands=False)
OFFSETS = Y_UP_OFFSETS @ np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]])
"""Z up, facing -Y."""


def body(height: float = 1.75, *, root=(1.0, 0.0, 0.0, 0.0), hips=None) -> Motion:
    """Return a take on the spot of an actor whose left arm rises; standing unless turned."""
    rotations = np.zeros((F, len(NAMES), 4))
    rotations[..., 0] = 1.0
    rising = np.zeros((F, 3))
    rising[:, 1] = -np.linspace(0.0, 1.0, F)
    rotations[:, NAMES.index("left_shoulder")] = quaternion_from_euler(rising, "XYZ")
    rotations[:, 0] = root
    size = height / 1.75
    if hips is None:
        hips = (0.3, 0.2, 0.96 * size)
    positions = np.broadcast_to(np.array(hips, dtype=float), (F, 3))
    return Motion(Skeleton(NAMES, PARENTS, size * OFFSETS), rotations, positions, RATE)


def turn(degrees: float) -> np.ndarray:
    """Return a rotation about X."""
    return quaternion_from_euler(np.radians([[degrees, 0.0, 0.0]]), "XYZ")


def read(motion: Motion, path, **settings):
    """Write a take as BVH in centimeters and read it; return it and what was said."""
    write_bvh(motion, path)
    messages: list[str] = []
    floor = settings.pop("floor", FloorPlacement.NEVER)
    motion = read_as(
        path,
        ReadingSettings(**settings),
        floor=floor,
        progress=lambda _, message="": messages.append(message),
    )
    return motion, " ".join(messages)


def positions_of(motion) -> dict[str, np.ndarray]:
    positions = world_poses(motion.skeleton, motion.rotations, motion.root_positions).positions
    return {name: positions[:, k] for k, name in enumerate(motion.skeleton.names)}


def is_standing(motion) -> bool:
    found = positions_of(motion)
    return bool(((found["head"] - found["pelvis"])[:, 2] > 0.2 * stature(motion)).all())


@pytest.mark.parametrize(("height", "asks"), [(0.9, False), (1.75, False), (2.3, False)])
def test_people_of_all_sizes_are_no_question(tmp_path, height, asks):
    motion, messages = read(body(height), tmp_path / "a.bvh")

    assert stature(motion) == pytest.approx(height, rel=0.02)
    assert ("m tall" in messages) == asks
    assert is_standing(motion)


@pytest.mark.parametrize("height", [3.8, 4.0])
def test_a_giant_is_a_question(tmp_path, height):
    motion, messages = read(body(height), tmp_path / "a.bvh")

    assert stature(motion) == pytest.approx(height, rel=0.02)
    assert (
        f"The actor is {height:.2g} m tall; set Unit or Scale if this is not right" in messages
    )


def test_a_doll_is_a_question_once_its_unit_is_given(tmp_path):
    motion, messages = read(body(0.2), tmp_path / "a.bvh", unit=Unit.CENTIMETRES)

    assert stature(motion) == pytest.approx(0.2, rel=0.02)
    assert "The actor is 0.2 m tall" in messages


def test_small_child_or_adult_in_inches_is_reported(tmp_path):
    _, messages = read(body(0.75), tmp_path / "a.bvh")

    assert "Lengths are interpreted as inches, by the size of the body" in messages


@pytest.mark.parametrize("hips", [(0.0, 0.0, 0.1), (2.0, 3.0, 0.1)])
@pytest.mark.parametrize("degrees", [90.0, -90.0])
def test_who_lies_all_the_time_lies_or_is_a_question(tmp_path, hips, degrees):
    motion, messages = read(body(root=turn(degrees), hips=hips), tmp_path / "a.bvh")

    lies = np.ptp(np.stack(list(positions_of(motion).values()))[..., 2]) < 1.0
    assert lies or "is interpreted as up, but the take does not show it clearly" in messages


def test_a_handstand_stays_one(tmp_path):
    motion, messages = read(body(root=turn(180.0), hips=(0.0, 0.0, 1.2)), tmp_path / "a.bvh")

    found = positions_of(motion)
    assert ((found["head"] - found["pelvis"])[:, 2] < -0.4).all()
    assert "does not show it clearly" in messages


def test_a_handstand_is_put_on_its_hands(tmp_path):
    """Arms next to the head: the hands are lowest, and the feet are no floor."""
    upside_down = body(root=turn(180.0), hips=(0.0, 0.0, 3.0))
    for side, sign in (("left", 1.0), ("right", -1.0)):
        rotations = quaternion_from_euler(np.radians([[0.0, -90.0 * sign, 0.0]]), "XYZ")
        upside_down.rotations[:, NAMES.index(f"{side}_shoulder")] = rotations
    motion, _ = read(upside_down, tmp_path / "a.bvh", floor=FloorPlacement.ALWAYS, up=Axis.Y)

    wrist = positions_of(motion)["left_wrist"][:, 2]
    assert wrist.min() == pytest.approx(0.03, abs=0.02)


def test_a_first_frame_far_above_the_take_is_no_floor(tmp_path):
    take = body()
    take.root_positions[0] += (0.0, 0.0, 5.0)
    take.rotations[0, 1:] = (1.0, 0.0, 0.0, 0.0)

    motion, _ = read(take, tmp_path / "a.bvh", floor=FloorPlacement.ALWAYS)

    assert positions_of(motion)["left_foot"][1:, 2] == pytest.approx(0.02, abs=0.02)
    assert is_standing(motion)


def test_a_jump_is_no_floor():
    """Three jumps: the level is that of the landings, not of a glitch or of feet that sink."""
    take = body()
    time = np.arange(F) / RATE
    flying = np.maximum(0.0, 0.5 * np.sin(2.0 * np.pi * 0.75 * time))
    level = floor_level(take)
    take.root_positions[:, 2] += flying
    take.root_positions[60, 2] -= 0.8
    take.root_positions[24:36, 2] -= 0.6 * np.sin(np.pi * np.arange(12) / 12)

    assert floor_level(take) == pytest.approx(level, abs=0.02)


def test_a_platform_stays_where_it_is(tmp_path):
    """A person who stands on a table of a measured room."""
    take = plain_names(body(hips=(0.0, 0.0, 0.96 + 0.7)))

    motion, _ = read(take, tmp_path / "a.bvh", floor=FloorPlacement.AUTO)

    assert motion.root_positions[0, 2] == pytest.approx(1.66, abs=0.01)


def test_hips_at_the_origin_are_put_on_the_floor(tmp_path):
    motion, _ = read(body(hips=(0.0, 0.0, 0.0)), tmp_path / "a.bvh", floor=FloorPlacement.AUTO)

    assert positions_of(motion)["left_foot"][:, 2] == pytest.approx(0.02, abs=0.03)
    assert not conventions_of(motion).has_floor


def test_wrapper_root_is_no_evidence(tmp_path):
    """A root that stays at the origin above hips that walk away and up a hill."""
    path = np.linspace((0.0, 0.0, 0.96), (9.0, -6.0, 1.4), F)
    take = body()
    above = Skeleton(
        ("Root", *NAMES), (-1, *(parent + 1 for parent in PARENTS)),
        np.concatenate([np.zeros((1, 3)), OFFSETS]),
    )  # fmt: skip
    rotations = np.concatenate([np.tile([1.0, 0, 0, 0], (F, 1, 1)), take.rotations], axis=1)
    write_bvh(Motion(above, rotations, path, RATE), tmp_path / "a.bvh")
    text = (tmp_path / "a.bvh").read_text()
    motion = read_as(tmp_path / "a.bvh")

    assert "Root" in text
    assert is_standing(motion)
    assert conventions_of(motion).up == "Y"


@pytest.mark.parametrize("up", ["Y", "Z", "-Y"])
def test_joints_in_an_array_stand_whatever_is_up(tmp_path, up):
    joints = np.stack(list(positions_of(body()).values()), axis=1)
    axes = {"Z": joints, "Y": joints[..., [0, 2, 1]] * (1, 1, -1), "-Y": None}
    axes["-Y"] = axes["Y"] * (1, -1, -1)
    np.save(tmp_path / "a.npy", axes[up])

    recording = read_as(tmp_path / "a.npy")

    heights = recording.tracks.positions[..., 2]
    head, foot = NAMES.index("head"), NAMES.index("left_foot")
    assert (heights[:, head] - heights[:, foot] > 1.0).all()
    assert conventions_of(recording).up == up


def test_unnamed_points_with_y_up_stand(tmp_path):
    joints = np.stack(list(positions_of(body()).values()), axis=1)[:, :17]
    np.save(tmp_path / "a.npy", joints[..., [0, 2, 1]] * (1, 1, -1))

    points = read_as(tmp_path / "a.npy")

    assert np.ptp(points.positions[0, :, 2]) > 1.3
    assert conventions_of(points).sentence().startswith("Y is up, Z is forward")


@pytest.mark.parametrize("axis", [Axis.X, Axis.Z, Axis.MINUS_Y])
def test_axes_that_are_given_are_taken_for_every_kind(tmp_path, axis):
    """Turning what was judged gives what reading with those axes gives."""
    motion, _ = read(body(), tmp_path / "a.bvh", up=axis)

    assert conventions_of(motion).up == axis.axis
    assert conventions_of(motion).confidence == 1.0
    up = {"X": 0, "Y": 1, "Z": 2}[axis.axis[-1]]
    sign = -1.0 if axis.axis[0] == "-" else 1.0
    plain, _ = read(body(), tmp_path / "b.bvh")
    x, y, z = np.moveaxis(positions_of(plain)["head"], -1, 0)
    in_file = np.stack([x, z, -y], axis=-1)
    assert positions_of(motion)["head"][:, 2] == pytest.approx(sign * in_file[:, up], abs=1e-3)


def test_bones_along_one_axis_at_rest_stand(tmp_path):
    """Limbs whose rest pose runs along X, as some exporters write it."""
    take = body(hips=(0.0, 0.0, 0.96))
    offsets, rotations = OFFSETS.copy(), take.rotations.copy()
    children = [[c for c, p in enumerate(PARENTS) if p == j] for j in range(len(NAMES))]
    swings = {}
    for joint, below in enumerate(children):
        if len(below) == 1 and joint:
            bone = OFFSETS[below[0]]
            offsets[below[0]] = (np.linalg.norm(bone), 0.0, 0.0)
            swings[joint] = _between((1.0, 0.0, 0.0), bone / np.linalg.norm(bone))
    for joint, parent in enumerate(PARENTS):
        own = swings.get(joint, np.array([1.0, 0, 0, 0]))
        above = swings.get(parent, np.array([1.0, 0, 0, 0])) * (1, -1, -1, -1)
        rotations[:, joint] = multiply(multiply(above, rotations[:, joint]), own)
    motion = Motion(Skeleton(NAMES, PARENTS, offsets), rotations, take.root_positions, RATE)

    found, _ = read(motion, tmp_path / "a.bvh")

    assert is_standing(found)
    assert conventions_of(found) == FileConventions(
        "Y", "Z", 0.01, conventions_of(found).rest_up
    )


def _between(one, other) -> np.ndarray:
    half = np.concatenate([[1.0 + np.dot(one, other)], np.cross(one, other)])
    if half[0] < 1e-9:
        return np.array([0.0, 0.0, 0.0, 1.0])
    return half / np.linalg.norm(half)


@pytest.mark.parametrize(("up_m", "words"), [(0.7, "0.7 m above"), (-0.2, "0.2 m below")])
def test_an_actor_off_the_floor_is_a_question(tmp_path, up_m, words):
    """No person comes near the floor: a platform, or a floor that is elsewhere."""
    take = plain_names(body(hips=(0.0, 0.0, 0.96 + up_m)))

    for floor in FloorPlacement:
        _, messages = read(take, tmp_path / "a.bvh", floor=floor)
        asks = floor is FloorPlacement.AUTO
        assert (f"The actor stays {words} the floor" in messages) == asks


def test_an_actor_far_below_the_floor_is_put_on_it(tmp_path):
    """A camera at chest height is the origin of the take, and the hips are below it."""
    take = plain_names(body(hips=(0.0, 2.0, -0.35)))

    motion, messages = read(take, tmp_path / "a.bvh", floor=FloorPlacement.AUTO)

    assert positions_of(motion)["b_left_foot"][:, 2] == pytest.approx(0.02, abs=0.03)
    assert "the floor" not in messages


@pytest.mark.parametrize(("height", "degrees"), [(0, 0), (0, 60), (0, 90), (0.1, 90)])
def test_hips_at_height_0_stand_on_no_floor_in_any_pose(tmp_path, height, degrees):
    take = plain_names(body(root=turn(degrees), hips=(0.0, 2.0, height)))
    motion, _ = read(take, tmp_path / "a.bvh", floor=FloorPlacement.AUTO, up=Axis.Y)

    assert floor_level(motion) == pytest.approx(bool(height) * floor_level(take), abs=1e-3)


def test_steps_down_are_no_wrong_floor(tmp_path):
    """Who goes down into a cellar for a while stands on the floor before."""
    take = plain_names(body())
    take.root_positions[70:, 2] -= 1.5

    motion, messages = read(take, tmp_path / "a.bvh", floor=FloorPlacement.AUTO)

    assert motion.root_positions[:60, 2] == pytest.approx(0.96, abs=0.01)
    assert "the floor" not in messages


def plain_names(motion: Motion) -> Motion:
    """Return a take whose names are those of no video model, and whose rest hips are at 0."""
    names = tuple(f"b_{name}" for name in motion.skeleton.names)
    offsets = np.concatenate([np.zeros((1, 3)), motion.skeleton.offsets[1:]])
    skeleton = Skeleton(names, PARENTS, offsets)
    return Motion(skeleton, motion.rotations, motion.root_positions.copy(), RATE)
