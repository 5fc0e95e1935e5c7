"""Run the tasks of a batch on the workers of a Dask cluster.

This is the only module that knows Dask, which is optional and imported when a cluster is named.
"""

import asyncio
import logging
import pickle
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future
from contextlib import contextmanager
from functools import cache, partial
from pathlib import Path
from secrets import token_hex
from typing import TYPE_CHECKING, Any

from ...errors import InvalidSettingError, MocapAssistError
from ...files import is_missing
from ...processes import host_name
from ...version import build

if TYPE_CHECKING:
    from distributed import Client

CONNECTION_TIMEOUT_S = 5.0
"""Seconds to wait for a scheduler. It bounds the wait for one that does not run."""
CALL = "pickle.loads(call)(*arguments)"
"""What a worker evaluates. Dask unpickles a function on the scheduler, too, and on a worker
before its task can fail: for this text and bytes neither needs the modules of the call."""


class WorkerCluster:
    """The workers of a cluster."""

    max_crashes = 2
    """Dask runs a task on further workers itself: each crash here is the end of several."""
    advice = "Process a part of the take, or start workers with more memory."

    def __init__(self, client: "Client", address: str, paths: Sequence[Path]) -> None:
        self.batch = token_hex(8)
        self._client, self._address, self._paths = client, address, paths

    def n_processes(self) -> int:
        """Return the number of tasks that the workers run at once now; one if all have died."""
        try:
            n_threads: int = sum(self._client.nthreads().values())
        except _scheduler_errors():
            raise MocapAssistError(_is_gone(self._address)) from None
        return max(n_threads, 1)

    @contextmanager
    def open(self, n_tasks: int) -> Iterator[Executor]:
        """Yield an executor on all workers, also those that join later."""
        yield ClusterExecutor(self._client, self._address, self._paths)

    def share(self, value: Any) -> Any:
        """Return a value that each worker receives once, also one that joins later."""
        from dask import config

        # A function whose result is the value: Dask calls it again when its holders have ended.
        with config.set({"distributed.admin.large-graph-warning-threshold": "1TB"}):
            return self._client.submit(
                *_call_for_workers(partial(_identity, value)), pure=False
            )


