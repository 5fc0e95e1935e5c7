"""Hooks: a command that runs after each take, such as one that informs an asset manager."""

import argparse
import os
import re
import shlex
import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Any

PLACEHOLDER = re.compile(r"\{(input|output|record)\}")
MAX_OUTPUT_LETTERS = 10_000
"""Letters at the end of a hook's output that its record keeps."""
NOT_STARTED = 127
"""Exit status of a shell for a command that cannot be started."""


def parse_hook(command: str) -> str:
    """Return the command after a check that it can be started, for argparse."""
    try:
        words = words_of_hook(command)
    except ValueError as error:
        reason = str(error).lower()
        raise argparse.ArgumentTypeError(f"{command!r} is no command: {reason}") from None
    if not words or shutil.which(words[0]) is None:
        raise argparse.ArgumentTypeError(f"there is no program {words[0] if words else ''!r}")
    return command


def words_of_hook(command: str, windows: bool = os.name == "nt") -> list[str]:
    """Return the words of a command as a shell of its system splits it, without quotes.

    On Windows a backslash is part of a path, and only double quotes hold words together.

    Raises
    ------
    ValueError
        A quote is not closed.
    """
    lexer = shlex.shlex(command, posix=True)
    lexer.whitespace_split, lexer.commenters = True, ""
    if windows:
        lexer.escape, lexer.quotes = "", '"'
    return list(lexer)


def run_hook(command: str, files: Mapping[str, Path]) -> dict[str, Any]:
    """Run the command without a shell, and return what its record keeps.

    Parameters
    ----------
    command : str
        Split into words before the placeholders are replaced: a file name stays one word,
        whatever letters it has.
    files : mapping of str to Path
        The files for the placeholders {input}, {output} and {record}.
    """
    words = [
        PLACEHOLDER.sub(lambda found: str(files[found[1]]), word)
        for word in words_of_hook(command)
    ]
    try:
        ended = subprocess.run(
            words,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            check=False,
        )
    except OSError as error:
        return {"command": command, "status": NOT_STARTED, "output": str(error)}
    output = ended.stdout.decode("utf-8", "replace")[-MAX_OUTPUT_LETTERS:]
    return {"command": command, "status": ended.returncode, "output": output}


def hook_remark(after: Mapping[str, Any]) -> str:
    """Return a sentence about a hook that failed; empty if it succeeded or did not run."""
    if not after.get("status"):
        return ""
    lines = [line for line in str(after.get("output", "")).splitlines() if line.strip()]
    reason = f": {lines[-1].strip().rstrip('.')}" if lines else ""
    return f"The command of --after failed with status {after['status']}{reason}."
