"""Lists of inputs, and commands that run after each take."""

import json
import os
import shutil
import subprocess
import sys

import pytest

from solvers.command_line.sharing.hooks import words_of_hook

PYTHON = sys.executable
WRITER = "import sys; open(sys.argv[1], 'w').write('a.bvh\\n')"


@pytest.fixture
def folder(leg_file, tmp_path):
    """A folder with `a.bvh` and `day 2/a.bvh`."""
    (tmp_path / "list" / "day 2").mkdir(parents=True)
    for name in ("a.bvh", "day 2/a.bvh"):
        shutil.copy(leg_file, tmp_path / "list" / name)
    return tmp_path / "list"


def made_in(out):
    return {path.relative_to(out).as_posix() for path in out.rglob("*.bvh")}


def record_in(out, name):
    (file,) = out.glob(f".mocap_assist/{name}.*.json")
    return json.loads(file.read_text())


@pytest.mark.parametrize(
    ("name", "text", "made"),
    [
        ("m.txt", "a.bvh\n\n  day 2/a.bvh\r\n", {"a.bvh", "day 2/a.bvh"}),
        ("m.txt", "\ufeffday 2\n", {"day 2/a.bvh"}),
        ("m.txt", '{"input": "a.bvh", "output": "x/b.bvh"}', {"x/b.bvh"}),
        ("m.json", '["a.bvh",\n {"input": "day 2/a.bvh"}]', {"a.bvh", "day 2/a.bvh"}),
        ("m.jsonl", '{"input": "../leg.bvh"}\n', {"leg.bvh"}),
    ],
)  # fmt: skip
def test_manifest_names_the_inputs(call, folder, tmp_path, name, text, made):
    (folder / name).write_text(text, encoding="utf-8", newline="")

    status, _, err = call(
        "convert", "--manifest", folder / name, "--output-folder", tmp_path / "out"
    )

    assert (status, err) == (0, "")
    assert made_in(tmp_path / "out") == made


@pytest.mark.parametrize(
    ("name", "text", "reason"),
    [
        ("m.txt", "a.bvh\nb.bvh\n", "line 2: there is no file {folder}/b.bvh."),
        ("m.txt", 'a.bvh\n{"input": "a.bvh"', "line 2: it is not JSON (Expecting"),
        ("m.txt", 'a.bvh\n\n{"output": "a.bvh"}', "line 3: it must be a path, or"),
        ("m.txt", '{"input": "a.bvh", "speed": 2}', "line 1: it must be a path, or"),
        ("m.txt", '{"input": "a.bvh", "output": "../b.bvh"}', "1: the output ../b.bvh is"),
        ("m.txt", '{"input": "a.bvh", "output": "/tmp/b.bvh"}', "1: the output /tmp/b.bvh is"),
        ("m.txt", '{"input": "day 2", "output": "b.bvh"}', "a folder, and has many outputs."),
        ("m.txt", '{"input": 3}', "line 1: input and output must be paths."),
        ("m.txt", "a.bvh\ncaf\udce9.bvh", "line 2: it is not UTF-8 text."),
        ("m.txt", "\n \n", "names no recording."),
        ("m.json", '["a.bvh",\n"a.bvh"', "line 2: it is not JSON ("),
        ("m.json", '{"input": "a.bvh"}', "line 1: it must be a list [...]."),
        ("m.json", '["a.bvh", null]', "entry 2: it must be a path, or"),
        ("m.json", "[" * 5000, "it is not JSON ("),
    ],
)  # fmt: skip
def test_broken_manifest_is_one_sentence_and_nothing_starts(
    call, folder, tmp_path, name, text, reason
):
    (folder / name).write_bytes(text.encode("utf-8", "surrogateescape"))

    status, printed, err = call(
        "convert", "--manifest", folder / name, "--output-folder", tmp_path / "out"
    )

    assert (status, printed, err.count("\n")) == (2, "", 1)
    assert err.startswith(f"The manifest {folder / name}")
    assert reason.format(folder=folder) in err
    assert not (tmp_path / "out").exists()


def test_missing_manifest_and_no_input_are_one_sentence(call, folder, tmp_path):
    out = tmp_path / "out"

    missing = call("convert", "--manifest", folder / "none.txt", "--output-folder", out)
    nothing = call("convert", "--output-folder", out)

    assert missing[2] == (
        f"The manifest {folder / 'none.txt'} cannot be read: No such file or directory.\n"
    )
    assert nothing[2].startswith("Name recordings to read, or folders of them, or a list")
    assert (missing[0], nothing[0], out.exists()) == (2, 2, False)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such device")
def test_manifest_that_never_ends_is_refused(call, tmp_path):
    """It filled the memory."""
    status, _, err = call(
        "convert", "--manifest", "/dev/zero", "--output-folder", tmp_path / "out"
    )

    assert status == 2
    sentence = "The manifest /dev/zero cannot be read: it has more than 16 MiB; divide it.\n"
    assert err == sentence


