"""Read files and describe them for a library, here or on workers."""

from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future
from contextlib import suppress
from itertools import islice
from pathlib import Path
from typing import NamedTuple

from ..faults import Failure, attempt
from ..processes import Workers
from ..recordings import read_tracked
from ..retrieval import Clip, DescribedClip, Origin, describe_clip

QUEUED_PER_PROCESS = 2
"""Number of tasks submitted to each process before their results are fetched. It bounds the
memory; with one, a process would wait for the next file."""
FILES_PER_REMOTE_TASK = 8
"""Files of one task for workers of a cluster. It bounds the time that the writer spends on
sending and receiving; a crash costs the other files of its task a second reading."""


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

    After a crash the files of the first task are read alone, which shows whether one of them
    is the cause.
    """
    running: deque[tuple[int, Future[list[FileDescription]]]] = deque()
    with workers.open(len(waiting)) as executor:
        try:
            with suppress(BrokenExecutor):
                while waiting:
                    _submit(running, waiting, executor, workers)
                    described = running[0][1].result()
                    running.popleft()
                    for each in described:
                        waiting.popleft()
                        yield each
                return
        finally:
            executor.shutdown(cancel_futures=True)
    for _ in range(running[0][0] if running else 1):
        yield _describe_alone(waiting.popleft(), workers)


def _submit(
    running: "deque[tuple[int, Future[list[FileDescription]]]]",
    waiting: "deque[ClipRequest]",
    executor: Executor,
    workers: Workers,
) -> None:
    """Submit tasks until there are enough for all processes; each with its number of files."""
    n_tasks = QUEUED_PER_PROCESS * workers.n_processes()
    n_files = (
        min(max(len(waiting) // n_tasks, 1), FILES_PER_REMOTE_TASK) if workers.batch else 1
    )
    n_submitted = sum(n for n, _ in running)
    while len(running) < n_tasks and n_submitted < len(waiting):
        task = [*islice(waiting, n_submitted, n_submitted + n_files)]
        running.append((len(task), executor.submit(_describe_several, task)))
        n_submitted += len(task)


def _describe_several(requests: Sequence[ClipRequest]) -> list[FileDescription]:
    return [describe_file(request) for request in requests]


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
