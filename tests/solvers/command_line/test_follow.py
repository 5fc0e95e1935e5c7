"""`capture --follow`: a folder becomes motion while a recorder writes it."""

import json
import signal
import threading
import time

import numpy as np
import pytest
from depth_folders import save_png
from drawn_bodies import CAMERA, recorded, waving

from solvers.command_line.follow_recording import end_on_signal
from solvers.depth_tracking.body.model import default_body
from solvers.recordings import read_bvh
from solvers.recordings.growing import GrowingFolder

N_FRAMES = 24
LENS = ("--fx", CAMERA.fx, "--cx", CAMERA.cx, "--cy", CAMERA.cy, "--scale", 0.001)
FAST = (
    "--follow", "--calibration", 0.5, "--max-silence", 0.5, "--max-wait", 0.5,
    "--max-delay", 0, "--check-every", 1000,
)  # fmt: skip


@pytest.fixture(scope="module")
def pictures():
    take = recorded(waving(N_FRAMES))
    return [np.round(1000 * take.frame(each)).astype(np.uint16) for each in range(N_FRAMES)]


@pytest.fixture
def options(tmp_path):
    default_body().save(tmp_path / "body.npz")
    return (*LENS, *FAST, "--body", tmp_path / "body.npz")


@pytest.fixture
def folder(tmp_path, pictures):
    for number, picture in enumerate(pictures):
        save_png(tmp_path / "take" / f"{number:06}.png", picture)
    return tmp_path / "take"


def test_folder_is_written_as_motion_when_nothing_more_comes(call, folder, options, tmp_path):
    content = (folder / "000023.png").read_bytes()
    (folder / "000023.png").write_bytes(content[:100])

    status, out, err = call("capture", folder, tmp_path / "out.bvh", *options, "--json")

    assert (status, err) == (0, "")
    figures = json.loads(out)
    assert figures["n_frames"] == figures["n_images"] == 23 and figures["n_dropped"] == 0
    assert any("not written completely: 1, 000023" in each for each in figures["remarks"])
    assert read_bvh(tmp_path / "out.bvh").n_frames == 23


def test_folder_that_a_recorder_writes_is_tracked(call, tmp_path, pictures, options):
    def record():
        for number, picture in enumerate(pictures):
            time.sleep(0.01)
            save_png(tmp_path / "later" / f"{number:06}.png", picture)

    recorder = threading.Thread(target=record)
    recorder.start()

    status, out, err = call("capture", tmp_path / "later", tmp_path / "out.bvh", *options)
    recorder.join()

    assert (status, err) == (0, "") and "24 frames, " in out


def test_first_ctrl_c_ends_the_recording_and_the_second_interrupts():
    before = signal.getsignal(signal.SIGINT)
    with end_on_signal() as is_ended:
        assert not is_ended()
        signal.raise_signal(signal.SIGINT)
        assert is_ended()
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) is before


def test_ctrl_c_writes_the_motion_so_far(call, folder, options, tmp_path, monkeypatch):
    """The folder is complete, but following it would wait for an hour."""
    options = [*options, "--max-silence", 3600]
    polls = []

    def poll(self):
        polls.append(poll)
        if len(polls) == 60:
            signal.raise_signal(signal.SIGINT)
        return former(self)

    former = GrowingFolder.poll
    monkeypatch.setattr(GrowingFolder, "poll", poll)
    status, out, err = call("capture", folder, tmp_path / "out.bvh", *options)

    assert (status, err) == (0, "") and " frames, " in out
    assert (tmp_path / "out.bvh").exists()


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["take.bvh"], "No depth image came. Check the folder "),
        (["take.bvh", "--method", "wei"], "The method wei tracks one person in the complete"),
    ],
)
def test_what_cannot_be_followed_is_one_sentence(call, tmp_path, options, words, sentence):
    (tmp_path / "empty").mkdir()
    words = [tmp_path / each if each == "take.bvh" else each for each in words]

    status, _, err = call("capture", tmp_path / "empty", *words, *options)

    assert status == 2 and err.count("\n") == 1 and sentence in err
    assert not (tmp_path / "take.bvh").exists()


@pytest.mark.parametrize(
    ("content", "sentence"),
    [(None, "No file {} came. Check the file"), (b"", "{} contains no image yet.")],
)
def test_mkv_without_images_is_not_taken_for_a_folder(
    call, tmp_path, options, content, sentence
):
    path = tmp_path / "take.mkv"
    if content is not None:
        path.write_bytes(content)

    status, _, err = call("capture", path, tmp_path / "out.bvh", *options)

    assert status == 2 and err.count("\n") == 1 and sentence.format(path) in err


def test_several_recordings_are_not_followed(call, folder, options, tmp_path):
    status, _, err = call("capture", folder, "--output-folder", tmp_path / "out", *options)

    assert status == 2 and "One recording can be followed at a time" in err
