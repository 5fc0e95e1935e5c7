"""Subjects of marker files, MVNX and SMPL parameters: people, and props that are none."""

import re

import numpy as np
import pytest
from exports.studio_tables import motive, motive_points, qualisys_markers, vicon
from numpy.testing import assert_allclose

from solvers.motion import Tracks
from solvers.recordings import (
    list_bodies,
    open_bodies,
    read_recording,
    write_c3d,
    write_trc,
)


def person(rng, n_markers=20):
    """Markers that move relative to each other, meters, (n_frames, n_markers, 3)."""
    still = rng.uniform(0.1, 1.8, (1, n_markers, 3))
    return still + rng.normal(0.0, 0.06, (60, n_markers, 3))


def box(rng, n_markers=14):
    travel = np.linspace(0.1, 0.9, 60)[:, None, None]
    return rng.uniform(0.1, 0.4, (n_markers, 3)) + travel


def named(prefix, n):
    return [f"{prefix}:M{number}" for number in range(n)]


def test_subjects_of_c3d_are_bodies_and_a_box_is_a_prop(tmp_path, rng):
    points = np.concatenate([person(rng), box(rng), person(rng), person(rng, 2)], axis=1)
    labels = [*named("Anna", 20), *named("box", 14), *named("Ben", 20), "stick1", "stick2"]
    path = tmp_path / "take.c3d"
    write_c3d(Tracks(tuple(labels), points, 100.0), path)

    bodies = open_bodies(path)

    assert [(body.name, body.is_person) for body in bodies.listed] == [
        ("Anna", True), ("box", False), ("Ben", True), ("unlabeled", False)
    ]  # fmt: skip
    assert read_recording(path, body="ben").names == tuple(f"M{n}" for n in range(20))
    assert read_recording(path, body="box").n_points == 14
    assert bodies.choose("all") == [0, 1, 2, 3]
    assert read_recording(path).n_points == 20


def test_sides_after_the_letter_of_an_actor_are_no_people(tmp_path, rng):
    """L is the actor in LL_IAS and LR_IAS, as Qualisys writes them."""
    points = np.concatenate([person(rng), person(rng), person(rng, 2)], axis=1)
    labels = [f"L{side}_M{n}" for side in "LR" for n in "ABCDEFGHIJKLMNOPQRST"]
    write_c3d(Tracks((*labels, "LCV7", "LTV10"), points, 100.0), tmp_path / "take.c3d")

    assert not list_bodies(tmp_path / "take.c3d")
    assert read_recording(tmp_path / "take.c3d").n_points == 42


@pytest.mark.parametrize("program", ["trc", "vicon", "motive", "qualisys"])
def test_subjects_of_every_marker_format_are_bodies(make_writer, program, rng):
    points = np.concatenate([person(rng), box(rng), person(rng)], axis=1)
    labels = [*named("Anna", 20), *named("box", 14), *named("Ben", 20)]
    path = make_writer("take.dat")("")
    if program == "trc":
        write_trc(Tracks(tuple(labels), points, 100.0), path)
    elif program == "vicon":
        path.write_text(vicon(labels, 1000.0 * points))
    elif program == "motive":
        path.write_text(motive(motive_points("Marker", labels, points[..., [0, 2, 1]])))
    else:
        path.write_text(qualisys_markers(labels, 1000.0 * points))

    bodies = open_bodies(path)

    assert [(body.name, body.is_person) for body in bodies.listed] == [
        ("Anna", True), ("box", False), ("Ben", True)
    ]  # fmt: skip
    ben = read_recording(path, body="Ben")
    assert ben.names == tuple(f"M{number}" for number in range(20))
    assert ben.conventions == read_recording(path, body="Anna").conventions
    assert ben.conventions is not None
    if program == "trc":  # which states its up axis
        assert_allclose(ben.positions, points[:, -20:], atol=1e-5)


