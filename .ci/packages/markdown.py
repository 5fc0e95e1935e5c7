"""Convert the Markdown that our documents use to HTML.

That is headings, paragraphs, lists of one level, tables, code, links, pictures, *italics* and
**bold**. A table or code within a list ends it, and what follows goes on with its number. HTML
stands in it as comments only, which are left out.
"""

import re
from collections.abc import Callable, Iterator
from html import escape
from textwrap import dedent
from typing import NamedTuple

COMMENT = re.compile(r"<!--.*?-->\n?", re.DOTALL)
HEADING = re.compile(r"(#+) (.+)")
ITEM = re.compile(r"(?:-|(\d+)\.) +(.*)")
CELL = re.compile(r"(?<!\\)\|")
RULE = re.compile(r"\|[\s|:-]+\|?")
INLINE = re.compile(
    r"`(?P<code>[^`]+)`"
    r"|!\[(?P<alt>[^]]*)\]\((?P<picture>[^)\s]+)\)"
    r"|\[(?P<label>(?:!\[[^]]*\]\([^)]*\)|[^]])+)\]\((?P<target>[^)\s]+)\)"
    r"|\*\*(?P<bold>[^*]+(?:\*[^*]+\*[^*]*)*)\*\*"
    r"|(?<!\w)\*(?P<italic>[^*\s](?:[^*]*[^*\s])?)\*(?!\w)"
    r"|\\(?P<escaped>[\\`*_|\[\]<>#])"
)

Link = Callable[[str], str]
"""Returns the address that a link or picture has in HTML; empty to show its text alone."""


class Section(NamedTuple):
    """A heading and what stands below it, for the search."""

    title: str
    anchor: str
    text: str


def to_html(markdown: str, link: Link) -> str:
    """Return the body of a page."""
    lines = COMMENT.sub("", markdown).splitlines()
    return "\n".join(_blocks(lines, link)) + "\n"


def sections(markdown: str) -> list[Section]:
    """Return the sections of a page as plain text."""
    found: list[tuple[str, list[str]]] = []
    in_code = False
    for line in COMMENT.sub("", markdown).splitlines():
        in_code ^= line.lstrip().startswith("```")
        heading = None if in_code else HEADING.fullmatch(line)
        if heading:
            found.append((heading[2], []))
        elif found and not RULE.fullmatch(line):
            found[-1][1].append(line)
    return [
        Section(plain(title), anchor_of(title), plain("\n".join(lines)))
        for title, lines in found
    ]


def anchor_of(heading: str) -> str:
    """Return what GitHub makes of a heading."""
    return re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")


def plain(text: str) -> str:
    """Return a text on one line without marks, with the labels of its links."""
    text = re.sub(r"!?\[([^]]*)\]\([^)]*\)", r"\1", text)
    text = re.sub(r"\*\*|```\w*|`|(?<!\w)\*|\*(?!\w)|\||\\(?=\|)", "", text)
    return " ".join(text.split())


def inline(text: str, link: Link) -> str:
    """Return the HTML of a text within a paragraph, a heading or a cell."""
    parts, end = [], 0
    for found in INLINE.finditer(text):
        parts += [escape(text[end : found.start()], quote=False), _marked(found, link)]
        end = found.end()
    return "".join([*parts, escape(text[end:], quote=False)])


def _marked(found: re.Match[str], link: Link) -> str:
    kind = found.lastgroup
    if kind == "code":
        return f"<code>{escape(found['code'], quote=False)}</code>"
    if kind == "picture":
        address = link(found["picture"])
        alt = escape(found["alt"])
        return f'<img src="{escape(address)}" alt="{alt}">' if address else alt
    if kind == "target":
        address, label = link(found["target"]), inline(found["label"], link)
        return f'<a href="{escape(address)}">{label}</a>' if address else label
    if kind == "bold":
        return f"<strong>{inline(found['bold'], link)}</strong>"
    if kind == "italic":
        return f"<em>{inline(found['italic'], link)}</em>"
    return escape(found["escaped"], quote=False)


def _blocks(lines: list[str], link: Link) -> Iterator[str]:
    """Yield the HTML of each block; a block ends at an empty line, or where another begins."""
    start = 0
    while start < len(lines):
        line = lines[start]
        stop = start + 1
        if line.lstrip().startswith("```"):
            while stop < len(lines) and lines[stop].strip() != "```":
                stop += 1
            yield _code(lines[start + 1 : stop])
            stop += 1
        elif heading := HEADING.fullmatch(line):
            level, text = len(heading[1]), heading[2]
            yield f'<h{level} id="{anchor_of(text)}">{inline(text, link)}</h{level}>'
        elif line.strip():
            while stop < len(lines) and _goes_on(line, lines[stop]):
                stop += 1
            yield _block(lines[start:stop], link)
        start = stop


def _goes_on(first: str, line: str) -> bool:
    """Return whether a line belongs to the block of the lines before it."""
    if not line.strip() or HEADING.fullmatch(line) or line.lstrip().startswith("```"):
        return False
    is_row = line.lstrip().startswith("|")
    if first.lstrip().startswith("|"):
        return is_row
    return not is_row and (bool(ITEM.match(first)) or not ITEM.match(line))


def _block(lines: list[str], link: Link) -> str:
    if lines[0].lstrip().startswith("|"):
        return _table(lines, link)
    if ITEM.match(lines[0]):
        return _list(lines, link)
    return f"<p>{inline(chr(10).join(line.strip() for line in lines), link)}</p>"


def _code(lines: list[str]) -> str:
    return f"<pre><code>{escape(dedent(chr(10).join(lines)), quote=False)}</code></pre>"


def _list(lines: list[str], link: Link) -> str:
    items: list[list[str]] = []
    for line in lines:
        if item := ITEM.match(line):
            items.append([item[2]])
        else:
            items[-1].append(line.strip())
    shown = "\n".join(f"<li>{inline(chr(10).join(item), link)}</li>" for item in items)
    first = ITEM.match(lines[0])
    if first is None or first[1] is None:
        return f"<ul>\n{shown}\n</ul>"
    return f'<ol start="{first[1]}">\n{shown}\n</ol>'


def _cells(row: str, link: Link) -> list[str]:
    cells = CELL.split(row.strip().strip("|"))
    return [inline(cell.strip().replace("\\|", "|"), link) for cell in cells]


def _table(lines: list[str], link: Link) -> str:
    rows = [_cells(line, link) for line in lines if not RULE.fullmatch(line.strip())]
    has_head = len(lines) > 1 and RULE.fullmatch(lines[1].strip()) and any(rows[0])
    shown = [
        "<tr>" + "".join(f"<{tag}>{cell}</{tag}>" for cell in row) + "</tr>"
        for number, row in enumerate(rows)
        for tag in ["th" if has_head and number == 0 else "td"]
        if any(row)
    ]
    return "\n".join(["<table>", *shown, "</table>"])
