"""Keep Blender's importers of FBX and Collada from opening the pictures that a file names.

Those of FBX and Collada open each picture, and a stranger's file may name a pipe, on which they
wait forever, a device, or a share of a server. A motion needs no pictures.
"""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from ...solvers.errors import InvalidFileError
from ...solvers.files import open_regular
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
IMAGES = re.compile(rb"<library_images\b.*?</library_images\s*>", re.DOTALL)
SOURCE = re.compile(rb"(<init_from\b[^>]*>).*?(</init_from\s*>)", re.DOTALL)
UTF_16 = (b"\xff\xfe", b"\xfe\xff")


@contextmanager
def without_pictures(path: str) -> Iterator[str]:
    """Give the path of an FBX or Collada file that names no pictures: a copy if it has any.

    Raises
    ------
    InvalidFileError
        It is XML with a document type, which may hold any text under another name.
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
    if not content.lstrip(b"\xef\xbb\xbf \t\r\n").startswith((b"<", *UTF_16)):
        return TEXT_NAMES.sub(b"-", content)
    if content.startswith(UTF_16):
        text = content.decode("utf-16", "replace")
        content = re.sub(r"\A<\?xml.*?\?>", "", text, flags=re.DOTALL).encode()
    if b"<!DOCTYPE" in content:
        raise InvalidFileError(
            f"{path} has a document type, which no Collada file needs. Export it as FBX or GLB."
        )
    return IMAGES.sub(lambda images: SOURCE.sub(rb"\1none.png\2", images[0]), content)
