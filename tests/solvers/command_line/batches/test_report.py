"""A complete batch is reported in one page, also after an interruption."""

import json
import os
import signal
import subprocess
import sys
import time
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

import numpy as np
import pytest
from joint_files import kinect_csv, moving
from long_takes import write_long_bvh

from solvers.recordings import read_bvh, read_recording, write_bvh

ROOT = Path(__file__).parents[4]
CLAIM = ".mocap_assist/late.bvh.*.1.claim"
PNG = b"\x89PNG\r\n\x1a\n"


class Page(HTMLParser):
    """What a reader of the page sees: titles, words, and which pictures."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.titles, self.words, self.pictures, self._inside = [], [], [], ""
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        self._inside = tag
        if tag == "img":
            self.pictures.append(unquote(dict(attrs)["src"]))

    def handle_data(self, data):
        self.words.append(data)
        if self._inside == "h2" and data.strip():
            self.titles.append(data)


@pytest.fixture
def takes(swinging_leg, tmp_path) -> Path:
    """A folder with a folder in it, recordings, and what is none."""
    folder = tmp_path / "takes"
    (folder / "day <2>").mkdir(parents=True)
    (folder / ".trash").mkdir()
    for position in ("leg.bvh", "day <2>/leg & foot.bvh", ".trash/old.bvh"):
        write_bvh(swinging_leg, folder / position)
    (folder / "notes.txt").write_text("Tuesday: the actor limped.\n")
    (folder / "kinect.csv").write_text(kinect_csv(moving(40, 25)))
    return folder


def test_report_has_every_file(call, takes, tmp_path):
    (takes / "bad.bvh").write_text("HIERARCHY\nMOTION\n")
    out = tmp_path / "out"

    status, _, error_output = call("denoise", takes, "--output-folder", out, "--report")

    assert status == 2
    assert error_output.count("\n") == 1
    page = Page(out / "report.html")
    assert page.titles[0] == "bad.bvh"
    assert sorted(page.titles) == ["bad.bvh", "kinect.csv", "leg & foot.bvh", "leg.bvh"]
    assert "Mocap Assist, denoise: 3 done, 1 failed" in page.words
    assert error_output.strip() in page.words
    assert sorted(page.pictures) == [
        "report/day <2>/leg & foot.bvh.png", "report/kinect.trc.png", "report/leg.bvh.png",
    ]  # fmt: skip
    assert all((out / picture).read_bytes().startswith(PNG) for picture in page.pictures)
    messages = json.loads((out / "report.json").read_text())
    assert (messages["verb"], messages["done"], messages["failed"]) == ("denoise", 3, 1)
    figures = {Path(each["input"]).name: each for each in messages["files"]}
    assert figures["bad.bvh"]["error"] == error_output.strip()
    leg = figures["leg.bvh"]
    assert leg["before"]["n_frames"] == 120
    assert f"{leg['before']['mean_jitter_m_per_s3']:.3g} → " in "".join(page.words)


def test_a_folder_keeps_its_form_and_points_stay_points(call, takes):
    out = takes / "clean"
    words = ["convert", takes, "--output-folder", out]

    assert call(*words)[0] == 0
    again = call(*words)[1]

    made = {path.relative_to(out).as_posix() for path in out.rglob("*") if path.is_file()}
    made = {path for path in made if not path.startswith(".mocap_assist/")}
    assert made == {"leg.bvh", "day <2>/leg & foot.bvh", "kinect.trc"}
    assert again.count("Already made.") == 3
    kinect = read_recording(takes / "kinect.csv").tracks
    offsets = read_recording(out / "kinect.trc").positions - kinect.positions
    assert np.nanmax(np.abs(offsets[..., :2])) < 1e-5
    assert np.nanmax(offsets[..., 2]) - np.nanmin(offsets[..., 2]) < 1e-5  # put on the floor


def test_quality_and_examples_take_folders_too(call, takes, leg_file, tmp_path):
    assert call("quality", takes)[1].count(" frames at ") == 3
    (takes / "kinect.csv").unlink()
    status, printed, _ = call("learn", takes, "--output", tmp_path / "legs.npz")
    assert (status, "from 2 clips" in printed) == (0, True)
    assert call("denoise", leg_file, tmp_path / "a.bvh", "--train", takes)[0] == 0


def test_a_folder_without_recordings_is_refused(call, tmp_path):
    (tmp_path / "empty").mkdir()
    (tmp_path / "empty" / "notes.txt").write_text("nothing")

    status, _, error_output = call("quality", tmp_path / "empty")

    assert (status, error_output) == (
        2, f"There is no recording in the folder {tmp_path / 'empty'}.\n",
    )  # fmt: skip


def test_a_folder_of_files_that_need_blender_names_the_way(call, tmp_path):
    (tmp_path / "shots").mkdir()
    (tmp_path / "shots" / "walk.fbx").write_bytes(b"Kaydara FBX Binary")

    status, _, error_output = call("quality", tmp_path / "shots")

    assert status == 2
    assert "such as walk.fbx, press Fix Folder in Blender, or run blender" in error_output
    assert f" each {tmp_path / 'shots'} --output-folder DIR -- import." in error_output

    of_depth = call("capture", tmp_path / "shots", "--output-folder", tmp_path / "out")
    assert of_depth[2] == f"There is no recording in the folder {tmp_path / 'shots'}.\n"


def test_a_report_needs_a_folder(call, leg_file, tmp_path):
    status, _, error_output = call("convert", leg_file, tmp_path / "out.bvh", "--report")

    assert status == 2
    assert error_output == "A report needs a folder: name it with --output-folder DIR.\n"


def test_killed_batch_is_resumed(swinging_leg, takes, tmp_path, call):
    """The last file takes long: there the batch is killed."""
    out, late = tmp_path / "out", tmp_path / "late.bvh"
    write_long_bvh(swinging_leg, late)
    words = ["denoise", takes, late, "--output-folder", out]
    with subprocess.Popen([sys.executable, "-m", "solvers", *words], cwd=ROOT) as running:
        while running.poll() is None and not list(out.glob(CLAIM)):
            time.sleep(0.02)
        os.kill(running.pid, signal.SIGKILL)
    write_bvh(swinging_leg, late)
    n_made = len(list(out.glob(".mocap_assist/*.json")))
    (late_claim,) = out.glob(CLAIM)
    (out / "report").mkdir()
    halves = [
        out / ".late.0123456789ab.bvh",
        late_claim.with_name(f".{late_claim.name.split('.1.')[0]}.0123456789ab.json"),
        out / "report" / ".late.bvh.0123456789ab.png",
    ]
    for half in halves:
        half.write_text("cut off by the ki")

    status, printed, _ = call(*words, "--report")

    assert status == 0
    assert n_made >= 1
    assert printed.count("Already made.") == n_made
    messages = json.loads((out / "report.json").read_text())
    assert messages["done"] == 4
    assert all("after" in each and "picture" in each for each in messages["files"])
    assert read_bvh(out / "late.bvh").n_frames == swinging_leg.n_frames
    assert not [half for half in halves if half.exists()]
    assert not list(out.rglob("*.claim"))


def test_report_distinguishes_files_of_the_same_name(call, takes, swinging_leg, tmp_path):
    (takes / "leg.csv").write_text(kinect_csv(moving(40, 25)))
    (takes / "leg.txt").write_text(kinect_csv(moving(40, 25)))
    other = tmp_path / "more"
    other.mkdir()
    write_bvh(swinging_leg, other / "leg.bvh")

    assert call("convert", takes, other, "--output-folder", tmp_path / "out")[0] == 0

    made = {
        path.relative_to(tmp_path / "out").as_posix()
        for path in tmp_path.rglob("out/*/**/leg*")
        if ".mocap_assist" not in path.parts
    }
    assert made == {
        "takes/leg.bvh", "takes/leg.csv.trc", "takes/leg.txt.trc", "more/leg.bvh",
        "takes/day <2>/leg & foot.bvh",
    }  # fmt: skip


def test_changed_skeleton_or_example_makes_a_take_again(call, recordings, tmp_path):
    for name in ("05.asf", "05_13.amc"):
        (tmp_path / name).write_bytes((recordings / "mocap" / name).read_bytes())
    words = ["convert", tmp_path / "05_13.amc", "--output-folder", tmp_path / "out"]
    call(*words)
    skeleton = tmp_path / "05.asf"
    skeleton.write_text(skeleton.read_text().replace("length 0.45", "length 0.5"))

    assert "Already made." not in call(*words)[1]


def test_report_picture_shows_the_current_take(call, takes, tmp_path):
    (takes / "kinect.csv").unlink()
    words = ["denoise", takes, "--output-folder", tmp_path / "out"]
    call(*words, "--report")
    picture = tmp_path / "out" / "report" / "leg.bvh.png"
    first = picture.read_bytes()

    call(*words, "--strength", 0)
    assert not picture.exists()
    call(*words, "--strength", 0, "--report")

    assert picture.read_bytes() != first
