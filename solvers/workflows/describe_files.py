"""Read files and describe them for a library, one after the other or several at a time."""

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

AHEAD = 2
"""Files that are given to each process before their results are asked for."""


class Wanted(NamedTuple):
    """A file that is to be a clip."""

    name: str
    origin: Origin
    tags: tuple[str, ...]


class Described(NamedTuple):
    """What came of a file."""

    wanted: Wanted
    clip: DescribedClip | None
    """None where it was refused."""
    sentence: str = ""
    for_good: bool = False
    """Refused for what is in the file: it will be again, until it changes."""


def describe_files(
    files: Iterable[Wanted], jobs: int, n_threads: int = 1
) -> Iterator[Described]:
    """Yield what comes of each file, in the order in which they are given.

    A file that cannot be used is refused with one sentence and stops nobody; neither does one
    that takes the process down that reads it.
    """
    if jobs <= 1:
        yield from map(described, files)
        return
    waiting = deque(files)
    while waiting:
        yield from _until_one_dies(waiting, jobs, n_threads)


def described(wanted: Wanted) -> Described:
    """Read and describe one file."""
    path = wanted.origin.path
    found = attempt(path, _describe, wanted)
    if not isinstance(found, Failure):
        return Described(wanted, found)
    reason = found.sentence.removeprefix(f"{path}: ").removeprefix(f"{wanted.name}: ")
    named = Path(path).name in reason
    sentence = reason if named else f"{path}: {reason}"
    return Described(wanted, None, sentence, for_good=found.lasting)


def _describe(wanted: Wanted) -> DescribedClip:
    recording = read_tracked(wanted.origin.path)
    return describe_clip(Clip(wanted.name, recording, wanted.tags, wanted.origin))


def _until_one_dies(waiting: "deque[Wanted]", jobs: int, n_threads: int) -> Iterator[Described]:
    """Work on files, taking them off as they are done, until all are or a process dies.

    The one that was asked for when it happened is then tried alone, to know whether it was it.
    """
    running: deque[Future[Described]] = deque()
    with worker_pool(jobs, n_threads) as pool:
        try:
            with suppress(BrokenProcessPool):
                while waiting:
                    while len(running) < min(len(waiting), AHEAD * jobs):
                        running.append(pool.submit(described, waiting[len(running)]))
                    done = running[0].result()
                    running.popleft()
                    waiting.popleft()
                    yield done
                return
        finally:
            pool.shutdown(cancel_futures=True)
    yield _alone(waiting.popleft(), n_threads)


def _alone(wanted: Wanted, n_threads: int) -> Described:
    with worker_pool(1, n_threads) as pool:
        try:
            return pool.submit(described, wanted).result()
        except BrokenProcessPool:
            return Described(
                wanted,
                None,
                f"{wanted.origin.path}: the process that read it has died, perhaps for want of"
                " memory; cut the take into parts.",
            )
