"""Tables are read however a program or an office writes cells, titles, times and comments."""

import time

import numpy as np
import pytest

from solvers.errors import InvalidFileError
from solvers.motion import JointRecording, Tracks
from solvers.recordings.joint_files.table_titles import table_titles
from solvers.recordings.point_bodies import coordinate_of_title

F, RATE_HZ = 60, 25.0
ROLES = [side + part for side in ("left", "right") for part in (
    "UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot")]  # fmt: skip
NAMES = [f"{part}_{side}" for side in "lr" for part in (
    "upperarm", "lowerarm", "hand", "thigh", "calf", "foot")]  # fmt: skip
LANGUAGES = {
    "German": "Schulter{} Ellenbogen{} Handgelenk{} Hüfte{} Knie{} Fußgelenk{}/Links/Rechts",
    "French": "épaule_{} coude_{} poignet_{} hanche_{} genou_{} cheville_{}/gauche/droite",
    "Spanish": "hombro_{} codo_{} muñeca_{} cadera_{} rodilla_{} tobillo_{}/izquierda/derecha",
    "Japanese": "{}肩 {}肘 {}手首 {}股関節 {}膝 {}足首/左/右",
    "Chinese": "{}肩 {}肘 {}手腕 {}髋 {}膝 {}脚踝/左/右",
}


def in_language(language):
    words, *sides = LANGUAGES[language].split("/")
    return [word.format(side) for side in sides for word in words.split()]


@pytest.fixture(scope="module")
def walk(walker):
    """Positions of joints, shape (F, 12, 3), meters, Z up."""
    return np.stack([walker[role][:F] for role in ROLES], axis=1)


def table(walk, title="{name}_{axis}", axes="xyz", names=NAMES, time="time", separator=","):
    """Return a table with a column for each coordinate."""
    titles = [title.format(name=name, axis=axis) for name in names for axis in axes]
    rows = [[f"{k / RATE_HZ:.4f}", *(f"{value:.5f}" for value in frame.flat)]
            for k, frame in enumerate(walk)]  # fmt: skip
    return "\n".join(separator.join(row) for row in ([time, *titles], *rows)) + "\n"


def assert_is(recording, walk):
    """Compare distances between joints, which no axes change, and the rate."""
    assert isinstance(recording, JointRecording)
    assert recording.frame_rate == RATE_HZ
    ends = [f"{side}_{part}" for side in ("left", "right") for part in (
        "shoulder", "elbow", "wrist", "hip", "knee", "ankle")]  # fmt: skip
    found = recording.tracks.positions[:, [recording.names.index(name) for name in ends]]
    assert len(found) == F
    distances = [
        np.linalg.norm(each[:, :, None] - each[:, None], axis=-1) for each in (found, walk)
    ]
    assert np.allclose(*distances, atol=1e-4)


@pytest.mark.parametrize(("title", "axes"), [
    ("{axis}_{name}", "xyz"), ("pos_{axis}_{name}", "xyz"), ("{axis} {name}", "XYZ"),
    ("{name}[{axis}]", "012"), ("{name}_{axis}", "012"), ("{name}_{axis}", "123"),
    ("{name} ({axis})", "xyz"), ("{name}_{axis}_m", "xyz"), ("{name}|{axis}", "xyz"),
    ("{name}_{axis}_world", "xyz"),
])  # fmt: skip
def test_titles_name_the_axis_in_any_place(read_any, walk, title, axes):
    assert_is(read_any(table(walk, title, axes)), walk)


def test_the_right_side_is_no_rotation(read_any, walk):
    """`hand_r` is not the rotation of a hand: otherwise half the body is lost."""
    assert_is(read_any(table(walk)), walk)
    turned = table(np.concatenate([walk, walk[:, :1]], axis=1), names=[*NAMES, "upperarm_l_r"])
    assert_is(read_any(turned), walk)


@pytest.mark.parametrize("side", ["l", "r", "L", "R"])
def test_one_side_of_a_body_comes_in_as_markers(read_any, walk, collected_messages, side):
    """Points of the right side only are not rotations."""
    parts = ("clavicle", "upperarm", "lowerarm", "hand", "thigh", "calf", "foot", "ball")
    names = [f"{part}_{side}" for part in parts]

    said, progress = collected_messages
    recording = read_any(table(walk[:, : len(names)], names=names), progress=progress)

    assert isinstance(recording, Tracks)
    assert recording.names == tuple(names)
    other = "left" if side in "rR" else "right"
    assert any(f"The points lack {other}_ankle" in str(each) for each in said)


