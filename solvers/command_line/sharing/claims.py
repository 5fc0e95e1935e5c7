"""Claims on outputs, so that no two processes or machines make the same one.

A claim is a file with the host and process of its holder, created exclusively: this also works
on network shares, where locks often do not. Its holder renews its date. A claim that is not
renewed is abandoned, at once if its holder was a process of this machine that has ended.
"""

import json
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from secrets import token_hex
from threading import Event, Thread
from typing import Any, NamedTuple

from ...files import read_regular, unwritable_error
from ...json_text import parse_json
from ...processes import host_name, is_running, this_machine

RENEWAL_INTERVAL_S = 15.0
"""Seconds between two renewals of a claim. It guards claims of slow takes: twenty renewals may
fail before one is taken over."""
ABANDONED_AFTER_S = 300.0
"""Seconds after which a claim that is not renewed is taken over. It guards takes whose holder
was on another machine that has stopped."""
PART = re.compile(r"\.[0-9a-f]{16}\.claim\.part|[0-9a-f]{16}\.time")
"""Names of the files of a moment that a claim needs; only a killed process leaves any."""
MAX_BYTES = 10_000
"""Bytes of a claim; a host and two numbers have a hundred. It bounds the memory for damaged
files."""
UNKNOWN_HOST = "another machine"
Claims = dict[Path, dict[str, Any]]
"""Files of claims by number, with their content."""


class Claim(NamedTuple):
    """A claim on an output: held by this process, or by another one."""

    holder: str = ""
    """Host of the other process; empty if this process holds the claim."""
    taken_over: bool = False
    """Whether an abandoned claim was taken over: its holder may have left temporary files."""
    is_own_batch: bool = False
    """Whether the other process has worked for the same batch: it was lost, as the batch gives
    each output to one process."""


@contextmanager
def claimed(path: Path, batch: str = "") -> Iterator[Claim]:
    """Claim an output, and release it at the end.

    Parameters
    ----------
    path : Path
        The claim's file, without its number: an abandoned claim stays until the next one with a
        higher number is released, so that no two processes can take it over.
    batch : str
        Identifier of the batch of a cluster; empty for all others.

    Raises
    ------
    FileAccessError
        The folder of the claim has vanished, or may not be written to, or the disk is full.
    """
    try:
        files, holder = _claim(path, batch)
    except OSError as error:
        raise unwritable_error(path.parent, error) from None
    if holder is not None:
        is_own_batch = bool(batch) and holder.get("batch") == batch
        yield Claim(str(holder.get("host", UNKNOWN_HOST)), is_own_batch=is_own_batch)
        return
    ended = Event()
    own = next(reversed(files))
    renewal = Thread(target=_renew, args=(own, ended), daemon=True, name="renew claim")
    renewal.start()
    try:
        yield Claim("", len(files) > 1)
    finally:
        ended.set()
        renewal.join()
        if not _claim_file(path, len(files) + 1).exists():  # else it stalled and was taken over
            _release(files)


def _claim(path: Path, batch: str) -> tuple[Claims, dict[str, Any] | None]:
    """Return the claims taken over and the new one, or the content of another one."""
    claims: Claims = {}
    while True:
        file = _claim_file(path, len(claims) + 1)
        own = _create_claim(file, batch)
        if own is not None:
            if all(_content(each) == content for each, content in claims.items()):
                return {**claims, file: own}, None
            file.unlink()  # The output was released meanwhile, with all numbers.
            claims = {}
            continue
        holder = _content(file)
        if holder is None:  # It was released meanwhile.
            claims = {}
        elif _is_abandoned(file, holder):
            claims[file] = holder
        else:
            return {}, holder


def _claim_file(path: Path, number: int) -> Path:
    return path.with_name(f"{path.name}.{number}.claim")


def _release(files: Claims) -> None:
    """Remove the claims; the own one is the last, as it keeps its number from others."""
    for file, content in files.items():
        with suppress(OSError):
            if _content(file) == content:
                file.unlink()


def _create_claim(file: Path, batch: str) -> dict[str, Any] | None:
    """Create a claim, where the disk has links at once with its content; None if it exists.

    No two claims have the same content, also if one process makes both.
    """
    holder = {"host": host_name(), "machine": this_machine(), "pid": os.getpid()}
    own = {**holder, "token": token_hex(8), **({"batch": batch} if batch else {})}
    part = file.with_name(f".{token_hex(8)}.claim.part")
    try:
        part.write_text(json.dumps(own), encoding="utf-8")
        try:
            os.link(part, file)
        except FileExistsError:
            return None
        except OSError:  # Some shares have no links: a process killed there leaves it empty.
            return own if _created_empty(file, json.dumps(own)) else None
    finally:
        part.unlink(missing_ok=True)
    return own


def _created_empty(file: Path, content: str) -> bool:
    try:
        stream = file.open("x", encoding="utf-8")
    except FileExistsError:
        return False
    try:
        with stream:
            stream.write(content)
    except OSError:  # The disk is full: an empty claim would keep all others from the output.
        file.unlink(missing_ok=True)
        raise
    return True


def _content(file: Path) -> dict[str, Any] | None:
    """Return the content of a claim; None if it does not exist, empty while it is written."""
    try:
        found = parse_json(read_regular(file, MAX_BYTES))
    except FileNotFoundError:
        return None
    except (OSError, ValueError):
        return {}
    return found if isinstance(found, dict) else {}


def is_held(file: Path) -> bool:
    """Return whether a claim exists that is not abandoned."""
    holder = _content(file)
    return holder is not None and not _is_abandoned(file, holder)


def _is_abandoned(file: Path, holder: dict[str, Any]) -> bool:
    pid = holder.get("pid")
    if holder.get("machine") == this_machine() and isinstance(pid, int) and not is_running(pid):
        return True
    try:
        renewed = file.stat().st_mtime
    except FileNotFoundError:
        return False
    return _now_on_disk(file) - renewed > ABANDONED_AFTER_S


def _now_on_disk(file: Path) -> float:
    """Return the time by the clock that dates files there; that of a share is the server's."""
    probe = file.with_name(f"{token_hex(8)}.time")
    try:
        probe.touch(exist_ok=False)
        return probe.stat().st_mtime
    finally:
        probe.unlink(missing_ok=True)


def remove_abandoned_parts(folder: Path) -> None:
    """Remove files that killed processes left while they made a claim.

    Others may be making theirs: only files as old as an abandoned claim go.
    """
    parts = [file for file in folder.iterdir() if PART.fullmatch(file.name)]
    now = _now_on_disk(folder / "claims") if parts else 0.0
    for part in parts:
        with suppress(OSError):
            if now - part.stat().st_mtime > ABANDONED_AFTER_S:
                part.unlink()


def _renew(file: Path, ended: Event) -> None:
    while not ended.wait(RENEWAL_INTERVAL_S):
        with suppress(OSError):  # The share may come back.
            os.utime(file)
