"""Folders with odd names, closed folders and other files: all takes that can be made are."""

import io
import json
import os
import shutil

import pytest
from odd_files import OTHERS, close, pictures

from solvers.command_line.batches import escape_undecodable_names
from solvers.recordings import read_bvh, write_bvh
from solvers.samples import GaitSettings, walking_gait

NO_UTF8 = b"caf\xe9.bvh"


@pytest.fixture
def folder(tmp_path):
    """A folder with two walks, `walk.bvh` and `more/walk.bvh`."""
    (tmp_path / "takes" / "more").mkdir(parents=True)
    walk = walking_gait(GaitSettings(duration=1.0, frame_rate=30.0))
    write_bvh(walk, tmp_path / "takes" / "walk.bvh")
    shutil.copy(tmp_path / "takes" / "walk.bvh", tmp_path / "takes" / "more")
    return tmp_path / "takes"


def named(folder, name: bytes):
    """Give a third walk a name of these bytes; skip where the system allows no such name."""
    path = folder / os.fsdecode(name)
    try:
        shutil.copy(folder / "walk.bvh", path)
    except OSError:
        pytest.skip(f"no file can be called {name!r} here")
    return path


def test_name_that_is_not_utf_8_is_converted_and_shown_escaped(call, folder, tmp_path):
    named(folder, NO_UTF8)

    words = ["convert", folder, "--output-folder", tmp_path / "out", "--report"]
    status, out, err = call(*words)

    assert (status, err, out.count("30 frames")) == (0, "", 3)
    assert r"caf\udce9.bvh" in out
    assert read_bvh(tmp_path / "out" / os.fsdecode(NO_UTF8)).n_frames == 30
    assert r"caf\udce9.bvh" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert json.loads((tmp_path / "out" / "report.json").read_text())["done"] == 3


@pytest.mark.parametrize("errors", ["strict", "surrogateescape"])
def test_figures_and_names_are_printed_where_the_system_has_ascii_only(errors):
    """Python chooses `surrogateescape` in the locale C; figures have degrees."""
    printed = io.BytesIO()
    stream = io.TextIOWrapper(printed, "ascii", errors)

    escape_undecodable_names(stream)
    print("2.6°", os.fsdecode(NO_UTF8), file=stream, flush=True)

    assert printed.getvalue() == rb"2.6\xb0 caf\udce9.bvh" + b"\n"


def test_library_refuses_a_name_that_is_not_utf_8_and_adds_the_others(call, folder, tmp_path):
    path = named(folder, NO_UTF8)

    for _ in range(2):
        status, out, err = call("index", tmp_path / "all.clips", folder)

        assert (status, err.count("\n")) == (2, 1)
        assert r"caf\udce9.bvh' is not valid UTF-8" in err
        assert "all.clips has 2 clips" in out
    path.rename(folder / "cafe.bvh")
    assert call("index", tmp_path / "all.clips", folder)[0] == 0


