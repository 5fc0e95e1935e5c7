"""Tables whose titles stand in several lines are the body that these name."""

import numpy as np
import pytest

from solvers.errors import InvalidFileError
from solvers.motion import (
    JointRecording,
    Tracks,
    roles_by_name,
)
from solvers.recordings import detect_format, list_bodies, read_recording

F = 40
PARTS = {"Arm": "UpperArm", "ForeArm": "LowerArm", "Hand": "Hand", "UpLeg": "UpperLeg",
         "Leg": "LowerLeg", "Foot": "Foot"}  # fmt: skip
NAMES = {"Hips": "hips", "Spine": "spine", "Neck": "neck", "Head": "head"} | {
    side.title() + part: side + role
    for side in ("left", "right")
    for part, role in PARTS.items()
}


@pytest.fixture(scope="module")
def walk(walker):
    return {role: path[:F] for role, path in walker.items()}


def repeated(label, names, n=3):
    """Return a line with a name above each of its columns."""
    return [*label, *(cell for name in names for cell in [name] * n)]


def at(index, label, names, n=3):
    """Return a line with a name above one of its columns, as merged cells are exported."""
    return [*label, *(name if k == index else "" for name in names for k in range(n))]


def table(walk, titles, n_label, separator=",", unit=100.0, rotated=False):
    """Return a table of the walker, Y up in centimeters, with rotations before positions."""
    lines = [separator.join(cells) for cells in titles]
    for frame in range(F):
        cells = [f"{frame}", f"{frame / 60:.6f}"][:n_label]
        for role in NAMES.values():
            x, y, z = unit * walk[role][frame]
            cells += ["90", "0", "0"] * rotated + [f"{x:.5f}", f"{z:.5f}", f"{-y:.5f}"]
        lines.append(separator.join(cells))
    return "\n".join(lines) + "\n"


AXES = ["x", "y", "z"] * len(NAMES)
LAYOUTS = {
    "Excel": lambda walk: table(walk, [at(0, ["", ""], NAMES), ["Frame", "Time", *AXES]], 2),
    "Excel, merged cells centered": lambda walk: table(
        walk, [at(1, ["Frame", "Time"], NAMES), ["", "", *AXES]], 2, separator="\t"
    ),
    "DeepLabCut": lambda walk: table(
        walk,
        [repeated(["scorer"], ["DLC_3D"] * len(NAMES)), repeated(["bodyparts"], NAMES),
         ["coords", *AXES]],
        1,
    ),
    "Nexus, without the section": lambda walk: table(
        walk,
        [at(0, ["", ""], [f"Anna:{name}" for name in NAMES]),
         ["Frame", "Sub Frame", *(axis.upper() for axis in AXES)],
         ["", "", *["mm"] * len(AXES)]],
        2, unit=1000.0,
    ),
    "Motive, without the first line": lambda walk: table(
        walk,
        [
            repeated(["", "Type"], ["Bone"] * len(NAMES), 6),
            repeated(["", "Name"], NAMES, 6),
            repeated(["", "ID"], [f"{37 * k:X}A" for k in range(len(NAMES))], 6),
            ["", "", *(["Rotation"] * 3 + ["Position"] * 3) * len(NAMES)],
            ["Frame", "Time (Seconds)", *["X", "Y", "Z"] * 2 * len(NAMES)],
        ],
        2, rotated=True,
    ),
    "numbered axes": lambda walk: table(
        walk,
        [at(0, ["Frame#", "Time"], NAMES),
         ["", "", *(f"{axis}{k}" for k in range(len(NAMES)) for axis in "XYZ")]],
        2, separator="\t",
    ),
    "long names, beyond the first bytes of the file": lambda walk: table(
        walk,
        [repeated(["frame"], [f"{'deep/' * 20}:{name}" for name in NAMES]), ["", *AXES]], 1,
    ),
}  # fmt: skip


def read(path, content):
    path.write_text(content)
    said = []
    return read_recording(path, progress=lambda _, text="": said.append(str(text))), said


def check(recording, walk):
    """Check that limbs are where they were, relative to the hips."""
    assert isinstance(recording, JointRecording)
    joints = {
        role: recording.tracks.positions[:, recording.names.index(name)]
        for role, name in roles_by_name(recording.names).items()
    }
    for role in ("leftHand", "rightLowerLeg", "leftFoot", "head"):
        expected = walk[role] - walk["rightUpperLeg"]
        assert np.allclose(joints[role] - joints["rightUpperLeg"], expected, atol=1e-4), role


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_name_above_its_axes_names_the_joint(tmp_path, walk, layout):
    recording, said = read(tmp_path / "take.csv", LAYOUTS[layout](walk))

    check(recording, walk)
    has_times = "Time" in (tmp_path / "take.csv").read_text()
    assert recording.tracks.frame_rate == pytest.approx(60.0 if has_times else 30.0, rel=1e-3)
    assert has_times or any("30 Hz is assumed" in text for text in said)


