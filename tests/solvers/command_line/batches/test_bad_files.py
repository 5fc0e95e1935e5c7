"""Invalid files that users reported: the output is complete, or there is one sentence."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from long_takes import write_long_bvh
from process_checks import cpu_time_of

from solvers.command_line.sharing.records import FOLDER
from solvers.denoising import learn_filter_bases, load_filter_bases
from solvers.errors import InvalidFileError
from solvers.recordings import read_bvh, write_bvh

ROOT = Path(__file__).parents[4]
HIERARCHY = """HIERARCHY
ROOT hip
{
OFFSET 0 1 0
CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
JOINT knee
{
OFFSET 0 -0.5 0
CHANNELS 3 Zrotation Xrotation Yrotation
End Site
{
OFFSET 0 -0.5 0
}
}
}
MOTION
"""


@pytest.fixture
def bvh(tmp_path, rng):
    """Write a file of a knee that swings, after something was done to its numbers."""

    def write(spoil=lambda frames: frames, frame_time="0.0333333", name="in.bvh") -> Path:
        time = np.arange(60) / 30.0
        frames = np.zeros((60, 9))
        frames[:, 0], frames[:, 1] = time, 1.0
        frames[:, 3], frames[:, 6] = 20 * np.sin(6 * time), 30 * np.sin(5 * time)
        frames = np.asarray(spoil(frames + rng.normal(scale=0.001, size=frames.shape)))
        rows = "\n".join(" ".join(str(float(number)) for number in row) for row in frames)
        path = tmp_path / name
        path.write_text(f"{HIERARCHY}Frames: {len(frames)}\nFrame Time: {frame_time}\n{rows}\n")
        return path

    return write


def at(frames, value):
    """Frame 5 with another value everywhere."""
    changed = frames.copy()
    changed[5] = value
    return changed


@pytest.mark.parametrize(
    ("spoil", "frame_time"),
    [
        (lambda f: f[:1], "0.0333333"),
        (lambda f: f[:2], "0.0333333"),
        (lambda f: np.repeat(f[:1], 40, axis=0), "0.0333333"),
        (lambda f: np.repeat(f[::3], 3, axis=0), "0.0333333"),
        (lambda f: at(f, np.nan), "0.0333333"),
        (lambda f: at(f, np.inf), "0.0333333"),
        (lambda f: at(f, 0.0), "0.0333333"),
        (lambda f: f + [0, 0, 0, 360, 0, 0, -720, 0, 0] * (np.arange(60) % 2)[:, None], "0.04"),
        (lambda f: f, "0.0333667"),
        (lambda f: f, "0"),
        (lambda f: f, "-1"),
        (lambda f: f, "nan"),
        (lambda f: f, "1e-300"),
        (lambda f: f, "1e9"),
    ],
    ids=[
        "one frame",
        "two frames",
        "constant",
        "repeated frames",
        "a NaN",
        "an infinity",
        "a frame of zeros",
        "whole turns",
        "29.97 Hz",
        "no time",
        "negative time",
        "time NaN",
        "tiny time",
        "long time",
    ],
)
def test_denoise_fills_unusual_takes_completely(call, bvh, tmp_path, spoil, frame_time):
    source, target = bvh(spoil, frame_time), tmp_path / "out.bvh"

    status, printed, error_output = call("denoise", source, target, "--json")

    assert (status, error_output) == (0, "")
    json.loads(printed, parse_constant=pytest.fail)
    clean = read_bvh(target)
    assert clean.n_frames == read_bvh(source).n_frames
    assert clean.observed.all()
    assert np.isfinite(clean.root_positions).all()


@pytest.mark.parametrize("verb", ["denoise", "quality", "convert"])
@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"\0" * 10_000,
        bytes(range(256)) * 40,
        b"HIERARCHY\n" + b"ROOT a\n{\n" * 50_000,
        b"HIERARCHY " + b"x" * 1_000_000,
        f"{HIERARCHY}Frames: 1000000000\nFrame Time: 0.03\n".encode(),
        f"{HIERARCHY}Frames: 1\nFrame Time: 0.03\n".encode() + b"\0" * 100,
        f"{HIERARCHY}Frames: 1\nFrame Time: 0.03\n{'1e300 ' * 9}\n".encode(),
    ],
    ids=["empty", "zeros", "binary", "endless", "one line", "no frames", "NUL", "huge"],
)
def test_file_that_is_no_take_gives_one_sentence(call, tmp_path, verb, content):
    source = tmp_path / "in.bvh"
    source.write_bytes(content)
    target = [] if verb == "quality" else [tmp_path / "out.bvh"]

    status, printed, error_output = call(verb, source, *target)

    assert (status, printed) == (2, "")
    assert error_output.count("\n") == 1
    assert "in.bvh" in error_output
    assert [path.name for path in tmp_path.iterdir()] == ["in.bvh"]


def test_folder_is_refused_as_input_and_output_file(call, bvh, tmp_path):
    folder = tmp_path / "folder.bvh"
    folder.mkdir()

    for words in (["quality", folder], ["convert", bvh(), folder]):
        status, _, error_output = call(*words)

        assert status == 2
        assert "folder.bvh" in error_output
        assert error_output.count("\n") == 1


def test_file_is_refused_as_output_folder(call, bvh):
    status, _, error_output = call("convert", bvh(), "--output-folder", bvh(name="b.bvh"))

    assert status == 2
    assert "is a file; name a folder to write to." in error_output


@pytest.mark.parametrize("verb", ["convert", "learn"])
def test_full_disk_is_reported_and_keeps_the_old_file(bvh, tmp_path, verb):
    resource = pytest.importorskip("resource")
    source, target = bvh(), tmp_path / "out.bvh"
    words = ["convert", source, target]
    if verb == "learn":
        target = tmp_path / "out.npz"
        words = ["learn", source, "--output", target]
        learn_filter_bases([read_bvh(source)]).save(target)
    else:
        target.write_text("before")
    before = target.read_bytes()

    def limit() -> None:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))

    done = subprocess.run(
        [sys.executable, "-B", "-m", "solvers", *words],
        cwd=ROOT, preexec_fn=limit, timeout=500, capture_output=True, text=True,
    )  # fmt: skip

    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert f"{target.name} cannot be written: " in done.stderr
    assert target.read_bytes() == before
    assert {path.name for path in tmp_path.iterdir()} == {"in.bvh", target.name}


@pytest.mark.parametrize(
    "words",
    [
        ["--strength", "nan"],
        ["--strength", "-1"],
        ["--window", "0"],
        ["--window", "1e9"],
        ["--frame-rate", "0"],
        ["--scale", "nan"],
        ["--jobs", "-3"],
        ["--feet"],
    ],
    ids=" ".join,
)
def test_settings_out_of_range_give_one_sentence(call, bvh, tmp_path, words):
    status, printed, error_output = call("denoise", bvh(), tmp_path / "out.bvh", *words)

    assert (status, printed) == (2, "")
    assert error_output.count("\n") == 1
    assert not (tmp_path / "out.bvh").exists()


def test_out_of_memory_gives_one_sentence(call, bvh, tmp_path, monkeypatch):
    def gluttonous(*_, **__):
        raise MemoryError

    monkeypatch.setattr("solvers.command_line.denoise_verb.denoise", gluttonous)

    status, _, error_output = call("denoise", bvh(), tmp_path / "out.bvh")

    assert status == 2
    assert "in.bvh needs more memory than is available" in error_output


def test_interrupt_leaves_only_complete_files(swinging_leg, tmp_path):
    files = [tmp_path / f"{number}.bvh" for number in range(3)]
    for file in files:
        write_bvh(swinging_leg, file)
    long = tmp_path / "3.bvh"
    write_long_bvh(swinging_leg, long)
    out = tmp_path / "out"
    with subprocess.Popen(
        [sys.executable, "-m", "solvers", "denoise", *files, long, "--output-folder", out],
        cwd=ROOT, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True,
    ) as running:  # fmt: skip
        try:
            while running.poll() is None and not list(out.glob(f"{FOLDER}/3.bvh.*.claim")):
                time.sleep(0.02)
            within_the_long_take = cpu_time_of(running.pid) + 0.2
            while running.poll() is None and cpu_time_of(running.pid) < within_the_long_take:
                time.sleep(0.02)
            os.kill(running.pid, signal.SIGINT)
            error_output = running.communicate(timeout=500)[1]
        finally:
            running.kill()

    assert running.returncode == 130
    assert error_output == "Interrupted. Finished files are kept.\n"
    assert [path.name for path in out.glob(".*")] == [FOLDER]
    assert all(path.suffix == ".json" for path in (out / FOLDER).iterdir())
    for file in files:
        assert read_bvh(out / file.name).n_frames == swinging_leg.n_frames


def test_damaged_patterns_are_never_executed(swinging_leg, tmp_path, rng):
    path, bad = tmp_path / "walk.npz", tmp_path / "bad.npz"
    learn_filter_bases([swinging_leg]).save(path)
    complete = path.read_bytes()
    np.save(tmp_path / "array.npy", np.zeros(3))
    damaged = [(tmp_path / "array.npy").read_bytes(), b""]
    damaged += [complete[: int(size)] for size in rng.integers(0, len(complete), 60)]
    for position in rng.integers(0, len(complete), 200):
        flipped = bytearray(complete)
        flipped[position] ^= 1 << rng.integers(8)
        damaged.append(bytes(flipped))

    refused = 0
    for content in damaged:
        bad.write_bytes(content)
        try:
            load_filter_bases(bad)
        except InvalidFileError as error:
            refused += 1
            assert "bad.npz" in str(error)

    assert refused > 150


@pytest.mark.parametrize(
    ("name", "change", "sentence"),
    [
        ("version", lambda version: version + 99, "was saved as version "),
        ("kind", lambda kind: np.array("recipes"), "holds recipes, not filter bases"),
        ("keys", lambda keys: keys.astype(object), "is not a readable archive"),
        ("mean", lambda mean: None, "damaged bases .'mean'"),
        ("mean", lambda mean: mean[1:], "the shapes do not fit, first that of mean"),
        ("vectors", lambda vectors: vectors[0], "the shapes do not fit, first that of vectors"),
        ("vectors", lambda vectors: vectors * np.nan, "not all numbers are finite"),
        ("frame_rate", lambda rate: -rate, "a frame rate of -30 Hz"),
    ],
)
def test_invalid_patterns_are_refused(swinging_leg, tmp_path, name, change, sentence):
    path = tmp_path / "walk.npz"
    learn_filter_bases([swinging_leg]).save(path)
    with np.load(path) as archive:
        arrays = {key: archive[key] for key in archive.files}
    arrays[name] = change(arrays[name])
    np.savez(path, **{key: array for key, array in arrays.items() if array is not None})

    with pytest.raises(InvalidFileError, match=sentence):
        load_filter_bases(path)
