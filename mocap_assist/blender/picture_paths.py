"""Keep Blender's importers of FBX and Collada from opening the files that a file names.

Those of FBX and Collada open each picture, and that of Collada other files, too. A stranger's
file may name a pipe, on which they wait forever, a device, or a share of a server. A motion
needs none of them.

XML has many ways to hide a name, such as comments and encodings. So Collada is written again,
with what a parser understood only.
"""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from xml.parsers import expat
from xml.sax.saxutils import escape, quoteattr

from ...solvers.errors import InvalidFileError
from ...solvers.files import open_regular
from ...solvers.recordings import suffix_by_content
from .stated_conventions import BINARY_FBX

BINARY_NAMES = re.compile(
    rb"(?<=\x10)R(?=elativeFilenameS)|(?<=\x08)F(?=ile[Nn]ameS)"
    rb"|(?<=S\x04\0\0\0)P(?=ath)|(?<=S\x07\0\0\0)R(?=elPath)"
)
"""First letters of the names of nodes and properties of binary FBX that hold paths. The length
is before a name."""
TEXT_NAMES = re.compile(
    rb"\bR(?=elativeFilename\s*:)|\bF(?=ile[Nn]ame\s*:)|(?<=\")P(?=ath\")|(?<=\")R(?=elPath\")"
)

REFERENCES = {"url", "source", "target"}
"""Attributes that name an element of this or another file; so does the text of a skeleton."""
PICTURE = "none.png"


@contextmanager
def without_pictures(path: str) -> Iterator[str]:
    """Give the path of an FBX or Collada file that names no other files: a copy if it does.

    Raises
    ------
    InvalidFileError
        It is a Collada file that is damaged, or has a document type.
    """
    with open_regular(path) as file:
        content = file.read()
    changed = _changed(path, content)
    if changed == content:
        yield path
        return
    with TemporaryDirectory() as folder:
        copy = Path(folder) / Path(path).name
        copy.write_bytes(changed)
        yield str(copy)


def _changed(path: str, content: bytes) -> bytes:
    if content.startswith(BINARY_FBX):
        return BINARY_NAMES.sub(b"-", content)
    if suffix_by_content(path) == ".fbx":
        return TEXT_NAMES.sub(b"-", content)
    return _collada_without_files(path, content)


def _collada_without_files(path: str, content: bytes) -> bytes:
    """Return a Collada file, in UTF-8, whose pictures and elements are in no other file.

    Raises
    ------
    InvalidFileError
        It is no XML, or has a document type, which may hold any text under another name.
    """
    collada = _Collada(path)
    parser = expat.ParserCreate()
    parser.buffer_text = True
    parser.StartElementHandler, parser.EndElementHandler = collada.start, collada.end
    parser.CharacterDataHandler = collada.add_text
    parser.StartDoctypeDeclHandler = collada.refuse
    try:
        parser.Parse(content, True)
    except InvalidFileError:
        raise
    except (expat.ExpatError, ValueError, LookupError):  # encodings that it does not know
        raise InvalidFileError(f"{path} is damaged or incomplete. Export it again.") from None
    return "".join(collada.written).encode()


class _Collada:
    """The elements of a Collada file as they are written again, from the first to the last."""

    def __init__(self, path: str) -> None:
        self.path = path
        self.written: list[str] = []
        self.above: list[str] = []

    def start(self, name: str, attributes: dict[str, str]) -> None:
        element = name.rpartition(":")[2]
        self.above.append(element)
        kept = "".join(
            f" {key}={quoteattr(_inside(element, key, value))}"
            for key, value in attributes.items()
        )
        self.written.append(f"<{name}{kept}>")
        if element == "init_from" and _is_in_picture(self.above):
            self.written.append(PICTURE)

    def end(self, name: str) -> None:
        self.above.pop()
        self.written.append(f"</{name}>")

    def add_text(self, data: str) -> None:
        is_elsewhere = self.above[-1] == "skeleton" and not data.lstrip().startswith("#")
        if not is_elsewhere and not _is_in_picture(self.above):
            self.written.append(escape(data))

    def refuse(self, *_: object) -> None:
        path = self.path
        raise InvalidFileError(
            f"{path} has a document type, which no Collada file needs. Export it as FBX or GLB."
        )


def _is_in_picture(above: list[str]) -> bool:
    """Whether text is the path of a picture. In a surface it is an id, which is kept."""
    return "init_from" in above and "image" in above


def _inside(element: str, key: str, value: str) -> str:
    """Return what an attribute names if it is in this file; another file is never opened.

    A channel's target is no file, but a path of elements.
    """
    if key not in REFERENCES or (element, key) == ("channel", "target"):
        return value
    return value if value.startswith("#") else "#"
