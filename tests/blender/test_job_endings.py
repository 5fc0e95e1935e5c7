"""How the process of a solve ends: cleanly, noticed at once, and whatever the machine lacks."""

import sys
from functools import partial

import pytest

ANSWER_AND_HANG = """
import pickle, sys, time
from pathlib import Path
part = Path(sys.argv[1], "part")
answer = pickle.dumps(("the answer",))
part.write_bytes(len(answer).to_bytes(8, "little") + answer)
part.replace(Path(sys.argv[1], "result"))
time.sleep(60)
"""
FULL_DISK = """
import errno, os, pickle, runpy, sys
def no_room(*_, **__):
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
pickle.dumps = no_room
sys.argv = sys.argv[1:]
runpy.run_path(sys.argv[0], run_name="__main__")
"""


class Expression:
    """A function that can be sent to the child, which cannot import this file."""

    def __init__(self, text):
        self.text = text

    def __call__(self, *_, **__):
        raise AssertionError("It was called in this process.")

    def __reduce__(self):
        return eval, (self.text,)


@pytest.fixture
def module(load):
    return load("mocap_assist.jobs.job")


@pytest.fixture
def programs(load, module):
    """The commands that run a solve: a bare Python, and a background Blender."""
    in_blender = load("mocap_assist.jobs.in_blender")
    return {"bare": (), "in a Blender": in_blender.BackgroundBlender("").command()}


@pytest.fixture(autouse=True)
def own_temporary_folder(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))


@pytest.mark.parametrize("program", ["bare", "in a Blender"])
@pytest.mark.parametrize("showing", [False, True])
def test_process_ends_with_status_0_after_its_answer(module, load, programs, program, showing):
    begin = "__import__('bpy') and " if program == "in a Blender" else ""
    solve = partial(Expression(f"lambda progress: {begin}progress(0.5) or 'the answer'"))
    if showing:
        text = f"lambda progress, show: {begin}show('a pose') or 'the answer'"
        solve = load("mocap_assist.jobs.protocol").PreviewSolve(Expression(text))
    job = module.Job(solve, programs[program])

    status = job._child.process.wait()

    assert (status, job.new_previews()) == (0, ["a pose"] if showing else [])
    assert job.result() == "the answer"


@pytest.mark.parametrize("program", ["bare", "in a Blender"])
def test_process_ends_with_status_0_after_an_error_of_the_solver(module, programs, program):
    job = module.Job(Expression("lambda progress: 1 / 0"), programs[program])

    assert job._child.process.wait() == 0
    with pytest.raises(ZeroDivisionError) as caught:
        job.result()
    assert "Traceback" in caught.value.__notes__[0]


def test_hanging_process_is_ended_after_its_result_is_read(module):
    job = module.Job(Expression("None"), (sys.executable, "-c", ANSWER_AND_HANG))
    while not job.done():
        pass

    assert job.result() == "the answer"
    assert job._child.process.returncode not in {None, 0}
    assert not job._path.exists()


@pytest.mark.parametrize("call", ["Job", "run", "ShortSolve"])
def test_out_of_memory_is_one_sentence(module, load, call):
    solve = Expression("lambda progress: b'.' * (1 << 62)")
    calls = {
        "Job": lambda: module.Job(solve).result(),
        "run": lambda: module.run(solve),
        "ShortSolve": lambda: module.run(module.ShortSolve(eval(solve.text))),
    }

    with pytest.raises(
        load("solvers.errors").OutOfMemoryError, match="more memory than is available"
    ):
        calls[call]()


def test_full_disk_is_one_sentence_when_the_answer_does_not_fit(module, load, tmp_path):
    program = (
        sys.executable,
        "-c",
        FULL_DISK,
        str(load("mocap_assist.jobs.child_process").CHILD),
    )

    with pytest.raises(load("solvers.errors").MocapAssistError, match="disk is full") as caught:
        module.Job(Expression("lambda progress: 1"), program).result()

    assert str(tmp_path) in str(caught.value)


def test_full_disk_is_one_sentence_when_the_request_does_not_fit(
    module, load, tmp_path, monkeypatch
):
    def no_room(*_):
        raise OSError(28, "No space left on device", "request")

    monkeypatch.setattr(module, "write_value", no_room)

    with pytest.raises(load("solvers.errors").MocapAssistError, match="the disk is full"):
        module.Job(Expression("None"))
    assert not list(tmp_path.iterdir())


def test_temporary_folder_that_cannot_be_written_is_one_sentence(
    module, load, tmp_path, monkeypatch
):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "gone"))

    with pytest.raises(load("solvers.errors").MocapAssistError, match="Temporary files cannot"):
        module.Job(Expression("None"))