def test_one_person_with_a_box_is_one_recording(recordings):
    path = recordings / "corpus" / "lab" / "c3d_vicon" / "Vicon.c3d"

    bodies = open_bodies(path)

    assert [(body.name, body.is_person) for body in bodies.listed] == [
        ("boite", False), ("Daphnee", True)
    ]  # fmt: skip
    assert list_bodies(path) == ()
    assert read_recording(path).n_points == 51
    daphnee = read_recording(path, body="Daphnee")
    assert daphnee.n_points == 43
    assert not any(":" in name for name in daphnee.names)


def test_clusters_of_one_person_are_no_people(recordings):
    """Each segment of a wheelchair athlete is a subject of the file."""
    path = recordings / "formats" / "c3d" / "sprintbasket.c3d"

    assert list_bodies(path) == ()
    assert read_recording(path).n_points == 26


def test_subjects_of_mvnx(tmp_path, recordings):
    text = (recordings / "corpus/lab/xsens_mvnx/test_mocap.mvnx").read_text("utf-8")
    start, stop = text.index("<subject"), text.index("</subject>") + len("</subject>")
    first = text[start:stop]
    label = re.search(r'label="([^"]*)"', first)[1]
    second = first.replace(f'label="{label}"', 'label="Ben"', 1)
    (tmp_path / "two.mvnx").write_text(text[:stop] + second + text[stop:], "utf-8")

    listed = list_bodies(tmp_path / "two.mvnx")

    assert [body.name for body in listed] == [label, "Ben"]
    assert listed[0].n_frames == 112
    ben = read_recording(tmp_path / "two.mvnx", body="Ben")
    one = read_recording(recordings / "corpus/lab/xsens_mvnx/test_mocap.mvnx")
    assert_allclose(ben.root_positions, one.root_positions)


@pytest.mark.parametrize("people_first", [True, False])
def test_people_of_smpl_parameters(tmp_path, people_first, rng):
    poses = rng.normal(0.0, 0.05, (2, 40, 72))
    poses[1, :10] = np.nan
    trans = np.cumsum(rng.normal(0.0, 0.01, (2, 40, 3)), axis=1)
    if not people_first:
        poses, trans = np.swapaxes(poses, 0, 1), np.swapaxes(trans, 0, 1)
    path = tmp_path / "two.npz"
    np.savez(path, poses=poses, trans=trans, betas=np.zeros((2, 10)), fps=30.0)

    one, two = list_bodies(path)

    assert (one.n_frames, two.n_frames, two.first) == (40, 30, 10)
    assert two.duration_s == 1.0
    second = read_recording(path, body="2")
    assert not second.observed[:10].any() and second.observed[10:].all()
    alone = tmp_path / "alone.npz"
    axis = 0 if people_first else 1
    np.savez(alone, poses=poses.take(1, axis), trans=trans.take(1, axis), fps=30.0)
    assert_allclose(second.rotations, read_recording(alone).rotations)


def test_body_parts_of_several_people(tmp_path, rng):
    np.savez(
        tmp_path / "two.npz",
        global_orient=rng.normal(0, 0.1, (2, 30, 3)),
        body_pose=rng.normal(0, 0.1, (2, 30, 21, 3)),
        transl=np.zeros((2, 30, 3)),
    )

    assert len(list_bodies(tmp_path / "two.npz")) == 2
    assert read_recording(tmp_path / "two.npz", body="2").n_frames == 30


def test_people_with_the_same_markers_may_be_separated_by_an_underscore(tmp_path, rng):
    """As Qualisys writes them; sides before an underscore are no people."""
    labels = [f"{who}_{side}M{n}" for who in ("Anna", "Ben") for side in "LR" for n in range(8)]
    points = np.concatenate([person(rng, 32), person(rng, 1)], axis=1)
    path = tmp_path / "take.c3d"
    write_c3d(Tracks((*labels, "Stick_1"), points, 100.0), path)
    sides = tmp_path / "sides.c3d"
    names = [f"{side}_M{n}" for side in ("left", "right") for n in range(16)]
    write_c3d(Tracks(tuple(names), points[:, :32], 100.0), sides)

    assert [body.name for body in list_bodies(path)] == ["Anna", "Ben", "Stick"]
    assert read_recording(path, body="Ben").names[:2] == ("LM0", "LM1")
    assert list_bodies(sides) == ()