def test_rotations_of_a_body_are_not_its_right_side(read_any, walk):
    with pytest.raises(InvalidFileError):
        read_any(table(walk, names=[f"{name}_r" for name in NAMES]))


@pytest.mark.parametrize("language", LANGUAGES)
def test_joints_may_have_names_of_other_languages(read_any, walk, language):
    assert_is(read_any(table(walk, names=in_language(language))), walk)


@pytest.mark.parametrize(("language", "encoding"), [
    ("Japanese", "shift_jis"), ("Chinese", "gbk"), ("German", "latin-1"), ("German", "utf-16"),
    ("Japanese", "utf-8-sig"),
])  # fmt: skip
def test_text_may_have_the_encoding_of_its_country(read_any, walk, language, encoding):
    assert_is(read_any(table(walk, names=in_language(language)).encode(encoding)), walk)


@pytest.mark.parametrize("comment", [
    "# recorded by a studio, 2026\n", "// a\n// b\n", "; a\n",
    "Motion export v1.2\nActor,Anna\n\n",
    "sep=,\n", '"Exported, on Monday"\n',
])  # fmt: skip
def test_comments_may_stand_above_the_titles(read_any, walk, comment):
    assert_is(read_any(comment + table(walk)), walk)


def test_a_comment_may_state_the_rate(read_any, walk):
    text = table(walk, time="number")

    assert_is(read_any("# frame rate: 25 Hz\n" + text), walk)


@pytest.mark.parametrize("comment", [
    "# cutoff 6 Hz, fps: 25\n", "# Frame Rate=25,0\n", "Frame Rate,25,Frames,60\n",
    "# 25 fps\n", "# fps=25, frame rate 25.0\n",
])  # fmt: skip
def test_only_a_rate_of_frames_is_the_rate(read_any, walk, comment):
    assert_is(read_any(comment + table(walk, time="number")), walk)


@pytest.mark.parametrize("comment", ["# cutoff 6 Hz\n", "# video 25 fps, frame rate: 100\n"])
def test_without_a_clear_rate_it_is_assumed(read_any, walk, comment):
    assert read_any(comment + table(walk, time="number")).frame_rate == 30.0


@pytest.mark.parametrize("cell", [
    '"(X={:.5f},Y={:.5f},Z={:.5f})"', "(X={:.5f} Y={:.5f} Z={:.5f})",
    '"[{:.5f}, {:.5f}, {:.5f}]"', "[{:.5f}  {:.5f} {:.5f}]",
])  # fmt: skip
def test_a_cell_may_hold_all_three_coordinates(read_any, walk, cell):
    """So do tables of Unreal Engine, and of NumPy's arrays in pandas."""
    rows = [",".join([f"{k / RATE_HZ}", *(cell.format(*place) for place in frame)])
            for k, frame in enumerate(walk)]  # fmt: skip
    rows[5] = f"{5 / RATE_HZ}" + "," * 12

    recording = read_any("\n".join([",".join(["time", *NAMES]), *rows]))

    gap = np.isnan(recording.tracks.positions).any(axis=(1, 2))
    assert np.flatnonzero(gap).tolist() == [5]
    assert recording.frame_rate == RATE_HZ


def table_of_vectors(walk, spoil):
    rows = [[f"{k / RATE_HZ}", *("({:.5f} {:.5f} {:.5f})".format(*place) for place in frame)]
            for k, frame in enumerate(walk)]  # fmt: skip
    spoil(rows)
    return "\n".join(",".join(row) for row in [["time", *NAMES], *rows])


def test_joints_may_be_missing_in_the_first_frames(read_any, walk):
    def spoil(rows):
        for row in rows[:20]:
            row[3] = ""

    recording = read_any(table_of_vectors(walk, spoil))

    missing = np.isnan(recording.tracks.positions).any(axis=2)
    assert missing.sum() == 20
    assert missing[:20].any(axis=1).all()


@pytest.mark.parametrize("cell", ["(1.0 2.0)", "0.5", "lost"])
def test_a_cell_that_is_no_vector_is_refused(read_any, walk, cell):
    def spoil(rows):
        rows[7][3] = cell

    with pytest.raises(InvalidFileError, match=r"line 9: .* is not a number"):
        read_any(table_of_vectors(walk, spoil))


