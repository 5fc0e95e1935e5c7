"""Read files and describe them for a library, sequentially or in parallel."""

from collections import deque
from collections.abc import Iterable, Iterator
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from ..faults import Failure, attempt
from ..processes import worker_pool
from ..recordings import read_tracked
from ..retrieval import Clip, DescribedClip, Origin, describe_clip

QUEUED_PER_PROCESS = 2
"""Number of files submitted to each process before their results are fetched. It bounds the
memory; with one, a process would wait for the next file."""


class ClipRequest(NamedTuple):
    """A file to index as a clip."""

    name: str
    origin: Origin
    tags: tuple[str, ...]


class FileDescription(NamedTuple):
    """The description of a file, or why there is none."""

    request: ClipRequest
    clip: DescribedClip | None
    """None if the file was refused."""
    sentence: str = ""
    is_permanent: bool = False
    """Whether the content is the reason: the file is refused again until it changes."""


def describe_files(
    files: Iterable[ClipRequest], jobs: int, n_threads: int = 1
) -> Iterator[FileDescription]:
    """Yield the description of each file, in the given order.

    A file that cannot be used is refused with one sentence. The other files are still read,
    even if reading one of them crashes its process.
    """
    if jobs <= 1:
        yield from map(describe_file, files)
        return
    waiting = deque(files)
    while waiting:
        yield from _until_crash(waiting, jobs, n_threads)


def describe_file(request: ClipRequest) -> FileDescription:
    """Read and describe one file."""
    path = request.origin.path
    found = attempt(path, _describe, request)
    if not isinstance(found, Failure):
        return FileDescription(request, found)
    reason = found.sentence.removeprefix(f"{path}: ").removeprefix(f"{request.name}: ")
    names_file = Path(path).name in reason
    sentence = reason if names_file else f"{path}: {reason}"
    return FileDescription(request, None, sentence, is_permanent=found.lasting)


def _describe(request: ClipRequest) -> DescribedClip:
    recording = read_tracked(request.origin.path, body=request.origin.item)
    return describe_clip(Clip(request.name, recording, request.tags, request.origin))


def _until_crash(
    waiting: "deque[ClipRequest]", jobs: int, n_threads: int
) -> Iterator[FileDescription]:
    """Describe files and remove them from the queue until it is empty or a process crashes.

    After a crash the first file of the queue runs in a process of its own, which shows
    whether this file is the cause.
    """
    running: deque[Future[FileDescription]] = deque()
    with worker_pool(jobs, n_threads) as pool:
        try:
            with suppress(BrokenProcessPool):
                while waiting:
                    while len(running) < min(len(waiting), QUEUED_PER_PROCESS * jobs):
                        running.append(pool.submit(describe_file, waiting[len(running)]))
                    done = running[0].result()
                    running.popleft()
                    waiting.popleft()
                    yield done
                return
        finally:
            pool.shutdown(cancel_futures=True)
    yield _describe_in_new_process(waiting.popleft(), n_threads)


def _describe_in_new_process(request: ClipRequest, n_threads: int) -> FileDescription:
    with worker_pool(1, n_threads) as pool:
        try:
            return pool.submit(describe_file, request).result()
        except BrokenProcessPool:
            return FileDescription(
                request,
                None,
                f"{request.origin.path}: the process that read it crashed, perhaps for lack of"
                " memory. Split the take into parts.",
            )
