"""The catalogs of asset libraries: `blender_assets.cats.txt`. Knows nothing about Blender.

The file has a line for each catalog: its UUID, its path, and a simple name.
"""

from pathlib import Path
from uuid import uuid4

from ...solvers.errors import InvalidFileError
from ...solvers.files import write_atomically

FILE = "blender_assets.cats.txt"
HEAD = "VERSION 1\n\n"
N_COLUMNS = 3
NO_CATALOG = "00000000-0000-0000-0000-000000000000"
"""UUID of assets without a catalog."""


def catalog_file(folder: Path) -> Path:
    """Return the catalogs that hold for .blend files in a folder: there, or nearest above."""
    for each in (folder, *folder.parents):
        if (each / FILE).is_file():
            return each / FILE
    return folder / FILE


def read_catalogs(file: Path) -> dict[str, str]:
    """Return the paths of catalogs by UUID; none where the file is missing or unreadable."""
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return {}
    rows = [line.split(":", N_COLUMNS - 1) for line in text.splitlines()]
    return {
        row[0].strip().lower(): row[1].strip()
        for row in rows
        if len(row) >= N_COLUMNS - 1 and not row[0].startswith("#")
    }


def ensure_catalog(file: Path, catalog: str) -> str:
    """Return the UUID of the catalog of that path; add it to the file where it is new.

    Raises
    ------
    InvalidFileError
        The name breaks the file's lines, or the file cannot be read or written.
    """
    catalog = catalog.strip().strip("/")
    if ":" in catalog or not catalog.isprintable():
        raise InvalidFileError(
            f"{catalog!r} cannot name a catalog: it has a colon or a control character."
        )
    for number, path in read_catalogs(file).items():
        if path == catalog:
            return number
    number, simple = str(uuid4()), catalog.replace("/", "-")
    try:
        before = file.read_text(encoding="utf-8") if file.is_file() else HEAD
    except (OSError, UnicodeDecodeError):
        raise InvalidFileError(f"{file} cannot be read, and was left as it is.") from None
    if not before.endswith("\n"):
        before += "\n"
    with write_atomically(file) as part:
        part.write_text(f"{before}{number}:{catalog}:{simple}\n", encoding="utf-8")
    return number
