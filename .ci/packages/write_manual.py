"""Write the documents as HTML pages with a search, for the zip: they need no network.

    python .ci/packages/write_manual.py build/manual

`.ci/packages/build_extension.py` puts them into the zip, below `mocap_assist/ui/pages`.
"""

import json
import os
import shutil
import sys
from html import escape
from pathlib import Path, PurePosixPath
from string import Template
from urllib.parse import urlsplit

from markdown import sections, to_html

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
FOLDERS = ("formats", "manual", "origins", "rigs", "start", "technical")
"""Folders of docs that have pages for people who use Mocap Assist."""
START = "README.md"
PARTS = Path(__file__).with_name("manual_pages")


def main(target: Path) -> None:
    """Write all pages, their pictures and the search into a folder; a former one goes."""
    shutil.rmtree(target, ignore_errors=True)
    target.mkdir(parents=True)
    pages = pages_of(DOCS)
    template = Template((PARTS / "page.html").read_text(encoding="utf-8"))
    index, pictures = [], set()
    for page in pages:
        markdown = (DOCS / page).read_text(encoding="utf-8")
        links = Links(page, pages)
        body = to_html(markdown, links.address)
        pictures |= links.pictures
        parts = sections(markdown)
        filled = template.substitute(
            title=escape(parts[0].title), body=body, up="../" * (len(page.parts) - 1)
        )
        write(target / page.with_suffix(".html"), filled)
        file = page.with_suffix(".html").as_posix()
        index += [[file, parts[0].title, each.title, each.anchor, each.text] for each in parts]
    for picture in sorted(pictures):
        (target / picture).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(DOCS / picture, target / picture)
    search = (PARTS / "search.js").read_text(encoding="utf-8")
    content = json.dumps(index, ensure_ascii=False, separators=(",", ":"))
    write(target / "search.js", f"const INDEX = {content};\n{search}")
    shutil.copyfile(PARTS / "page.css", target / "page.css")


def pages_of(docs: Path) -> list[PurePosixPath]:
    """Return the pages that go into the zip, relative to docs."""
    found = [docs / START, docs / "glossary.md"]
    found += [page for name in FOLDERS for page in sorted((docs / name).rglob("*.md"))]
    return [PurePosixPath(page.relative_to(docs).as_posix()) for page in found]


class Links:
    """The links of one page."""

    def __init__(self, page: PurePosixPath, pages: list[PurePosixPath]) -> None:
        self._folder, self._pages = page.parent, pages
        self.pictures: set[PurePosixPath] = set()

    def address(self, target: str) -> str:
        """Return where a link leads in the HTML; empty for files that the zip lacks."""
        parts = urlsplit(target)
        if parts.scheme or not parts.path:
            return target
        path = PurePosixPath(os.path.normpath(self._folder / parts.path))
        if path.parts[0] == "pictures":
            self.pictures.add(path)
            return target
        if path not in self._pages:
            return ""
        page = PurePosixPath(parts.path).with_suffix(".html").as_posix()
        return page + (f"#{parts.fragment}" if parts.fragment else "")


def write(path: Path, text: str) -> None:
    """Write a text with the same bytes on every system."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
