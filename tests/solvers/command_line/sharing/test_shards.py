"""Shards divide a batch: each take is in one of them, and stays there."""

import shutil
import sys

import pytest

from solvers.command_line.sharing import Shard


def test_shards_are_disjoint_and_complete_and_do_not_move():
    names = [f"day{number % 5}/take {number} é.bvh" for number in range(500)]
    shards = [Shard(number, 7) for number in range(1, 8)]

    parts = [[name for name in names if shard.has(name)] for shard in shards]

    assert sorted(name for part in parts for name in part) == sorted(names)
    assert all(30 < len(part) < 120 for part in parts)
    assert [name for name in names if Shard(1, 1).has(name)] == names
    # On another machine, in another year: NFD as on macOS, and the same numbers forever.
    parts = [Shard(number, 997) for number in range(1, 998)]
    composed, decomposed = (
        [part.has(f"caf{e}.bvh") for part in parts] for e in ("é", "e\u0301")
    )
    assert composed == decomposed
    numbers = [[s.has(name) for s in shards].index(True) + 1 for name in ("a.bvh", "b/c.bvh")]
    assert numbers == [3, 5]


def test_added_take_leaves_the_others_in_their_shards(call, small_batch, tmp_path, records_in):
    words = ["convert", small_batch, "--shard", "2/3", "--output-folder"]
    call(*words, tmp_path / "before")
    for name in ("a.bvh", "take05b.bvh", "take10.csv.bvh"):
        shutil.copy(small_batch / "take00.bvh", small_batch / name)

    call(*words, tmp_path / "after")

    before, after = (set(records_in(tmp_path / name)) for name in ("before", "after"))
    assert before
    assert after - before <= {"a.bvh", "take05b.bvh", "take10.csv.bvh"}
    assert before <= after


def test_part_without_a_take_says_so(call, leg_file, tmp_path):
    words = ["convert", leg_file, "--output-folder", tmp_path / "out", "--shard"]

    ends = [call(*words, f"{number}/2") for number in (1, 2)]

    assert [status for status, _, _ in ends] == [0, 0]
    texts = sorted((printed, err) for _, printed, err in ends)
    sentence = "No take is in part 2 of 2; takes in all parts: 1.\n"
    assert texts[0] in {("", sentence), ("", sentence.replace("2 of", "1 of"))}
    assert "120 frames" in texts[1][0] and not texts[1][1]


@pytest.mark.parametrize("word", ["0/3", "4/3", "1", "1/0", "a/b", "-1/3", "1/3/5", "1/"])
def test_impossible_shard_is_one_sentence(call, leg_file, tmp_path, word):
    status, _, err = call(
        "convert", leg_file, "--output-folder", tmp_path / "out", f"--shard={word}"
    )

    assert (status, err.count("\n")) == (2, 1)
    assert "is no part of a batch; write I/N with I from 1 to N" in err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    "option", ["--shard=1/2", "--manifest=x.txt", f"--after={sys.executable}"]
)
def test_options_of_batches_need_a_folder(call, leg_file, tmp_path, option):
    status, _, err = call("convert", leg_file, tmp_path / "out.bvh", option)

    name = option.partition("=")[0]
    assert (status, err) == (2, f"{name} needs a folder: name it with --output-folder DIR.\n")
