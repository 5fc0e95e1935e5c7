"""`python -m solvers` does to files what the verbs do to recordings."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.command_line.run import run
from solvers.command_line.verbs import VERBS
from solvers.denoising import learn_joint_limits, limit_excess
from solvers.motion import Tracks
from solvers.motion.rotations import multiply, quaternion_from_rotation_vector
from solvers.recordings import read_bvh, read_c3d, write_bvh, write_c3d
from solvers.samples import GaitSettings, walking_gait

ROOT = Path(__file__).parents[3]


@pytest.fixture
def call(capsys):
    """Run a command line in this process; returns exit status, stdout, stderr."""

    def command(*words) -> tuple[int, str, str]:
        try:
            status = run(VERBS, [str(word) for word in words], "solvers")
        except SystemExit as stopped:
            status = stopped.code
        captured = capsys.readouterr()
        return status, captured.out, captured.err

    return command


@pytest.fixture
def leg_file(swinging_leg, tmp_path) -> Path:
    write_bvh(swinging_leg, tmp_path / "leg.bvh")
    return tmp_path / "leg.bvh"


def test_convert_writes_the_same_motion(call, leg_file, tmp_path):
    status, said, _ = call("convert", leg_file, tmp_path / "copy.bvh")

    assert (status, said) == (0, "120 frames at 60 Hz, 4 joints.\n")
    assert (tmp_path / "copy.bvh").read_bytes() == leg_file.read_bytes()


def test_convert_takes_points_too(call, tmp_path, rng):
    tracks = Tracks(("a", "b"), rng.normal(size=(9, 2, 3)), 50.0)
    write_c3d(tracks, tmp_path / "points.c3d")

    status, _, _ = call("convert", tmp_path / "points.c3d", tmp_path / "copy.c3d", "--scale", 1)

    assert status == 0
    copied = read_c3d(tmp_path / "copy.c3d").positions
    assert_allclose(copied, 1000 * tracks.positions, rtol=1e-6)


def test_quality_prints_the_report_or_its_figures(call, leg_file):
    _, text, _ = call("quality", leg_file)
    _, figures, _ = call("quality", leg_file, "--json")

    assert text.startswith("120 frames at 60 Hz")
    parsed = json.loads(figures)
    assert parsed["input"] == str(leg_file)
    assert parsed["n_frames"] == 120


def test_denoise_writes_a_cleaner_take(call, swinging_leg, tmp_path, rng):
    turns = swinging_leg.rotations + rng.normal(scale=0.02, size=swinging_leg.rotations.shape)
    turns[:, -1] = swinging_leg.rotations[:, -1]
    turns /= np.linalg.norm(turns, axis=-1, keepdims=True)
    write_bvh(swinging_leg.with_poses(turns), tmp_path / "noisy.bvh")

    status, said, _ = call("denoise", tmp_path / "noisy.bvh", tmp_path / "clean.bvh", "--json")

    assert status == 0
    figures = json.loads(said)
    assert figures["output"] == str(tmp_path / "clean.bvh")
    assert figures["after"]["n_frames"] == 120
    clean = read_bvh(tmp_path / "clean.bvh")
    errors = [
        np.abs(each - swinging_leg.rotations)[:, :3].mean() for each in (turns, clean.rotations)
    ]
    assert errors[1] < 0.7 * errors[0]


def test_denoise_learns_from_clips(call, leg_file, tmp_path):
    status, said, _ = call("denoise", leg_file, tmp_path / "clean.bvh", "--train", leg_file)

    assert status == 0
    assert "1 example clip" in said


def test_denoise_holds_joints_to_the_angles_of_the_clips(call, swinging_leg, tmp_path):
    """A knee that is held bent by 60 degrees more is no noise: only limits bring it back."""
    good, bent = tmp_path / "good.bvh", tmp_path / "bent.bvh"
    write_bvh(swinging_leg, good)
    rotations = swinging_leg.rotations.copy()
    more = quaternion_from_rotation_vector([np.radians(60.0), 0.0, 0.0])
    rotations[:, 1] = multiply(rotations[:, 1], more)
    write_bvh(swinging_leg.with_poses(rotations), bent)
    limits = learn_joint_limits([read_bvh(good)])
    excess = {}

    for option in ("--joint-limits", "--no-feet"):
        status, _, _ = call("denoise", bent, tmp_path / "clean.bvh", "--train", good, option)
        assert status == 0
        excess[option] = limit_excess(read_bvh(tmp_path / "clean.bvh"), limits).max()

    assert excess["--joint-limits"] < np.radians(5.1) < np.radians(15.0) < excess["--no-feet"]
    status, _, complaint = call("denoise", bent, tmp_path / "clean.bvh", "--joint-limits")
    assert (status, "name some with --train" in complaint) == (2, True)


def test_denoise_plants_the_feet_if_there_are_any(call, leg_file, tmp_path):
    """The sample has some; a single leg has none that it knows."""
    walk = walking_gait(GaitSettings(duration=1.5, frame_rate=30.0))
    write_bvh(walk, tmp_path / "walk.bvh")

    _, said, _ = call("denoise", tmp_path / "walk.bvh", tmp_path / "clean.bvh", "--json")
    figures = json.loads(said)
    assert figures["slide_after_m"] < figures["slide_before_m"]
    steps = [figures[when]["feet"]["left"]["contact_share"] for when in ("before", "after")]
    assert steps[0] == steps[1] > 0.0, "else the slide is not that of the same steps"
    _, said, _ = call("denoise", leg_file, tmp_path / "leg-clean.bvh")
    assert "Feet are left as they are. No leg was found" in said
    _, said, _ = call("denoise", leg_file, tmp_path / "leg-clean.bvh", "--no-feet")
    assert "Feet" not in said
    status, _, complaint = call("denoise", leg_file, tmp_path / "leg-clean.bvh", "--feet")
    assert status == 2
    assert "leg.bvh: No leg was found" in complaint


def test_many_files_go_to_a_folder_and_a_second_run_goes_on(call, leg_file, tmp_path):
    twin = tmp_path / "twin.bvh"
    twin.write_bytes(leg_file.read_bytes())
    folder = tmp_path / "out"
    words = ["convert", leg_file, twin, "--output-folder", folder]
    assert call(*words)[0] == 0
    first = (folder / "leg.bvh").stat().st_mtime_ns
    (folder / "twin.bvh").unlink()

    _, said, _ = call(*words)

    assert said.count("Already made.") == 1
    assert (folder / "leg.bvh").stat().st_mtime_ns == first
    assert (folder / "twin.bvh").exists()


@pytest.mark.parametrize("change", ["options", "source", "again"])
def test_what_would_come_out_otherwise_is_made_again(call, leg_file, tmp_path, change):
    words = ["convert", leg_file, "--output-folder", tmp_path / "out"]
    call(*words)
    if change == "options":
        words += ["--scale", 0.5]
    if change == "source":
        leg_file.write_bytes(leg_file.read_bytes() + b"\n")
    if change == "again":
        words += ["--again"]

    _, said, _ = call(*words)

    assert "Already made." not in said


def test_one_bad_file_does_not_stop_the_others(call, leg_file, tmp_path):
    bad = tmp_path / "bad.bvh"
    bad.write_text("HIERARCHY\nMOTION\n")
    folder = tmp_path / "out"

    status, said, complaint = call(
        "convert", bad, leg_file, tmp_path / "gone.bvh", "--output-folder", folder, "--json"
    )

    assert status == 2
    assert sorted(path.name for path in folder.iterdir()) == ["leg.bvh", "mocap_assist.json"]
    lines = [json.loads(line) for line in said.splitlines()]
    assert [("error" in line) for line in lines] == [True, False, True]
    assert complaint.count("\n") == 2
    assert "There is no file" in complaint


def test_several_at_a_time_give_the_same_files(leg_file, tmp_path):
    twin = tmp_path / "twin.bvh"
    twin.write_bytes(leg_file.read_bytes())
    command = [sys.executable, "-m", "solvers", "convert", leg_file, twin, "--jobs", "2"]

    done = subprocess.run(
        [*command, "--output-folder", tmp_path / "out"], cwd=ROOT, timeout=120,
        capture_output=True, text=True, env=os.environ | {"PYTHONWARNINGS": "error"},
    )  # fmt: skip

    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.count("120 frames at 60 Hz, 4 joints.") == 2
    for name in ("leg.bvh", "twin.bvh"):
        assert (tmp_path / "out" / name).read_bytes() == leg_file.read_bytes()


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["convert", "IN"], "1 files are named: name one to read and one to write"),
        (["convert", "IN", "IN"], "would be written over. Recordings are never changed"),
        (["convert", "IN", "out.fbx"], "out.fbx cannot be written; end the name in .bvh"),
        (["convert", "IN", "no/out.bvh"], "there is no folder no"),
        (["convert", "IN", "out.c3d"], "A skeleton's motion cannot be written as out.c3d"),
        (["convert", "IN", "IN", "--output-folder", "o"], "would both be written to"),
        (["convert", "IN", "out.bvh", "--scale", "-1"], "scale is -1; it must be above 0."),
        (["convert", "IN", "out.bvh", "--jobs", "0"], "jobs is 0; it must be at least 1."),
        (["denoise", "IN", "out.bvh", "--strength", "7"], "must lie between 0 and 1"),
        (["denoise", "IN", "out.bvh", "--train", "gone.bvh"], "There is no file gone.bvh."),
        (["sharpen", "IN"], "Argument VERB: invalid choice: 'sharpen'"),
        ([], "The following arguments are required: VERB"),
    ],
)
def test_a_mistake_is_one_sentence_and_status_2(
    call, leg_file, tmp_path, monkeypatch, words, sentence
):
    monkeypatch.chdir(tmp_path)

    status, said, complaint = call(*(leg_file if word == "IN" else word for word in words))

    assert status == 2
    assert said == ""
    assert sentence in complaint
    assert complaint.count("\n") == 1
    assert not (tmp_path / "out.bvh").exists()