def test_two_entries_with_one_output_are_refused(call, folder, tmp_path):
    (folder / "m.txt").write_text('{"input": "day 2/a.bvh", "output": "a.bvh"}\na.bvh\n')

    status, _, err = call(
        "convert", "--manifest", folder / "m.txt", "--output-folder", tmp_path / "out"
    )

    assert (status, err.count("\n")) == (2, 1)
    assert "Two inputs would both be written to" in err


def test_take_that_is_named_twice_is_refused(call, folder, tmp_path):
    (folder / "m.txt").write_text("a.bvh\nday 2/a.bvh\na.bvh\n")
    words = ["convert", "--manifest", folder / "m.txt", "--output-folder", tmp_path / "out"]

    assert call(*words) == (2, "", f"{folder / 'a.bvh'} is named twice. Name it once.\n")


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such pipes")
def test_terminal_says_that_a_pipe_is_awaited(call, folder, tmp_path, monkeypatch):
    pipe = folder / "pipe"
    os.mkfifo(pipe)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)

    with subprocess.Popen([PYTHON, "-c", WRITER, str(pipe)]):
        status, _, err = call(
            "convert", "--manifest", pipe, "--output-folder", tmp_path / "out"
        )

    assert status == 0
    assert err.startswith(f"Reading the manifest {pipe}, a pipe, until its writer closes it.\n")
    assert made_in(tmp_path / "out") == {"a.bvh"}


def test_hook_gets_the_files_as_single_words(call, folder, tmp_path):
    out, odd = tmp_path / "out", folder / "day 2" / "{output} $(touch x) 'a.bvh"
    (folder / "day 2" / "a.bvh").rename(odd)
    hook = f"{PYTHON} -c 'import json, sys; print(json.dumps(sys.argv[1:]))'"

    status, _, _ = call(
        "convert",
        odd,
        "--output-folder",
        out,
        "--after",
        hook + " {input} is={output} {record}",
    )

    (file,) = out.glob(".mocap_assist/*.json")
    after = json.loads(file.read_text())["after"]
    assert (status, after["status"]) == (0, 0)
    assert json.loads(after["output"]) == [str(odd), f"is={out / odd.name}", str(file)]


def test_failed_hook_marks_the_take_keeps_the_output_and_runs_again(call, folder, tmp_path):
    out, flag = tmp_path / "out", tmp_path / "flag"
    code = f"import os, sys; sys.exit(0 if os.path.exists({str(flag)!r}) else 'no server')"
    words = ["convert", folder / "a.bvh", "--output-folder", out, "--report"]
    words += ["--after", f'{PYTHON} -c "{code}"']

    status, _, err = call(*words)

    sentence = "The command of --after failed with status 1: no server."
    assert (status, err) == (2, f"{folder / 'a.bvh'}: {sentence}\n")
    assert made_in(out) == {"a.bvh"}
    assert record_in(out, "a.bvh")["remarks"] == [sentence]
    assert record_in(out, "a.bvh")["after"]["output"] == "no server\n"
    assert json.loads((out / "report.json").read_text())["files"][0]["remarks"] == [sentence]
    assert sentence in (out / "report.html").read_text()
    status, printed, err = call("report", out)
    assert (status, err) == (2, f"{folder / 'a.bvh'}: {sentence}\n")
    assert printed.endswith("1 done, 0 failed\n")

    flag.touch()
    date = (out / "a.bvh").stat().st_mtime_ns
    again, last = call(*words), call(*words)

    assert (again[0], again[2], last[0]) == (0, "", 0)
    assert call("report", out)[0] == 0
    assert "Already made." in again[1] and "Already made." in last[1]
    assert (out / "a.bvh").stat().st_mtime_ns == date
    assert (record_in(out, "a.bvh")["remarks"], record_in(out, "a.bvh")["after"]["status"]) == (
        [],
        0,
    )


@pytest.mark.parametrize(
    ("command", "windows", "words"),
    [(r"C:\tools\publish.exe {output}", True, [r"C:\tools\publish.exe", "{output}"]),
     (r'"C:\My Tools\p.exe" --to="D:\a b" #1', True,
      [r"C:\My Tools\p.exe", r"--to=D:\a b", "#1"]),
     (r"pub\ lish 'a b' #1", False, ["pub lish", "a b", "#1"])],
)  # fmt: skip
def test_words_of_a_hook_are_those_of_the_system(command, windows, words):
    assert words_of_hook(command, windows) == words


@pytest.mark.parametrize(
    ("command", "reason"),
    [("'a", "is no command: no closing quotation"), ("", "there is no program ''"),
     ("no_such_program {output}", "there is no program 'no_such_program'")],
)  # fmt: skip
def test_impossible_hook_is_one_sentence(call, folder, tmp_path, command, reason):
    status, _, err = call(
        "convert", folder, "--output-folder", tmp_path / "out", "--after", command
    )

    assert (status, err.count("\n")) == (2, 1)
    assert reason in err.lower() or reason in err
    assert not (tmp_path / "out").exists()
