"""Whatever fails while one file is worked on is one sentence about that file."""

import re
from pathlib import Path

import pytest

from solvers.errors import FileAccessError, InvalidFileError, SolveCancelled
from solvers.faults import Failure, attempt, escaped
from solvers.motion import Skeleton

SUBJECT = Path("takes") / "walk.bvh"


def failing(error: BaseException):
    def work() -> None:
        raise error

    return work


def test_attempt_returns_what_the_work_returns():
    assert attempt(SUBJECT, divmod, 7, 2) == (3, 1)


@pytest.mark.parametrize(
    ("error", "sentence", "lasting"),
    [
        (InvalidFileError("walk.bvh is damaged."), "walk.bvh is damaged.", True),
        (InvalidFileError("It is damaged."), f"{SUBJECT}: It is damaged.", True),
        (FileAccessError("walk.bvh cannot be read."), "walk.bvh cannot be read.", False),
        (OSError(5, "Input/output error"), f"{SUBJECT}: Input/output error.", False),
        (OSError(28, "No space left", "out.bvh"), "out.bvh: the disk is full.", False),
        (OSError("odd"), f"{SUBJECT}: odd.", False),
        (MemoryError(), f"{SUBJECT} needs more memory than is available; work on a part of the"
         " take.", False),
    ],
)  # fmt: skip
def test_attempt_names_the_file_and_the_reason_when_the_work_fails(error, sentence, lasting):
    failure = attempt(SUBJECT, failing(error))

    assert (failure.sentence, failure.lasting, failure.is_fault) == (sentence, lasting, False)


@pytest.mark.parametrize(
    "error", [IndexError("7"), OverflowError(), RecursionError(), KeyError()]
)
def test_attempt_reports_a_fault_of_ours_when_the_work_raises_anything_else(error):
    failure = attempt(SUBJECT, failing(error))

    name = type(error).__name__
    assert re.fullmatch(
        rf"{re.escape(str(SUBJECT))}: this is a bug in Mocap Assist \({name} at \S+:\d+\);"
        r" please report it\.",
        failure.sentence,
    )
    assert failure.is_fault and "in work" in failure.details
    assert failure.as_error().__notes__ == [failure.details]


def test_a_fault_is_located_in_our_code_when_a_library_raised_it():
    failure = attempt(SUBJECT, Skeleton, ("a",), (-1,), "no offsets")

    assert re.search(r"\(\w+ at solvers/motion/\w+/\w+\.py:\d+\)", failure.sentence)


@pytest.mark.parametrize("error", [SolveCancelled(), KeyboardInterrupt(), SystemExit()])
def test_attempt_propagates_cancellation_and_exit(error):
    with pytest.raises(type(error)):
        attempt(SUBJECT, failing(error))


def test_a_sentence_is_valid_unicode_when_the_name_of_the_file_is_not():
    name = b"caf\xe9.bvh".decode("utf-8", "surrogateescape")

    failure = attempt(name, failing(ValueError()))

    assert isinstance(failure, Failure)
    assert failure.sentence.encode().startswith(rb"caf\udce9.bvh: this is a bug")
    assert escaped("ü") == "ü"
    assert escaped("walk\u202ehvb.exe \u2066") == "walk\\u202ehvb.exe \\u2066"