def test_several_people_are_read_one_by_one(tmp_path, walk):
    """A line above the names has the people, as DeepLabCut's `individuals`."""
    lines = LAYOUTS["DeepLabCut"](walk).splitlines()
    twice = [line + "," + line.split(",", 1)[1] for line in lines]
    people = ["individuals", *["anna"] * len(AXES), *["ben"] * len(AXES)]
    path = tmp_path / "take.csv"
    path.write_text("\n".join([twice[0], ",".join(people), *twice[1:]]) + "\n")

    assert [body.name for body in list_bodies(path)] == ["anna", "ben"]
    check(read_recording(path, body="ben"), walk)


def test_people_in_the_titles_are_not_mixed(tmp_path, walk):
    """The arm of one person is never on the body of another."""
    titles = [f"{who}:{name}_{axis}" for who in ("A", "B") for name in NAMES for axis in "xyz"]
    far = np.array([3.0, 0.0, 0.0])
    rows = [
        [value for shift in (0 * far, far) for role in NAMES.values()
         for value in walk[role][frame] + shift]
        for frame in range(F)
    ]  # fmt: skip
    text = "\n".join([",".join(titles), *(",".join(f"{v:.5f}" for v in row) for row in rows)])
    path = tmp_path / "take.csv"
    path.write_text(text + "\n")

    assert [body.name for body in list_bodies(path)] == ["A", "B"]
    check(read_recording(path, body="B"), walk)


def test_a_blank_title_of_the_index_is_a_column(tmp_path, walk):
    """Tables of pandas begin with a tab; without it, each x would be the number of its line."""
    titles = ["", *(f"{name}_{axis}" for name in NAMES for axis in "xyz")]

    recording, _ = read(tmp_path / "a.tsv", table(walk, [titles], 1, separator="\t"))

    check(recording, walk)


def test_images_of_deeplabcut_are_refused(tmp_path, walk):
    with pytest.raises(InvalidFileError, match="2D keypoints"):
        read(
            tmp_path / "take.csv",
            LAYOUTS["DeepLabCut"](walk).replace("x,y,z", "x,y,likelihood"),
        )


def test_other_names_above_the_axes_are_markers(tmp_path, walk):
    content = LAYOUTS["Excel"](walk)
    for number, name in enumerate(sorted(NAMES, key=len, reverse=True)):
        content = content.replace(name, f"M{number:02d}a")

    recording, _ = read(tmp_path / "take.csv", content)

    assert isinstance(recording, Tracks)
    assert len(recording.names) == len(NAMES)


def titles_of(people):
    """Return the titles of people with these joints."""
    titles = [(who, name, axis) for who, names in people for name in names for axis in "xyz"]
    return ",".join(f"{who}:{name}_{axis}" for who, name, axis in titles)


def test_titles_of_people_without_frames_are_refused(tmp_path):
    content = titles_of([("Anna", NAMES), ("Ben", NAMES)]) + "\n\n"

    with pytest.raises(InvalidFileError, match="no points that are observed in any frame"):
        read(tmp_path / "take.csv", content)


def test_names_of_who_is_no_complete_body_are_reported(tmp_path, walk):
    people = [("A", NAMES), ("B", NAMES), ("Carl", [*NAMES][:-1]), ("Box", ["P1", "P2"])]
    rows = [
        ",".join(f"{value:.5f}" for _, names in people for name in names
                 for value in walk[NAMES.get(name, "hips")][frame])
        for frame in range(F)
    ]  # fmt: skip

    recording, said = read(tmp_path / "take.csv", "\n".join([titles_of(people), *rows]) + "\n")

    check(recording, walk)
    assert any("no complete bodies: Carl, Box." in text for text in said)


def test_long_titles_below_other_lines_are_recognized(tmp_path):
    names = [f"marker{number:03d}" for number in range(300)]
    above = [f"# line {number}" for number in range(4)]
    axes = ",".join(["x", "y", "z"] * len(names))
    frame = ",".join(["1.0"] * 3 * len(names))
    path = tmp_path / "take.csv"
    path.write_text("\n".join([*above, ",".join(repeated([], names)), axes, frame]) + "\n")

    found = detect_format(path)

    assert found is not None and found.name == "table of points"
