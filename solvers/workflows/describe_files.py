"""Read files and describe them for a library, here or on workers."""

from collections import deque
from collections.abc import Iterable, Iterator
from concurrent.futures import BrokenExecutor, Future
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from ..faults import Failure, attempt
from ..processes import Workers
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
    has_crashed: bool = False
    """Whether the process that read it crashed."""


def describe_files(
    files: Iterable[ClipRequest], workers: Workers | None = None
) -> Iterator[FileDescription]:
    """Yield the description of each file, in the given order.

    A file that cannot be used is refused with one sentence. The other files are still read,
    even if reading one of them crashes its process. Results do not depend on the workers: what
    another machine refuses for a reason of its own, such as its memory, is read here.

    Parameters
    ----------
    files : ClipRequest, any number
    workers : Workers, optional
        Where to read them; by default in this process.
    """
    if workers is None:
        yield from map(describe_file, files)
        return
    waiting = deque(files)
    while waiting:
        for described in _until_crash(waiting, workers):
            is_refused_there = described.clip is None and not described.is_permanent
            again = is_refused_there and not described.has_crashed and workers.batch
            yield describe_file(described.request) if again else described


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


def _until_crash(waiting: "deque[ClipRequest]", workers: Workers) -> Iterator[FileDescription]:
    """Describe files and remove them from the queue until it is empty or a process crashes.

    After a crash the first file of the queue is read alone, which shows whether this file is
    the cause.
    """
    running: deque[Future[FileDescription]] = deque()
    with workers.open(len(waiting)) as executor:
        try:
            with suppress(BrokenExecutor):
                while waiting:
                    n_queued = QUEUED_PER_PROCESS * workers.n_processes()
                    for _ in range(min(n_queued, len(waiting))):
                        while len(running) < min(n_queued, len(waiting)):
                            request = waiting[len(running)]
                            running.append(executor.submit(describe_file, request))
                        done = running[0].result()
                        running.popleft()
                        waiting.popleft()
                        yield done
                return
        finally:
            executor.shutdown(cancel_futures=True)
    yield _describe_alone(waiting.popleft(), workers)


def _describe_alone(request: ClipRequest, workers: Workers) -> FileDescription:
    with workers.open(1) as executor:
        try:
            return executor.submit(describe_file, request).result()
        except BrokenExecutor:
            return FileDescription(
                request,
                None,
                f"{request.origin.path}: the process that read it crashed, perhaps for lack of"
                " memory. Split the take into parts.",
                has_crashed=True,
            )
