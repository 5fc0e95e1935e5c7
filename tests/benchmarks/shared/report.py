"""Print tables on the terminal and, on request, write them to a page of docs.

A part's tables replace what stands between its two marks in the document; everything else in
it is written by hand.
"""

import os
import platform
import re
import sys
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

from .plots import draw_scores
from .tables import LINE_WIDTH, Scores, wrapped

DOCS = Path(__file__).resolve().parents[3] / "docs"
DOCUMENT = DOCS / "benchmarks" / "denoising.md"
PICTURES = DOCS / "pictures"
BENCHMARK_PICTURES = PICTURES / "benchmarks"
"""A folder for each page of benchmarks."""


class Report:
    """Where the tables go."""

    def __init__(self, to_document: bool, document: Path = DOCUMENT) -> None:
        self._to_document, self._document = to_document, document

    def part(self, name: str, tables: Sequence[Scores | str], seconds: float) -> None:
        """Print the tables of one part; put them into the document with a picture each."""
        for scores in tables:
            print(f"\n{_text(scores)}", flush=True)
        if self._to_document:
            text = [_run(seconds)]
            for number, scores in enumerate(tables):
                text.append(wrapped(_text(scores)))
                if isinstance(scores, Scores):
                    path = BENCHMARK_PICTURES / self._document.stem / f"{name}_{number}.png"
                    draw_scores(scores, path)
                    text.append(f"{show(path, scores.title, self._document)}\n")
            _replace(self._document, name, "\n".join(text))


def show(picture: Path, title: str, document: Path = DOCUMENT) -> str:
    """Return the Markdown that shows a picture in a document."""
    return f"![{title}]({Path(os.path.relpath(picture, document.parent)).as_posix()})"


def _text(scores: Scores | str) -> str:
    return scores if isinstance(scores, str) else scores.markdown()


def _run(seconds: float) -> str:
    now = datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC")
    module = Path(sys.argv[0]).resolve().relative_to(DOCS.parent).with_suffix("")
    words = ["python -m", ".".join(module.parts), *sys.argv[1:]]
    machine = f"{platform.system()} {platform.machine()}, Python {platform.python_version()}"
    command = f"`{' '.join(words)}`,"
    circumstances = f"{now}, {machine}, one BLAS thread, {seconds:.0f} s.\n"
    fits = len(command) + len(circumstances) <= LINE_WIDTH
    return f"{command}{' ' if fits else chr(10)}{circumstances}"


def _replace(path: Path, name: str, text: str) -> None:
    begin, end = f"<!-- {name} -->", f"<!-- end of {name} -->"
    document = path.read_text(encoding="utf-8") if path.exists() else ""
    if begin not in document:
        document += f"\n{begin}\n{end}\n"
    pattern = re.compile(f"{re.escape(begin)}.*?{re.escape(end)}", re.DOTALL)
    filled = pattern.sub(lambda _: f"{begin}\n{text}\n{end}", document)
    path.write_text(filled, encoding="utf-8")
