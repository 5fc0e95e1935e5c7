"""`python -m solvers` does to files what the verbs do to recordings."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.command_line.verbs import VERBS
from solvers.denoising import learn_joint_limits, limit_excess, load_filter_bases
from solvers.motion import Tracks
from solvers.recordings import read_bvh, read_c3d, read_trc, write_bvh, write_c3d, write_trc
from solvers.rotations.representations import multiply, quaternion_from_rotation_vector
from solvers.samples import CorruptionSettings, GaitSettings, corrupt, walking_gait

AXES = "Y is up, Z is forward, lengths are in centimeters"


def test_convert_writes_the_same_motion(call, leg_file, tmp_path):
    status, printed, _ = call("convert", leg_file, tmp_path / "copy.bvh")

    assert (status, printed) == (0, f"120 frames at 60 Hz, 4 joints; {AXES}.\n")
    assert (tmp_path / "copy.bvh").read_bytes() == leg_file.read_bytes()


def test_convert_accepts_points(call, tmp_path, rng):
    tracks = Tracks(("a", "b"), rng.normal(size=(9, 2, 3)), 50.0)
    write_c3d(tracks, tmp_path / "points.c3d")

    status, _, _ = call("convert", tmp_path / "points.c3d", tmp_path / "copy.c3d", "--scale", 1)

    assert status == 0
    copied = read_c3d(tmp_path / "copy.c3d").positions
    assert_allclose(copied, 1000 * tracks.positions, rtol=1e-6)


def test_markers_are_converted_between_trc_and_c3d_and_cleaned(call, tmp_path, rng):
    steps = rng.normal(scale=0.01, size=(60, 3, 3)).cumsum(axis=0)
    steps[20:23, 1] = np.nan
    tracks = Tracks(("a", "b", "c"), 1.0 + steps, 50.0)
    first, second, third = (tmp_path / name for name in ("1.trc", "2.c3d", "3.trc"))
    write_trc(tracks, first)

    assert call("convert", first, second)[0] == 0
    assert call("convert", second, third)[0] == 0
    assert call("denoise", first, "--output-folder", tmp_path / "clean")[0] == 0

    assert_allclose(read_trc(third).positions, tracks.positions, atol=1e-6)
    clean = read_trc(tmp_path / "clean" / "1.trc")
    assert clean.names == tracks.names
    assert clean.visible.all()


def test_unswap_option_corrects_swapped_labels(call, recordings, leg_file, tmp_path):
    take = read_c3d(recordings / "mocap" / "05_13.c3d")
    names = take.names[:41]
    truth = take.positions[:480:4, :41]
    pair = [names.index(name) for name in names if name.endswith(("LKNE", "RKNE"))]
    swapped = truth.copy()
    swapped[40:90, pair] = truth[40:90, pair[::-1]]
    write_trc(Tracks(names, swapped, take.frame_rate / 4), tmp_path / "bad.trc")

    status, printed, _ = call(
        "denoise", tmp_path / "bad.trc", tmp_path / "good.trc", "--unswap", "--json"
    )

    assert (status, json.loads(printed)["swaps"]) == (0, 1)
    error = np.linalg.norm(read_trc(tmp_path / "good.trc").positions - truth, axis=-1)
    assert np.median(error[45:85][:, pair]) < 0.02
    assert (
        "Only markers have labels"
        in call("denoise", leg_file, tmp_path / "x.bvh", "--unswap")[2]
    )


def test_quality_prints_the_report_or_its_figures(call, leg_file):
    _, text, _ = call("quality", leg_file)
    _, figures, _ = call("quality", leg_file, "--json")

    assert text.startswith("120 frames at 60 Hz")
    parsed = json.loads(figures)
    assert parsed["input"] == str(leg_file)
    assert parsed["n_frames"] == 120


def test_denoise_writes_a_cleaner_take(call, swinging_leg, tmp_path, rng):
    rotations = swinging_leg.rotations + rng.normal(
        scale=0.02, size=swinging_leg.rotations.shape
    )
    rotations[:, -1] = swinging_leg.rotations[:, -1]
    rotations /= np.linalg.norm(rotations, axis=-1, keepdims=True)
    write_bvh(swinging_leg.with_poses(rotations), tmp_path / "noisy.bvh")

    status, printed, _ = call(
        "denoise", tmp_path / "noisy.bvh", tmp_path / "clean.bvh", "--json"
    )

    assert status == 0
    figures = json.loads(printed)
    assert figures["output"] == str(tmp_path / "clean.bvh")
    assert figures["after"]["n_frames"] == 120
    clean = read_bvh(tmp_path / "clean.bvh")
    errors = [
        np.abs(each - swinging_leg.rotations)[:, :3].mean()
        for each in (rotations, clean.rotations)
    ]
    assert errors[1] < 0.7 * errors[0]


def test_denoise_learns_from_clips(call, leg_file, tmp_path):
    status, printed, _ = call("denoise", leg_file, tmp_path / "clean.bvh", "--train", leg_file)

    assert status == 0
    assert "1 example clip" in printed


def test_saved_patterns_give_the_same_result_as_their_clips(
    call, leg_file, swinging_leg, tmp_path
):
    noisy = tmp_path / "noisy.bvh"
    write_bvh(corrupt(swinging_leg, CorruptionSettings(jitter=3.0)), noisy)
    twin = tmp_path / "twin.bvh"
    twin.write_bytes(leg_file.read_bytes())
    learned, out = tmp_path / "legs.npz", [tmp_path / "a.bvh", tmp_path / "b.bvh"]
    longer = ("--window", 0.8, "--frame-rate", 20)

    status, printed, _ = call("learn", leg_file, twin, "--output", learned, *longer, "--json")
    call("denoise", noisy, out[0], "--train", leg_file, twin, *longer)
    call("denoise", noisy, out[1], "--bases", learned)

    assert status == 0
    figures = json.loads(printed)
    assert figures.pop("n_patterns") == len(load_filter_bases(learned).values)
    assert figures == {
        "inputs": [str(leg_file), str(twin)],
        "output": str(learned),
        "n_clips": 2,
        "window_frames": 16,
        "frame_rate_hz": 20.0,
        "parts": ["hips", "joint knee", "joint ankle", "place"],
    }
    assert out[0].read_bytes() == out[1].read_bytes()
    assert call("denoise", noisy, out[1])[0] == 0
    assert out[0].read_bytes() != out[1].read_bytes()


def test_learn_reports_its_result(call, leg_file, tmp_path):
    learned = tmp_path / "legs.npz"

    status, printed, error_output = call("learn", leg_file, "--output", learned)

    assert (status, error_output) == (0, "")
    assert re.fullmatch(rf"Learned \d+ patterns from 1 clip into {learned}\.\n", printed)


def test_patterns_of_points_are_refused_for_a_skeleton(call, leg_file, tmp_path, rng):
    steps = rng.normal(scale=0.01, size=(90, 4, 3)).cumsum(axis=0)
    write_c3d(Tracks(("a", "b", "c", "d"), 1.0 + steps, 30.0), tmp_path / "points.c3d")
    assert call("learn", tmp_path / "points.c3d", "--output", tmp_path / "points.npz")[0] == 0

    status, _, error_output = call(
        "denoise", leg_file, tmp_path / "out.bvh", "--bases", tmp_path / "points.npz"
    )

    assert status == 2
    assert "The examples are of points, the recording is not." in error_output


def test_pattern_file_is_never_executed(call, leg_file, tmp_path):
    """A pickle can run any program when it is opened; such a file is refused unopened."""
    flag, bad = tmp_path / "flag", tmp_path / "bad.npz"

    class Attack:
        def __reduce__(self):
            return (Path.touch, (flag,))

    assert call("learn", leg_file, "--output", bad)[0] == 0
    with np.load(bad) as learned:
        arrays = dict(learned) | {"keys": np.array([Attack()], dtype=object)}
    np.savez(bad, **arrays)

    status, _, error_output = call("denoise", leg_file, tmp_path / "out.bvh", "--bases", bad)

    assert status == 2
    assert "bad.npz is not a readable archive" in error_output
    assert not flag.exists()


def test_denoise_limits_joints_to_the_angles_of_the_clips(call, swinging_leg, tmp_path):
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


def test_denoise_plants_existing_feet(call, leg_file, tmp_path):
    """The sample has some; a single leg has none that it knows."""
    walk = walking_gait(GaitSettings(duration=1.5, frame_rate=30.0))
    write_bvh(walk, tmp_path / "walk.bvh")

    _, printed, _ = call("denoise", tmp_path / "walk.bvh", tmp_path / "clean.bvh", "--json")
    figures = json.loads(printed)
    assert figures["slide_after_m"] < figures["slide_before_m"]
    steps = [figures[when]["feet"]["left"]["contact_share"] for when in ("before", "after")]
    assert steps[0] == steps[1] > 0.0, "else the slide is not that of the same steps"
    _, printed, _ = call("denoise", leg_file, tmp_path / "leg-clean.bvh")
    assert "Feet were not planted. No leg was found" in printed
    _, printed, _ = call("denoise", leg_file, tmp_path / "leg-clean.bvh", "--no-feet")
    assert "Feet" not in printed
    status, _, error_output = call("denoise", leg_file, tmp_path / "leg-clean.bvh", "--feet")
    assert status == 2
    assert "leg.bvh: No leg was found" in error_output


@pytest.mark.parametrize("verb", [(), *((name,) for name in VERBS)], ids=str)
def test_help_fits_the_window(call, verb, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")

    status, printed, error_output = call(*verb, "--help")

    assert (status, error_output) == (0, "")
    assert max(map(len, printed.splitlines())) <= 80
    assert printed.startswith("usage: solvers")


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["convert", "IN"], "1 file is named: name one to read and one to write"),
        (["convert", "IN", "IN"], "would be overwritten. Recordings are never changed"),
        (["convert", "IN", "out.fbx"], "out.fbx cannot be written; end the name in .bvh"),
        (["convert", "IN", "no/out.bvh"], "there is no folder no"),
        (["convert", "IN", "out.c3d"], "A skeleton's motion cannot be written as out.c3d"),
        (["convert", "IN", "IN", "--output-folder", "o"], "is named twice. Name it once."),
        (["convert", "IN", "out.bvh", "--scale", "-1"], "scale is -1; it must be above 0."),
        (["convert", "IN", "out.bvh", "--jobs", "0"], "jobs is 0; it must be at least 1."),
        (["denoise", "IN", "out.bvh", "--strength", "7"], "must lie between 0 and 1"),
        (["denoise", "IN", "out.bvh", "--train", "gone.bvh"], "There is no file gone.bvh."),
        (["denoise", "IN", "out.bvh", "--bases", "gone.npz"], "There is no file gone.npz."),
        (["denoise", "IN", "out.bvh", "--bases", "IN"], "leg.bvh is not a readable archive"),
        (
            ["denoise", "IN", "out.bvh", "--bases", "b.npz", "--train", "IN"],
            "Argument --train: not allowed with argument --bases",
        ),
        (
            ["denoise", "IN", "out.bvh", "--window", "1"],
            "--window is an option for learning. Name clean",
        ),
        (["denoise", "IN", "out.bvh", "--joint-limits"], "name some with --train"),
        (["learn", "IN"], "The following arguments are required: --output"),
        (["learn", "IN", "--output", "b.bvh"], "end the name in .npz (learned patterns)"),
        (["learn", "IN", "--output", "no/b.npz"], "there is no folder no"),
        (["learn", "IN", "--output", "IN"], "would be overwritten"),
        (["learn", "IN", "gone.amc", "--output", "b.npz"], "There is no file gone.amc."),
        (["learn", "IN", "--output", "b.npz", "--window", "3"], "No example is as long as"),
        (["quality", "gone.bvh"], "There is no file gone.bvh."),
        (["quality", "IN", "--scale", "x"], "Argument --scale: invalid float value: 'x'"),
        (["sharpen", "IN"], "Argument VERB: invalid choice: 'sharpen'"),
        ([], "The following arguments are required: VERB"),
    ],
)
def test_invalid_arguments_give_one_sentence_and_status_2(
    call, leg_file, tmp_path, monkeypatch, words, sentence
):
    monkeypatch.chdir(tmp_path)

    status, printed, error_output = call(
        *(leg_file if word == "IN" else word for word in words)
    )

    assert status == 2
    assert printed == ""
    assert sentence in error_output
    assert error_output.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["leg.bvh"]
