"""Write and read archives of learned models, with one layout for each kind."""

import io
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import InvalidFileError
from .files import open_regular, write_atomically
from .npz_members import (
    READABLE,
    DamagedMemberError,
    Values,
    member_content,
    member_header,
    read_members,
)

MAX_KIND_LETTERS = 100
"""Maximum number of letters in the kind of an archive."""


@dataclass(frozen=True)
class ArchiveLayout:
    """The layout of an archive of one kind.

    Attributes
    ----------
    kind : str
        The content, stored in the member `kind`.
    version : int
        Version of the layout, stored in the member `version`.
    members : mapping of str to Values
    holds : str
        Content of a damaged archive in a message: "damaged postures".
    remedy : str
        Sentence on what to do then.
    """

    kind: str
    version: int
    members: Mapping[str, Values]
    holds: str
    remedy: str

    def write(self, path: Path | str, arrays: Mapping[str, NDArray[Any]]) -> None:
        """Save arrays as one compressed archive, atomically.

        Raises
        ------
        InvalidFileError
            The path is not writable, or the file of another program would be overwritten.
        """
        if Path(path).exists() and not _is_own(path):
            raise InvalidFileError(
                f"{path} is not a file of Mocap Assist; choose another name."
            )
        own = {"kind": np.array(self.kind), "version": np.array(self.version)}
        content = io.BytesIO()  # On a full disk, an archive on disk fails twice.
        np.savez_compressed(content, **own, **arrays)
        with write_atomically(path) as part:
            part.write_bytes(content.getvalue())

    def read(self, path: Path | str) -> dict[str, NDArray[Any]]:
        """Load the members of an archive that `write` saved.

        Raises
        ------
        InvalidFileError
            The file is missing, damaged, holds something else or comes from another version.
        """
        try:
            with open_regular(path) as file, zipfile.ZipFile(file) as archive:
                self._check_kind(path, archive)
                return read_members(archive, self.members)
        except FileNotFoundError:
            raise InvalidFileError(f"There is no file {path}.") from None
        except DamagedMemberError as error:
            raise self.damaged(path, str(error)) from None
        except InvalidFileError:
            raise
        except READABLE as error:
            raise InvalidFileError(f"{path} is not a readable archive ({error}).") from None

    def damaged(self, path: Path | str, fault: str) -> InvalidFileError:
        """Return the error of an archive whose values cannot be used."""
        return InvalidFileError(f"{path} holds {self.holds} ({fault}). {self.remedy}")

    def _check_kind(self, path: Path | str, archive: zipfile.ZipFile) -> None:
        kind, version = (_single_value(archive, name) for name in ("kind", "version"))
        if kind != self.kind:
            found = kind if isinstance(kind, str) else "something else"
            raise InvalidFileError(f"{path} holds {found}, not {self.kind}.")
        if type(version) is not int or version != self.version:
            saved = "unknown" if version is None else version
            raise InvalidFileError(
                f"{path} was saved as version {saved} of {kind}; this Mocap Assist reads"
                f" version {self.version}. Learn it again from the clips."
            )


def _single_value(archive: zipfile.ZipFile, name: str) -> str | int | None:
    """Return the single text or integer of a member; None if it holds anything else."""
    if f"{name}.npy" not in archive.namelist():
        return None
    try:
        header = member_header(archive, name)
    except ValueError:  # Another kind of member; damage raises no ValueError.
        return None
    if header.shape != () or header.n_bytes > 4 * MAX_KIND_LETTERS:
        return None
    value = member_content(archive, name).item()
    if isinstance(value, str):
        return value if value.isprintable() else None
    return value if type(value) is int else None


def _is_own(path: Path | str) -> bool:
    """Return whether `ArchiveLayout.write` saved this file."""
    try:
        with open_regular(path) as file, zipfile.ZipFile(file) as archive:
            return isinstance(_single_value(archive, "kind"), str)
    except READABLE:
        return False
