"""The unit of a BVH file follows from the body, whatever else the file contains."""

import pytest

from solvers.recordings.conventions import stature
from solvers.recordings.read_as import questions_of
from solvers.recordings.reading_settings import FloorPlacement

BODY = {
    "Hips": ("", (0, 95, 0)), "Spine": ("Hips", (0, 10, 0)), "Spine1": ("Spine", (0, 12, 0)),
    "Spine2": ("Spine1", (0, 13, 0)), "Neck": ("Spine2", (0, 15, 0)),
    "Head": ("Neck", (0, 10, 2)),
}  # fmt: skip
"""Parent and OFFSET in centimeters, in the proportions of a Mixamo rig."""
LIMBS = {
    "Shoulder": ("Spine2", (6, 10, 0)), "Arm": ("Shoulder", (12, 0, 0)),
    "ForeArm": ("Arm", (28, 0, 0)), "Hand": ("ForeArm", (26, 0, 0)),
    "UpLeg": ("Hips", (9, -5, 0)), "Leg": ("UpLeg", (0, -42, 0)), "Foot": ("Leg", (0, -42, 0)),
    "ToeBase": ("Foot", (0, -6, 12)),
}  # fmt: skip


def hierarchy(scale):
    """Return parent and offset by joint of a body of 1.7 m in units of 1 cm / scale."""
    joints = dict(BODY)
    for side, sign in (("Left", 1), ("Right", -1)):
        for name, (parent, (x, y, z)) in LIMBS.items():
            above = side + parent if parent in LIMBS else parent
            joints[side + name] = above, (sign * x, y, z)
    return {
        name: (parent, tuple(scale * each for each in offset))
        for name, (parent, offset) in joints.items()
    }


def bvh_text(joints):
    """Return a file of one frame; joints move where their parent is the root."""
    root = next(iter(joints))
    values = []

    def lines(name):
        parent, offset = joints[name]
        moves = parent in ("", root)
        values.extend([*offset, 0, 0, 0] if moves else [0, 0, 0])
        position = "Xposition Yposition Zposition " * moves
        yield f"{'JOINT' if parent else 'ROOT'} {name}\n{{\nOFFSET {' '.join(map(str, offset))}"
        yield f"CHANNELS {6 if moves else 3} {position}Zrotation Xrotation Yrotation"
        children = [child for child, (above, _) in joints.items() if above == name]
        for child in children:
            yield from lines(child)
        yield "}" if children else "End Site\n{\nOFFSET 0 0 0\n}\n}"

    head = "\n".join(["HIERARCHY", *lines(root), "MOTION", "Frames: 1", "Frame Time: 0.01"])
    return f"{head}\n{' '.join(map(str, values))}\n"


def wrapped(joints, **others):
    """Return the joints below a still root, with others next to the hips."""
    below = {name: (above or "Root", offset) for name, (above, offset) in joints.items()}
    return {"Root": ("", (0, 0, 0)), **below, **others}


@pytest.mark.parametrize("scale", [1, 10, 0.01])
def test_travel_below_a_wrapper_is_not_size(read, scale):
    """Hips 20 m from the center of the stage have a long offset to the still root."""
    joints = hierarchy(scale)
    joints["Hips"] = "", (2000 * scale, 95 * scale, 0)

    far = read(bvh_text(wrapped(joints)))

    assert stature(far) == pytest.approx(stature(read(bvh_text(hierarchy(scale)))))
    assert far.conventions.unit == pytest.approx(0.01 / scale)


@pytest.mark.parametrize("scale", [0.08, 0.25])
def test_units_of_no_program_give_an_adult_and_are_reported(read, scale, collected_messages):
    """Inches would make a dwarf or a giant, as in takes of FAIR's Animated Drawings."""
    messages, collect = collected_messages

    motion = read(bvh_text(hierarchy(scale)), progress=collect)

    assert stature(motion) == pytest.approx(1.75, rel=0.12)
    assert any("units of 0." in message for message in messages)


def test_feet_are_recognized_and_reported(read, collected_messages):
    """Read as meters, the body is 5.6 m tall."""
    messages, collect = collected_messages

    motion = read(bvh_text(hierarchy(1 / 30.48)), progress=collect)

    assert motion.conventions.unit == pytest.approx(0.3048)
    assert any("interpreted as feet, by the size" in message for message in messages)


