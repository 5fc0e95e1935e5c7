"""Readers that fail or die, and what readers say: import from a window, and by a script."""

from pathlib import Path

import pytest
from modal_events import nothing_is_left, wait

DEADLY = b"deadly"
READ = """
(lambda reading, os: lambda paths, wanted, *, progress: (
    os.abort() if any({deadly!r} in path.read_bytes()[:9] for path in paths)
    else reading.read_files(paths, wanted, progress=progress)
))(__import__("importlib").import_module({reading!r}), __import__("os"))
"""
UNEVEN = [f"{frame / 30 + 0.002 * (frame % 3)},1,2,{frame},1,1,1" for frame in range(40)]
LATE = "\n".join(["mocap-assist-joints,1,units=m", "time,A.x,A.y,A.z,B.x,B.y,B.z", *UNEVEN, ""])


class DyingReader:
    """What reads files in the other process, which cannot import this file."""

    def __init__(self, reading):
        self.reading = reading

    def __call__(self, *_, **__):
        raise AssertionError("It was read in this process.")

    def __reduce__(self):
        text = READ.format(deadly=DEADLY, reading=self.reading)
        return eval, ("".join(text.splitlines()),)


@pytest.fixture
def dying(load, monkeypatch):
    """Files that begin with a certain word end the process that reads them."""
    reading = load("mocap_assist.importing.solve_reading")
    monkeypatch.setattr(
        load("mocap_assist.importing.dialog.job"), "read_files", DyingReader(reading.__name__)
    )


def test_a_reader_that_dies_once_takes_no_file_along(press, window, blank):
    operator = press("first.bvh", "second.bvh")

    operator._job.job._child.process.kill()

    assert wait(operator, window) == {"FINISHED"}
    assert sorted(blank.data.objects.keys()) == ["first", "second"]
    ((kind, message),) = window.reports
    assert kind == {"INFO"} and "crashed" not in message
    assert nothing_is_left(window)


@pytest.mark.parametrize("deadly", [["c.bvh"], ["a.bvh", "e.bvh"]])
def test_files_that_end_their_reader_are_named_and_the_others_come(
    dying, deadly, press, window, walks, blank
):
    names = [f"{letter}.bvh" for letter in "abcde"]
    for name in names:
        content = DEADLY if name in deadly else (walks / "first.bvh").read_bytes()
        (walks / name).write_bytes(content)
    operator = press(*names)

    assert wait(operator, window) == {"FINISHED"}

    good = [Path(name).stem for name in names if name not in deadly]
    assert sorted(blank.data.objects.keys()) == good
    ((kind, message),) = window.reports
    assert kind == {"ERROR"} and message.startswith(f"{len(deadly)} of 5 files failed.")
    for name in deadly:
        assert f"Reading {walks / name} crashed: signal SIGABRT" in message
    assert message.count("crashed") == len(deadly) and "Nothing was changed" not in message
    assert nothing_is_left(window)
    percentages = [float(text.split("%")[0].split()[-1]) for text in window.status if text]
    assert percentages == sorted(percentages)


def test_where_all_end_their_reader_the_scene_stays(dying, press, window, walks, blank):
    for name in ("first.bvh", "second.bvh"):
        (walks / name).write_bytes(DEADLY)

    assert wait(press("first.bvh", "second.bvh"), window) == {"CANCELLED"}

    assert not blank.data.objects
    assert nothing_is_left(window)


@pytest.mark.parametrize("fault", [RecursionError("too deep"), ValueError("0"), MemoryError()])
def test_a_fault_of_a_reader_keeps_no_other_file_out(load, walks, monkeypatch, fault):
    reading = load("mocap_assist.importing.solve_reading")
    open_as = reading.open_as

    def fail(path, *settings, **more):
        if path.name == "cut.bvh":
            raise fault
        return open_as(path, *settings, **more)

    monkeypatch.setattr(reading, "open_as", fail)
    paths = [walks / name for name in ("first.bvh", "cut.bvh", "second.bvh")]

    (first,), refusal, (second,) = reading.read_files(
        paths, reading.Conversion(True, 1.0, None)
    )

    assert first.content.recording.n_frames == second.content.recording.n_frames == 317
    assert isinstance(refusal, load("solvers.errors").InvalidFileError)
    assert str(walks / "cut.bvh") in str(refusal)
    if not isinstance(fault, MemoryError):
        assert f"this is a bug in Mocap Assist ({type(fault).__name__} at" in str(refusal)
        assert "in fail" in refusal.__notes__[0]


def test_one_blender_reads_all_scene_files_but_one_that_kills_it(load, tmp_path, monkeypatch):
    scenes = load("mocap_assist.importing.solve_scenes")
    starts = []

    def read(blender, paths, **_):
        starts.append(len(paths))
        if any("deadly" in path for path in paths):
            raise load("mocap_assist.jobs.job").ProcessDied("signal SIGSEGV", "")
        return [Path(path).stem for path in paths]

    monkeypatch.setattr(scenes, "read_blends", read)
    paths = [tmp_path / f"{name}.fbx" for name in ("a", "b", "c", "deadly")]

    assert scenes.read_scenes(paths[:3], None) == ["a", "b", "c"]
    *others, refusal = scenes.read_scenes(paths, None)

    assert others == ["a", "b", "c"]
    assert "SIGSEGV" in str(refusal)
    assert starts == [3, 4, 2, 2, 1, 1]


def test_a_fault_over_one_file_leaves_the_others_in_the_scene(load, walks, blank, monkeypatch):
    transaction = load("mocap_assist.importing.transaction")
    real = transaction.make_objects

    def fail(context, name, *words, **more):
        made = real(context, name, *words, **more)
        if name == "first":
            raise IndexError
        return made

    monkeypatch.setattr(transaction, "make_objects", fail)
    importing = load("mocap_assist.importing.importing")
    choices = load("mocap_assist.importing.button_settings").ImportChoices()

    imported = importing.import_files(
        blank.context, [walks / "first.bvh", walks / "second.bvh"], choices
    )

    assert sorted(blank.data.objects.keys()) == ["second"]
    (sentence,) = imported.failed
    assert "first.bvh: this is a bug in Mocap Assist (IndexError at" in sentence


def test_warnings_of_readers_are_reported_in_a_window_and_by_a_script(
    press, window, walks, blank
):
    (walks / "late.csv").write_text(LATE)
    operator = press("late.csv", "first.bvh")

    assert wait(operator, window) == {"FINISHED"}

    ((_, message),) = window.reports
    assert "40 frames at 30 Hz. " in message
    assert message.count("Resampled to 30 Hz from its time stamps. ") == 1
    assert operator.note == message
    figures = operator._job.transaction.end(blank.context).figures
    assert figures[0]["warnings"].startswith("Resampled to 30 Hz from its time stamps.")
    assert not figures[1]["warnings"]
    for _ in range(2):  # read, or remembered
        operator.execute(blank.context)
        assert window.reports[-1][1].count("Resampled to 30 Hz from its time stamps.") == 1
