"""`blender FILE --command mocap_assist ...`: the buttons without a window."""

import errno
import json
from types import SimpleNamespace

import pytest
from numpy.testing import assert_allclose


def test_denoise_command_cleans_and_saves(bad_arm, blank, command, tmp_path):
    target = tmp_path / "clean.blend"

    status, out, err = command(
        "denoise", "--output", str(target), "--json", "--no-plant-feet", "--strength", "0.9"
    )

    assert (status, err) == (0, "")
    result = json.loads(out.splitlines()[0])  # Blender itself says that it saved
    assert (result["armature"], result["action"], result["settings"]["strength"]) == (
        "Actor",
        "walk.clean",
        0.9,
    )
    blank.ops.wm.open_mainfile(filepath=str(target))
    assert blank.data.objects["Actor"].animation_data.action.name == "walk.clean"
    assert blank.data.actions["walk.clean"]["mocap_assist_source"] == blank.data.actions["walk"]


def test_denoise_command_learns_from_files(dancer, blank, command, tmp_path):
    clips = [str(tmp_path / f"{name}.bvh") for name in ("one", "two")]
    for clip in clips:
        blank.ops.export_anim.bvh(filepath=clip, frame_start=1, frame_end=300)

    status, out, _ = command(
        "denoise", "--output", str(tmp_path / "x.blend"), "--json", "--train", *clips
    )

    settings = json.loads(next(line for line in out.splitlines() if line[:1] == "{"))[
        "settings"
    ]
    assert (status, settings["prior"], settings["examples"]) == (
        0, "examples", "; ".join(clips),
    )  # fmt: skip


def test_denoise_command_skips_armatures_without_an_action(dancer, make_armature, command):
    make_armature(name="Driven").driver_add("location", 0)

    status, out, _ = command("quality", "--json")

    assert (status, json.loads(out)["armature"]) == (0, "Actor")


def test_command_reports_an_unwritable_file(dancer, command, tmp_path):
    (tmp_path / "x.blend").mkdir()

    status, _, err = command("denoise", "--output", str(tmp_path / "x.blend"))

    assert status == 2
    assert "x.blend was not saved: " in err and "MB are free" not in err


@pytest.mark.parametrize("free", [1_500_000, None])
def test_command_reports_a_full_disk(dancer, command, tmp_path, monkeypatch, free):
    (tmp_path / "x.blend").mkdir()

    def usage(folder):
        if free is None:
            raise OSError(errno.EIO, "Input/output error")
        return SimpleNamespace(free=free)

    monkeypatch.setattr("shutil.disk_usage", usage)

    status, _, err = command("denoise", "--output", str(tmp_path / "x.blend"))

    assert status == 2 and "x.blend was not saved: " in err
    assert ("1.5 MB are free on its disk. Free some space" in err) == (free is not None)


def test_picture_that_cannot_be_drawn_is_reported(dancer, command, monkeypatch, tmp_path):
    picture = tmp_path / "x.png"
    picture.write_bytes(b"an older picture")

    def fill_disk(*_, **__):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("PIL.Image.Image.save", fill_disk)

    status, _, err = command("quality", "--picture", picture)

    assert (status, err) == (0, f"{picture} cannot be written: the disk is full.\n")
    assert picture.read_bytes() == b"an older picture"


def test_quality_command_measures(bad_arm, command):
    status, out, _ = command("quality", "--armature", "Actor")
    assert status == 0 and "LeftArm is missing for 2.00 s." in out

    status, out, _ = command("quality", "--json")
    assert json.loads(out)["joints"]["LeftArm"]["turn_gaps"] == [[100, 160]]


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (
            ["denoise", "--armature", "Nobody"],
            "There is no armature Nobody; the scene has Actor.\n",
        ),
        (["denoise"], "No file is open: name the file to save with --output FILE.\n"),
        (
            ["denoise", "--output", "/nowhere/x.blend"],
            "There is no folder /nowhere to save in.\n",
        ),
        (
            ["denoise", "--output", "/tmp/x.blend", "--strength", "7"],
            "strength is 7; it must lie between 0 and 1.\n",
        ),
    ],
)
def test_command_fails_with_one_sentence_and_status_2(words, sentence, dancer, command):
    assert command(*words) == (2, "", sentence)


def test_invalid_command_line_has_status_2(dancer, command):
    status, _, err = command("denoise", "--strenght", "1")
    assert status == 2 and "unrecognized arguments" in err.lower()


def test_json_file_has_the_figures_only(bad_arm, command, tmp_path):
    figures = tmp_path / "figures.jsonl"

    status, out, err = command("quality", "--json", str(figures))

    assert (status, err) == (0, "") and "LeftArm is missing for 2.00 s." in out
    (line,) = figures.read_text().splitlines()
    assert json.loads(line)["armature"] == "Actor"


def test_command_changes_nothing_when_figures_cannot_be_written(
    bad_arm, command, tmp_path, blank
):
    target = str(tmp_path / "x.blend")

    done = command("denoise", "--output", target, "--json", str(tmp_path / "no" / "f.jsonl"))

    assert done == (2, "", f"There is no folder {tmp_path / 'no'} to save in.\n")
    assert not list(tmp_path.iterdir()) and "walk.clean" not in blank.data.actions


def test_convert_command_writes_the_played_action(
    dancer, blank, command, load, tmp_path, poses
):
    dancer.animation_data.action.name = "dance"
    shown = poses(dancer, range(1, 301, 50))

    status, out, _ = command("convert", str(tmp_path / "dance.bvh"), "--json")

    result = json.loads(out)
    assert (status, result["n_frames"], result["frame_rate_hz"]) == (0, 300, 30.0)
    motion = load("solvers.recordings").read_bvh(tmp_path / "dance.bvh")
    positions = (
        load("solvers.motion.skeletons.kinematics").forward_kinematics(motion).positions[::50]
    )
    foot = positions[:, motion.skeleton.index("LeftFoot")] - positions[:, 0]
    expected = shown["LeftFoot"][:, :3, 3] - shown["Hips"][:, :3, 3]
    assert_allclose(foot, expected, atol=1e-4)


def test_several_armatures_are_converted_into_a_folder(
    dancer, make_armature, animate, command, tmp_path
):
    animate(make_armature(name="Other: one"))

    status, _, err = command("convert", str(tmp_path / "one.bvh"))
    assert (status, err.startswith("Actor, Other: one cannot all be written to")) == (2, True)
    assert command("convert", str(tmp_path))[0] == 0

    assert {path.name for path in tmp_path.iterdir()} == {"Actor.bvh", "Other__one.bvh"}


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("x.fbx", "x.fbx cannot be written; end the name in .bvh"),
        ("no/x.bvh", "there is no folder"),
        ("x.c3d", "cannot be written as"),
    ],
)
def test_convert_reports_an_unsupported_format(dancer, command, tmp_path, name, sentence):
    status, _, err = command("convert", str(tmp_path / name))

    assert status == 2 and sentence in err and not list(tmp_path.iterdir())


def test_convert_refuses_a_take_with_gaps(bad_arm, command, tmp_path):
    status, _, err = command("convert", str(tmp_path / "x.bvh"))

    assert status == 2 and "LeftArm" in err and not list(tmp_path.iterdir())
