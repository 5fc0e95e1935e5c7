"""`blender FILE --command mocap_assist index ...` and `find`."""

import json

import pytest


def lines_of(out):
    return [json.loads(line) for line in out.splitlines() if line.startswith("{")]


def test_find_command_finds_indexed_clips(command, newcomer, blend_file, clip_files, tmp_path):
    library = tmp_path / "all.library"

    status, out, err = command(
        "index", clip_files, blend_file, "--library", library, "--tag", "hall", "--json"
    )
    assert (status, err) == (0, "")
    assert [lines_of(out)[0][name] for name in ("n_clips", "read")] == [9, 9]

    newcomer("wave")
    status, out, err = command("find", "--library", library, "--json", "--n-matches", "3")
    assert (status, err) == (0, "")
    (message,) = lines_of(out)
    assert len(message["matches"]) == 3
    assert {match["clip"] for match in message["matches"]} == {
        "wave_0",
        "wave_1",
        "shot/wave_0",
    }
    assert message["matches"][0]["tags"][0] == "hall"

    status, out, _ = command("find", "--library", library)
    assert status == 0 and "Most similar to" in out and "shot/wave_0" in out


def test_unreadable_files_are_reported_and_others_are_indexed(command, clip_files, tmp_path):
    (clip_files / "cut.bvh").write_bytes((clip_files / "walk_0.bvh").read_bytes()[:900])
    target = tmp_path / "index.json"

    status, _, err = command(
        "index", clip_files, "--library", tmp_path / "a.library", "--json", target
    )

    assert status == 2 and "cut.bvh" in err
    assert json.loads(target.read_text())["n_clips"] == 6


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["index"], "No sources given"),
        (["index", "nowhere"], "There is no file or folder"),
        (["find", "--library", "none.library"], "There is no clip library"),
    ],
)
def test_wrong_arguments_give_one_message(
    command, newcomer, words, message, tmp_path, monkeypatch
):
    newcomer("walk")
    monkeypatch.chdir(tmp_path)
    if words[0] == "index":
        words = [*words, "--library", "b.library"]

    status, _, err = command(*words)

    assert status == 2 and message in err and err.count("\n") == 1
