"""Files are described in order, whatever happens to one of them."""

import os
from concurrent.futures import ThreadPoolExecutor
from threading import current_thread, main_thread

import pytest

from solvers.errors import SolveCancelled
from solvers.processes import LocalWorkers
from solvers.recordings import write_bvh
from solvers.retrieval import Origin
from solvers.samples import GaitSettings, walking_gait
from solvers.workflows import describe_files as describing
from solvers.workflows.describe_files import ClipRequest, describe_file, describe_files


class Deadly:
    """What ends the process that unpickles it."""

    def __reduce__(self):
        return os._exit, (1,)


@pytest.fixture
def clip_request(tmp_path):
    """Four walks."""
    found = []
    for number in range(4):
        path = tmp_path / f"{number}.bvh"
        settings = GaitSettings(duration=1.0 + number, frame_rate=30.0)
        write_bvh(walking_gait(settings), path)
        found.append(ClipRequest(f"clip {number}", Origin(str(path)), ("walk",)))
    return found


def test_file_becomes_a_library_entry(clip_request):
    _, clip, sentence, *_ = describe_file(clip_request[1])
    assert (clip.entry.name, clip.entry.tags, clip.entry.n_frames) == ("clip 1", ("walk",), 60)
    assert clip.entry.origin == clip_request[1].origin
    assert (clip.postures.n_frames, clip.postures.frame_rate, sentence) == (40, 20.0, "")


def test_file_that_crashes_its_process_is_refused_and_others_are_described(clip_request):
    deadly = clip_request[1]._replace(tags=(Deadly(),))

    found = list(
        describe_files([clip_request[0], deadly, *clip_request[2:]], LocalWorkers(2, 1))
    )

    assert [one.request.name for one in found] == [f"clip {number}" for number in range(4)]
    assert [one.clip is None for one in found] == [False, True, False, False]
    assert found[1].sentence.startswith(
        f"{clip_request[1].origin.path}: the process that read it crashed"
    )


def test_file_that_another_machine_cannot_read_is_read_here(clip_request, monkeypatch):
    read = describing.read_tracked

    def fail_elsewhere(path, **body):
        if current_thread() is not main_thread():
            raise MemoryError
        return read(path, **body)

    class Elsewhere(LocalWorkers):
        def open(self, n_tasks):
            return ThreadPoolExecutor(1)

    monkeypatch.setattr(describing, "read_tracked", fail_elsewhere)
    for batch, is_described in (("", False), ("batch", True)):
        (found,) = describe_files(clip_request[:1], Elsewhere(1, 1, batch))
        assert (found.clip is not None) == is_described


def test_error_is_one_sentence_with_the_file(clip_request, tmp_path, monkeypatch):
    gone = ClipRequest("gone", Origin(str(tmp_path / "gone.bvh")), ())
    assert describe_file(gone).sentence == f"There is no file {tmp_path / 'gone.bvh'}."

    for error, ending in (
        (MemoryError(), "needs more memory than is available; work on a part of the take."),
        (OSError(5, "Input/output error"), ": Input/output error."),
    ):

        def fail(path, error=error, **body):
            raise error

        monkeypatch.setattr(describing, "read_tracked", fail)
        sentence = describe_file(clip_request[0]).sentence
        assert sentence.startswith(clip_request[0].origin.path)
        assert sentence.endswith(ending)


def test_cancellation_is_no_refusal(clip_request, monkeypatch):
    def cancel(path, **body):
        raise SolveCancelled

    monkeypatch.setattr(describing, "read_tracked", cancel)
    with pytest.raises(SolveCancelled):
        list(describe_files(clip_request))
