"""Identify this machine, and find out whether a process on it still runs."""

import os
import sys
from contextlib import suppress
from functools import cache
from pathlib import Path
from platform import node

if sys.platform == "win32":
    import ctypes

    SYNCHRONIZE, ACCESS_DENIED, WAIT_TIMEOUT = 0x00100000, 5, 0x102

    def _is_running(pid: int) -> bool:  # os.kill would end the process there
        kernel = ctypes.WinDLL("kernel32", use_last_error=True)
        process = kernel.OpenProcess(SYNCHRONIZE, False, pid)
        if not process:
            return ctypes.get_last_error() == ACCESS_DENIED
        running = kernel.WaitForSingleObject(process, 0) == WAIT_TIMEOUT
        kernel.CloseHandle(process)
        return running

else:

    def _is_running(pid: int) -> bool:
        try:
            os.kill(pid, 0)
        except ProcessLookupError:
            return False
        except OSError:  # It runs, as another user.
            return True
        return True


def host_name() -> str:
    """Return the name of this machine for people."""
    return node() or "a machine without a name"


@cache
def this_machine() -> str:
    """Return what distinguishes this machine from others, and from containers on it.

    Two processes with the same result see each other's process numbers.
    """
    parts = [host_name()]
    with suppress(OSError):  # Linux only
        parts.append(Path("/proc/sys/kernel/random/boot_id").read_text().strip())
        parts.append(str(Path("/proc/self/ns/pid").readlink()))
    return " ".join(parts)


def is_running(pid: int) -> bool:
    """Return whether a process of this machine runs; a zombie does not."""
    if pid <= 0 or not _is_running(pid):
        return False
    try:
        state = Path(f"/proc/{pid}/stat").read_text(errors="replace").rpartition(")")[2]
    except OSError:
        return True
    return state.split()[:1] not in (["Z"], ["X"])
