"""A claim keeps others from an output, and ends with the process that holds it."""

import errno
import json
import os

import pytest

from solvers.command_line.batches import parallel
from solvers.command_line.sharing import claimed, claims
from solvers.errors import FileAccessError


def test_waiting_makes_the_take_of_a_process_that_ends(call, leg_file, tmp_path, monkeypatch):
    out, waits = tmp_path / "out", []
    words = ["convert", leg_file, "--output-folder", out]
    call(*words)
    (record,) = out.glob(".mocap_assist/*.json")
    (out / "leg.bvh").unlink()
    claim = record.with_suffix(".1.claim")
    claim.write_text(json.dumps({"host": "render03", "machine": "render03", "pid": 1}))

    def end_the_other(seconds):
        waits.append(seconds)
        if len(waits) == 2:
            os.utime(claim, (0, 0))

    monkeypatch.setattr(parallel, "sleep", end_the_other)

    status, printed, err = call(*words, "--wait")

    assert (status, len(waits)) == (0, 2)
    assert err == "Waiting for takes on which other processes work: 1.\n"
    assert "Skipped" not in printed
    assert "120 frames" in printed
    assert (out / "leg.bvh").exists()
    assert not claim.exists()


def test_parts_of_claims_that_killed_processes_left_are_removed(call, leg_file, tmp_path):
    folder = tmp_path / "out" / ".mocap_assist"
    folder.mkdir(parents=True)
    names = [".0123456789abcdef.claim.part", "0123456789abcdef.time", "notes.time", ".x.part"]
    for name in [*names, ".fedcba9876543210.claim.part"]:
        (folder / name).touch()
    for name in names:
        os.utime(folder / name, (0, 0))

    assert call("convert", leg_file, "--output-folder", tmp_path / "out")[0] == 0

    assert {path.name for path in folder.iterdir() if path.suffix != ".json"} == {
        "notes.time", ".x.part", ".fedcba9876543210.claim.part",
    }  # fmt: skip


@pytest.mark.parametrize(("seconds", "holder"), [(290.0, "render03"), (310.0, "")])
def test_claim_of_another_machine_lasts_while_it_is_renewed(tmp_path, seconds, holder):
    claim = tmp_path / "take.1.claim"
    claim.write_text(json.dumps({"host": "render03", "machine": "render03", "pid": 1}))
    now = claim.stat().st_mtime
    os.utime(claim, (now - seconds, now - seconds))

    with claimed(tmp_path / "take") as first, claimed(tmp_path / "take") as second:
        assert first.holder == holder
        assert first.taken_over == (holder == "")
        assert second.holder

    assert [path.name for path in tmp_path.iterdir()] == (["take.1.claim"] if holder else [])


def test_claim_is_not_taken_over_with_one_that_is_made_meanwhile(tmp_path, monkeypatch):
    """A claim is seen as abandoned, then released by who took it over, and claimed again."""
    abandoned = tmp_path / "take.1.claim"
    abandoned.write_text(json.dumps({"host": "render03", "machine": "render03", "pid": 1}))
    os.utime(abandoned, (0, 0))
    second, third = claimed(tmp_path / "take"), claimed(tmp_path / "take")
    assert second.__enter__().taken_over
    is_abandoned = claims._is_abandoned

    def release_meanwhile(file, holder):
        found = is_abandoned(file, holder)
        if found:
            monkeypatch.setattr(claims, "_is_abandoned", is_abandoned)
            second.__exit__(None, None, None)
            assert not third.__enter__().holder
        return found

    monkeypatch.setattr(claims, "_is_abandoned", release_meanwhile)

    with claimed(tmp_path / "take") as fourth:
        assert fourth.holder

    assert [path.name for path in tmp_path.iterdir()] == ["take.1.claim"]
    third.__exit__(None, None, None)
    assert not list(tmp_path.iterdir())


def test_release_leaves_the_claim_that_a_successor_has_taken_over(tmp_path, monkeypatch):
    """Else a third process could claim the output on which the successor works."""
    monkeypatch.setattr(claims, "_is_abandoned", lambda file, _: file.name == "take.1.claim")
    with claimed(tmp_path / "take") as first:
        successor = claimed(tmp_path / "take")
        assert not first.holder and successor.__enter__().taken_over

    with claimed(tmp_path / "take") as third:
        assert third.holder
    successor.__exit__(None, None, None)
    assert not list(tmp_path.iterdir())


def test_release_leaves_the_claims_of_others(tmp_path):
    """The process stalled: its claim was taken over, released and made again by another one."""
    other = {"host": "render03", "machine": "render03", "pid": 1}
    with claimed(tmp_path / "take") as claim:
        assert not claim.holder
        (tmp_path / "take.1.claim").write_text(json.dumps(other))

    assert json.loads((tmp_path / "take.1.claim").read_text()) == other


def test_claim_never_stands_without_its_holder(tmp_path, monkeypatch):
    """A process killed at any moment leaves no claim without a holder."""
    claim, link, states = tmp_path / "take.1.claim", os.link, []

    def look(source, target):
        states.append(claim.exists())
        link(source, target)
        states.append(json.loads(claim.read_text())["pid"])

    monkeypatch.setattr(os, "link", look)
    with claimed(tmp_path / "take") as first:
        assert first.holder == ""

    assert states == [False, os.getpid()]
    assert not list(tmp_path.iterdir())


def test_claims_on_a_share_without_links(tmp_path, monkeypatch):
    def refuse(source, target):
        raise OSError(errno.EOPNOTSUPP, "Operation not supported")

    monkeypatch.setattr(os, "link", refuse)

    with claimed(tmp_path / "take") as first, claimed(tmp_path / "take") as second:
        assert first.holder == ""
        assert second.holder == os.uname().nodename

    assert not list(tmp_path.iterdir())


def test_claim_names_its_folder_when_the_disk_is_full(tmp_path, monkeypatch):
    def refuse(*_, **__):
        raise OSError(
            errno.ENOSPC, "No space left on device"
        )  # without a name, as `write` does

    monkeypatch.setattr(claims.Path, "write_text", refuse)

    with pytest.raises(FileAccessError) as error, claimed(tmp_path / "take"):
        pass

    assert str(error.value) == f"{tmp_path} cannot be written: the disk is full."
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "content", ["", "[]", '{"pid": "x"}', '{"host": 3, "pid": -1}', "\xff"]
)
def test_unreadable_claim_is_held(tmp_path, content):
    (tmp_path / "take.1.claim").write_text(content, encoding="latin-1")

    with claimed(tmp_path / "take") as claim:
        assert claim.holder

    assert (tmp_path / "take.1.claim").exists()