def test_a_second_likely_unit_is_named(read, collected_messages):
    """A child of 0.8 m in centimeters, or an adult of 2.1 m in inches."""
    messages, collect = collected_messages

    motion = read(bvh_text(hierarchy(0.5)), progress=collect)

    assert motion.conventions.unit == pytest.approx(0.01)
    assert any("centimeters, by the size of the body, but may be inches" in m for m in messages)


def test_prop_far_away_is_not_size(read):
    motion = read(bvh_text(wrapped(hierarchy(1), Gun=("Root", (2000, 0, 0)))))

    assert motion.conventions.unit == pytest.approx(0.01)


def test_long_prop_in_the_hand_is_not_size(read):
    motion = read(bvh_text({**hierarchy(1), "Sword": ("RightHand", (0, 800, 0))}))

    assert motion.conventions.unit == pytest.approx(0.01)


def test_prop_far_away_from_a_real_file_is_not_size(recordings, read):
    text = (recordings / "formats" / "bvh" / "milad.bvh").read_text()
    first, hips, rest = text.partition("OFFSET")
    prop = "JOINT Gun\n{\nOFFSET 2000 0 0\nCHANNELS 0\nEnd Site\n{\nOFFSET 0 0 0\n}\n}\nJOINT"

    changed = read(first + hips + rest.replace("JOINT", prop, 1))

    assert stature(changed) == pytest.approx(stature(read(text)))


def test_a_body_in_one_plane_is_asked_about(read):
    flat = {
        name: (parent, (*offset[:2], 0.0)) for name, (parent, offset) in hierarchy(1).items()
    }

    asked = [
        " ".join(questions_of(read(bvh_text(joints)), FloorPlacement.AUTO))
        for joints in (flat, hierarchy(1))
    ]

    assert "in one plane" in asked[0]
    assert "in one plane" not in asked[1]


def test_cut_files_and_unusual_rates_are_reported(read, collected_messages):
    messages, collect = collected_messages
    head, row = bvh_text(hierarchy(1)).replace("Frames: 1", "Frames: 900").split("0.01\n")

    read(f"{head}1.0\n{row * 30}", progress=collect)

    said = " ".join(map(str, messages))
    assert "announces 900 frames but has 30" in said
    assert "states 1 frames per second" in said


@pytest.mark.parametrize(
    ("time", "rate"),
    [
        ("1/25", 25.0), ("1001/30000", 29.97), ("40 ms", 25.0), ("33 ms", 30.0),
        ("8.33ms", 120.0), ("0.04 s", 25.0), ("0.0333333 sec", 30.0), ("120 fps", 120.0),
        ("29.97Hz", 29.97), ("8333 us", 120.0), ("0,04", 25.0), ("0/25", 30.0), ("1/0", 30.0),
        ("5 parsecs", 30.0),
    ],
)  # fmt: skip
def test_a_frame_time_may_have_a_unit_or_be_a_fraction(read, time, rate):
    """30 Hz are assumed only without one."""
    head, row = bvh_text(hierarchy(1)).split("0.01\n")

    assert read(f"{head}{time}\n{row * 3}").frame_rate == pytest.approx(rate, rel=1e-4)


@pytest.mark.parametrize(
    "above", ["# made by a script\n\n", "; comment\n// other\n", "\n\n", "Take 3 of 5\r\n"]
)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_lines_above_the_hierarchy_are_comments(read_any, above, encoding):
    motion = read_any((above + bvh_text(hierarchy(1))).encode(encoding))

    assert motion.n_joints == 22


@pytest.mark.parametrize(
    ("time", "rate"),
    [
        ("30", 30.0), ("120.0", 120.0), ("33.3333", 30.0), ("8.33", 120.0),
        ("16", 60.0), ("17", 60.0), ("40", 25.0), ("15", 15.0), ("72", 72.0),
        ("66.67", 15.0), ("16.67", 60.0), ("33", 30.0), ("4", 240.0),
    ],
)  # fmt: skip
def test_a_rate_or_milliseconds_in_place_of_the_frame_time(
    read, collected_messages, time, rate
):
    """Otherwise the take plays at a thirtieth of a frame per second."""
    messages, collect = collected_messages
    head, row = bvh_text(hierarchy(1)).split("0.01\n")

    motion = read(f"{head}{time}\n{row * 30}", progress=collect)

    assert motion.frame_rate == pytest.approx(rate, rel=2e-3)
    assert any("is interpreted as" in str(message) for message in messages)