@pytest.mark.parametrize("n_empty", [150, 2500])
@pytest.mark.parametrize("late", [slice(0, 12), slice(0, 1)])
def test_vectors_may_be_missing_in_many_frames_first(read_any, walk, n_empty, late):
    """A joint that comes after 100 frames is not left out."""
    missing = np.zeros(len(NAMES), dtype=bool)
    missing[late] = True
    vector = "[{:.4f} {:.4f} {:.4f}]"
    rows = [
        ["" if missing[at] and k < n_empty else vector.format(*walk[k % F, at])
         for at in range(len(NAMES))]
        for k in range(n_empty + F)
    ]  # fmt: skip
    lines = [",".join([f"{k / RATE_HZ:.3f}", *row]) for k, row in enumerate(rows)]

    recording = read_any("\n".join([",".join(["time", *NAMES]), *lines]) + "\n")

    assert isinstance(recording, JointRecording)
    assert np.isfinite(recording.tracks.positions[n_empty + 1 :]).all()


def test_long_digits_are_no_vector():
    """A search that tries each split of the digits would not end."""
    digits = b"1" * 100_000
    lines = [b",".join([digits, *(name.encode() for name in NAMES)])] * 3

    assert table_titles(lines, lambda titles: not titles) is None


@pytest.mark.parametrize("separator", [" ", "   ", "|", "\t", ";"])
def test_cells_may_be_separated_by_other_signs(read_any, walk, separator):
    assert_is(read_any(table(walk, separator=separator)), walk)


@pytest.mark.parametrize(("title", "time"), [
    ("Time(ms)", lambda s: f"{1e3 * s:.0f}"), ("timestamp_us", lambda s: f"{1e6 * s:.0f}"),
    ("Zeit [s]", str), ("Time Stamp", str),
    ("timestamp", lambda s: f"2026-03-01T10:59:{s:09.6f}"),
    ("unix_time", lambda s: f"{1.7e9 + s:.3f}"), ("time", lambda s: f"10:59:{s:06.3f}"),
])  # fmt: skip
def test_times_may_have_any_title_and_clock(read_any, walk, title, time):
    lines = table(walk, time=title).splitlines()
    rows = [time(k / RATE_HZ) + line[line.index(",") :] for k, line in enumerate(lines[1:])]

    assert_is(read_any("\n".join([lines[0], *rows])), walk)


def test_lines_after_the_last_time_are_no_frames(read_any, walk):
    assert_is(read_any(table(walk) + "mean" + ",0.5" * 36 + "\nEND\n"), walk)


@pytest.mark.parametrize("titles", [
    "frame,joint,x (m),y (m),z (m)", "# made by a tool\nframe,joint,x,y,z",
    "Frame,Gelenk,X,Y,Z",
])  # fmt: skip
def test_lines_of_joints_may_have_units_and_comments(read_any, walk, titles):
    lines = [f"{k},{name}," + ",".join(map(str, walk[k, at]))
             for k in range(F) for at, name in enumerate(NAMES)]  # fmt: skip

    recording = read_any("\n".join([titles, *lines]))

    assert recording.tracks.n_frames == F and "left_wrist" in recording.names


@pytest.mark.parametrize("axes", [
    lambda p: (p[..., 0], p[..., 1], p[..., 2]), lambda p: (p[..., 0], p[..., 2], -p[..., 1]),
], ids=["z up", "y up"])  # fmt: skip
@pytest.mark.parametrize("lies", [True, False])
def test_an_actor_who_lies_all_the_time_is_no_clear_case(
    read_any, collected_messages, walk, axes, lies
):
    """An actor on the back, head along an axis of the file, is not stood upright."""
    messages, progress = collected_messages
    body = walk
    if lies:
        x, y, z = np.moveaxis(walk, -1, 0)
        body = np.stack([x, z + 2.0, -y], axis=-1)
        body[..., 2] += 0.05 - body[..., 2].min(axis=1, keepdims=True)
    head = body[:, [0, 6]].mean(axis=1) * 1.3 - body[:, [3, 9]].mean(axis=1) * 0.3
    points = np.concatenate([body, head[:, None]], axis=1)

    read_any(table(np.stack(axes(points), axis=-1), names=[*NAMES, "head"]), progress=progress)

    assert any("is interpreted as up" in message for message in messages) == lies


def test_a_title_without_an_end_is_detected_in_a_moment():
    """A search that is not bounded takes minutes."""
    start = time.process_time()

    assert coordinate_of_title("_" * 60_000) is None

    assert time.process_time() - start < 1.0