@pytest.mark.parametrize("letter", ["a", "é", "走"])
def test_longest_names_are_written_or_refused_before_the_work(call, folder, tmp_path, letter):
    length = len(letter.encode())
    fits, long = letter * (247 // length), letter * (251 // length)
    for stem in (fits, long):
        named(folder, f"{stem}.bvh".encode())
    out = tmp_path / "out"

    status, printed, err = call("convert", folder, "--output-folder", out, "--report")

    assert (status, printed.count("30 frames"), err.count("\n")) == (2, 3, 1)
    assert f"{long}.bvh: The output {letter * 40}... needs a name of " in err
    assert {path.stem for path in out.glob("*.bvh")} == {"walk", fits}
    assert {path.name for path in out.glob("*/*.png")} == {"walk.bvh.png", f"{fits}.bvh.png"}


def test_argument_with_a_too_long_name_is_refused(call, folder, tmp_path):
    target = tmp_path / f"{'a' * 252}.bvh"

    status, _, err = call("convert", folder / "walk.bvh", target)

    assert (status, err.count("\n")) == (2, 1)
    assert f"The output {'a' * 40}... needs a name of 256 bytes, but 255 is the maximum." in err


def test_unwritable_output_does_not_stop_other_files(call, folder, tmp_path):
    (tmp_path / "out" / "walk.bvh").mkdir(parents=True)

    status, out, err = call("convert", folder, "--output-folder", tmp_path / "out")

    assert (status, out.count("30 frames"), err.count("\n")) == (2, 1, 1)
    assert "walk.bvh cannot be written: it is a folder." in err


def test_unreadable_folder_is_one_sentence_and_other_files_are_processed(
    call, folder, tmp_path, monkeypatch
):
    close(folder / "more", monkeypatch)

    for words in (
        ["convert", folder, "--output-folder", tmp_path / "out"],
        ["index", tmp_path / "all.clips", folder],
    ):
        status, out, err = call(*words)

        assert (status, err.count("\n")) == (2, 1)
        assert f"The folder {folder / 'more'} cannot be opened (Permission denied)." in err
        assert "30 frames" in out or "1 added" in out


def test_unreadable_folder_is_indexed_once_it_is_readable(call, folder, tmp_path):
    with pytest.MonkeyPatch.context() as closing:
        close(folder / "more", closing)
        call("index", tmp_path / "all.clips", folder)
    (folder / "more").chmod(0o700)

    status, out, err = call("index", tmp_path / "all.clips", folder)

    assert (status, err) == (0, "")
    assert "1 added, 1 unchanged" in out


def test_other_files_are_ignored_and_a_second_run_skips_its_outputs(call, folder, tmp_path):
    for name, content in {**OTHERS, **pictures()}.items():
        (folder / name).write_bytes(content)
    words = ["convert", folder, "--output-folder", folder / "out", "--report"]

    for made in ("30 frames", "Already made."):
        status, out, err = call(*words)
        assert (status, err, out.count(made)) == (0, "", 2)
    status, out, err = call("index", tmp_path / "all.clips", folder)

    assert (status, err) == (0, "")
    assert "4 added" in out


def test_a_link_to_a_file_elsewhere_is_converted(call, folder, tmp_path):
    (folder / "more" / "walk.bvh").rename(tmp_path / "elsewhere.bvh")
    (folder / "more" / "link.bvh").symlink_to(tmp_path / "elsewhere.bvh")

    status, _, err = call("convert", folder, "--output-folder", tmp_path / "out")

    assert (status, err) == (0, "")
    assert read_bvh(tmp_path / "out" / "more" / "link.bvh").n_frames == 30


def test_circular_link_does_not_stop_other_files(call, folder, tmp_path):
    loop, out = tmp_path / "loop.bvh", tmp_path / "out"
    loop.symlink_to(loop)
    out.mkdir()
    (out / "walk.bvh").symlink_to(out / "walk.bvh")

    for words in (
        ("convert", loop, folder / "walk.bvh", "--output-folder", out),
        ("index", tmp_path / "a.clips", loop, folder / "walk.bvh"),
        ("quality", loop, folder / "walk.bvh"),
    ):
        status, printed, failed = call(*words)
        assert (status, failed.count("\n")) == (2, 1), words
        assert "loop.bvh" in failed
        assert "walk.bvh" in printed or "1 clip" in printed
    assert read_bvh(out / "walk.bvh").n_frames == 30


def test_unreadable_file_does_not_stop_other_files(call, folder, tmp_path, monkeypatch):
    hidden = (folder / "more" / "walk.bvh").rename(folder / "more" / "hidden.bvh")
    named = (hidden, folder / "walk.bvh")
    for name in ("stat", "open"):  # As for a user without permission; root has it.
        monkeypatch.setattr(os, name, refusing(getattr(os, name), hidden))

    for words in (
        ("convert", *named, "--output-folder", tmp_path / "out"),
        ("index", tmp_path / "a.clips", *named),
    ):
        status, printed, failed = call(*words)
        assert (status, failed.count("\n")) == (2, 1), failed
        assert "ermission denied" in failed
    assert "1 clip" in printed


def test_line_breaks_in_names_are_printed_escaped(call, folder, tmp_path):
    odd = tmp_path / "odd\n\x1b[31mname"
    named(folder, b"b\n\x1b[31mc.bvh")
    folder.rename(odd)

    for words in (
        ("convert", odd, "--output-folder", tmp_path / "out"),
        ("quality", odd),
        ("index", tmp_path / "a\n\x1b[31m.clips", odd / "more", odd / "walk.bvh"),
        ("quality", odd / "none.bvh"),
        ("quality", tmp_path / "no\nfolder"),
    ):
        _, printed, failed = call(*words)
        assert "\x1b" not in printed + failed, words
        assert not [line for line in printed.splitlines() if line.startswith(("[31m", "name"))]
        assert failed.count("\n") <= 1 or words[0] == "index", failed


def refusing(work, closed):
    """Return what does the same, but for one file."""

    def do(path, *arguments, **options):
        if str(path) == str(closed):
            raise PermissionError(13, "Permission denied", str(path))
        return work(path, *arguments, **options)

    return do