class ClusterExecutor(Executor):
    """An executor on the workers of a cluster."""

    def __init__(self, client: "Client", address: str, paths: Sequence[Path]) -> None:
        self._executor, self._address = client.get_executor(pure=False), address
        self._check = partial(_check_once, build(), tuple(paths))

    def submit(
        self, function: Callable[..., Any], /, *args: Any, **kwargs: Any
    ) -> "Future[Any]":
        """Submit a call; arguments from `WorkerCluster.share` arrive as their values."""
        future: Future[Any] = Future()
        call = partial(_call_after, self._check, function)
        try:
            remote = self._executor.submit(*_call_for_workers(partial(call, **kwargs), *args))
        except _scheduler_errors():
            raise MocapAssistError(_is_gone(self._address)) from None
        remote.add_done_callback(partial(self._pass_on, future))
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Cancel what has not started, if requested."""
        if cancel_futures:
            self._executor.shutdown(wait=False)

    def _pass_on(self, future: "Future[Any]", remote: "Future[Any]") -> None:
        """Pass on the end of a call; errors of Dask become those of an executor."""
        from distributed import KilledWorker

        if remote.cancelled():
            future.set_exception(MocapAssistError(_is_gone(self._address)))
            return
        error = remote.exception()
        if isinstance(error, KilledWorker):
            error = BrokenExecutor(str(error))
        elif error is not None:
            error = _worker_error("A worker", error)
        if error is None:
            future.set_result(remote.result())
        else:
            future.set_exception(error)


@contextmanager
def cluster_workers(address: str, paths: Sequence[Path]) -> Iterator[WorkerCluster]:
    """Connect to the scheduler of a cluster and check its workers.

    Parameters
    ----------
    address : str
        Address of the scheduler, such as tcp://farm01:8786.
    paths : sequence of Path
        What all workers must see: recordings, the output folder, a library that they open.

    Raises
    ------
    InvalidSettingError
        Dask is missing, the scheduler cannot be reached, or a worker has no or another version
        of Mocap Assist, or does not see one of the paths.
    """
    try:
        from distributed import Client
    except ImportError:
        raise InvalidSettingError(
            "--cluster needs the Python package distributed, which is not installed here."
            " Install it: python -m pip install distributed."
        ) from None
    for name in ("distributed", "distributed.client"):  # One sentence is enough.
        logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        asyncio.run(_try_connection(address))
        client = Client(address, timeout=CONNECTION_TIMEOUT_S, set_as_default=False)
    except (OSError, ValueError, TypeError, RuntimeError):
        raise InvalidSettingError(
            f"There is no scheduler at {address}, or it cannot be reached. Start one with dask"
            " scheduler, or correct the address."
        ) from None
    with client:
        _check_workers(client, paths)
        yield WorkerCluster(client, address, paths)


async def _try_connection(address: str) -> None:
    """Raise an OSError or ValueError at once where a client would wait forever."""
    from distributed import Security
    from distributed.comm import connect

    keys = Security().get_connection_args("client")
    async with asyncio.timeout(CONNECTION_TIMEOUT_S):
        connection = await connect(address, timeout=CONNECTION_TIMEOUT_S, **keys)
    await connection.close()


def _check_workers(client: "Client", paths: Sequence[Path]) -> None:
    check = partial(_check_once, build(), tuple(paths))
    answers = client.run(*_call_for_workers(check), on_error="return")
    if not answers:
        raise InvalidSettingError(
            "The scheduler has no workers. Start some: dask worker, and its address."
        )
    for worker, answer in sorted(answers.items()):
        if isinstance(answer, BaseException):
            raise _worker_error(f"The worker {worker}", answer)


@cache
def _check_once(expected: str, paths: tuple[Path, ...]) -> None:
    """Check a worker, in its process: at the start, or before the first take if it joins later.

    What passed is not checked again: a folder that vanishes later is the batch's to report.
    """
    for path in paths:
        if is_missing(path):
            raise InvalidSettingError(
                f"A worker on {host_name()} does not see {path}. Mount it there at the same"
                " path."
            )
    if build() != expected:
        raise InvalidSettingError(
            f"A worker on {host_name()} has Mocap Assist {build()}, and this process"
            f" {expected}. Install the same version on both."
        )


def _call_after(
    check: Callable[[], None], function: Callable[..., Any], *args: Any, **kwargs: Any
) -> Any:
    check()
    return function(*args, **kwargs)


def _scheduler_errors() -> tuple[type[Exception], ...]:
    """Return what a client raises once its scheduler has ended."""
    from distributed.client import ClosedClientError

    return OSError, RuntimeError, ClosedClientError


def _identity(value: Any) -> Any:
    return value


def _call_for_workers(call: Callable[..., Any], *arguments: Any) -> tuple[Any, ...]:
    """Return a call as function and arguments for Dask; shared values stay as they are."""
    from distributed.protocol.pickle import dumps

    return eval, CALL, {"pickle": pickle, "call": dumps(call), "arguments": [*arguments]}


def _worker_error(worker: str, error: BaseException) -> MocapAssistError:
    """Return an error of a worker as one with a sentence."""
    if isinstance(error, MocapAssistError):
        return error
    reason = str(error).strip().partition("\n")[0].rstrip(".") or type(error).__name__
    if isinstance(error, ImportError):
        return InvalidSettingError(
            f"{worker} cannot import Mocap Assist ({reason}). Install the same version there as"
            " here, with all that it needs."
        )
    return MocapAssistError(f"{worker} cannot be used: {reason}. Read its log, and restart it.")


def _is_gone(address: str) -> str:
    return f"The scheduler {address} is gone; the batch stops. Run it again to continue."
