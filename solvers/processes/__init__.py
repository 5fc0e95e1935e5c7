"""Threads, workers, locks and scratch folders that all processes share.

Nothing here imports numpy: `threads` must act before that is imported.
"""

from typing import TYPE_CHECKING

from ..import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .executors import LocalWorkers, Workers
    from .locks import try_lock
    from .machine import host_name, is_running, this_machine
    from .parent import end_with_stdin
    from .scratch import ScratchFolder, lock_for_work_on
    from .threads import (
        add_threads_option,
        thread_environment,
        threads_from,
        threads_from_arguments,
    )
    from .workers import worker_pool

__all__ = [
    "LocalWorkers",
    "ScratchFolder",
    "Workers",
    "add_threads_option",
    "end_with_stdin",
    "host_name",
    "is_running",
    "lock_for_work_on",
    "this_machine",
    "thread_environment",
    "threads_from",
    "threads_from_arguments",
    "try_lock",
    "worker_pool",
]

import_on_demand(__name__)
