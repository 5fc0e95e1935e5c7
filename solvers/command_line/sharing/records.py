"""Records of a batch: a small file for each output, so that many machines may add to them."""

import errno
import json
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field, fields
from hashlib import sha256
from pathlib import Path, PurePosixPath
from secrets import token_hex
from typing import Any

from ...errors import InvalidFileError
from ...faults import Failure, attempt
from ...files import read_regular, remove_leftovers, write_atomically
from ...json_text import parse_json
from ...processes import host_name
from .claims import is_held, remove_abandoned_parts
from .fingerprints import without_folders

FOLDER = ".mocap_assist"
"""Folder of the records and claims in an output folder. Names with a dot are no recordings."""
FORMER_RECORD = "mocap_assist.json"
"""The one record of all outputs that earlier versions wrote; still read."""
MAX_NAME_LETTERS = 40
"""Letters of an output's name in that of its record. It bounds the length of file names."""
MAX_BYTES = 64_000_000
"""Bytes of a file of records. It bounds the memory for damaged files; a former record of a
thousand outputs has two million."""
N_DIGITS = 16
"""Hexadecimal digits of a hash that tell records of equal names apart. It guards against equal
hashes: of a million outputs, two share one with a chance of 1 in 30 million."""


@dataclass(frozen=True, kw_only=True)
class Record:
    """The record of one output, or of the failure to make it."""

    verb: str
    inputs: list[str]
    output: str
    """Relative to the output folder, with slashes."""
    fingerprint: dict[str, Any]
    """Everything that the result depends on."""
    figures: dict[str, Any] = field(default_factory=dict)
    error: str = ""
    """Empty if the output was made."""
    remarks: list[str] = field(default_factory=list)
    after: dict[str, Any] = field(default_factory=dict)
    """Command, exit status and output of `--after`."""
    host: str = field(default_factory=host_name)
    duration_s: float = 0.0
    identifier: str = field(default_factory=lambda: token_hex(8))

    @property
    def status(self) -> str:
        """Whether the output was made."""
        return "failed" if self.error else "done"


class Records:
    """The records in an output folder, read and written one by one."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def file(self, output: str) -> Path:
        """Return the file of the record of an output."""
        return self._path(output, ".json")

    def claim(self, output: str) -> Path:
        """Return the claim on an output, see `claimed`."""
        return self._path(output, "")

    def has_claims(self, but: str) -> bool:
        """Return whether a process works on any output, except one."""
        excepted = f"{self.claim(but).name}."
        claims = (self.folder / FOLDER).glob("*.claim")
        return any(is_held(each) for each in claims if not each.name.startswith(excepted))

    def prepare(self) -> None:
        """Make the folder of the records; a folder that vanishes later is not made again."""
        (self.folder / FOLDER).mkdir(parents=True, exist_ok=True)

    def remove_abandoned_parts(self) -> None:
        """Remove the files that killed processes left of their claims."""
        remove_abandoned_parts(self.folder / FOLDER)

    def read(self, output: str) -> Record | None:
        """Return the record of an output; None if it is missing or damaged."""
        return _read(self.file(output), output)

    def write(self, record: Record) -> None:
        """Write a record atomically."""
        content = {"status": record.status, **asdict(record)}
        with write_atomically(self.file(record.output)) as part:
            part.write_text(json.dumps(content, indent=1, allow_nan=False), encoding="utf-8")

    def all(self) -> list[Record]:
        """Return all records by output; those whose name and content differ are left out."""
        files = [*(self.folder / FOLDER).glob("*.json")]
        pairs = zip(files, map(_read, files), strict=True)
        found = [each for file, each in pairs if each and self.file(each.output) == file]
        return sorted(found, key=lambda record: PurePosixPath(record.output))

    def former(self) -> Iterator[Record]:
        """Yield the records in the single file of earlier versions."""
        notes = _content(self.folder / FORMER_RECORD)
        for output, note in notes.items() if isinstance(notes, Mapping) else ():
            if isinstance(note, dict):
                figures = note.pop("figures", None)
                options = note.get("options")
                verb = options.get("verb", "") if isinstance(options, dict) else ""
                record = Record(
                    verb=str(verb),
                    inputs=[],
                    output=output,
                    fingerprint=without_folders(note),
                    figures=figures if isinstance(figures, dict) else {},
                    host="",
                )
                if _is_below(output):
                    yield record

    def clear_up(self, output: str, *others: Path) -> None:
        """Remove temporary files that a killed process left for the record and these files."""
        remove_leftovers([self.file(output), *others])

    def _path(self, output: str, suffix: str) -> Path:
        digest = sha256(output.encode("utf-8", "surrogatepass")).hexdigest()[:N_DIGITS]
        name = PurePosixPath(output).name[:MAX_NAME_LETTERS]
        return self.folder / FOLDER / f"{name}.{digest}{suffix}"


def _read(file: Path, output: str | None = None) -> Record | None:
    """Return the record in a file; None if it is missing or is no record of that output."""
    record = attempt(file, _parsed, _content(file))
    if isinstance(record, Failure) or output not in {None, record.output}:
        return None
    return record


def _content(file: Path) -> Any:
    """Return the content of a file; None if it is missing or is not JSON."""
    try:
        return parse_json(read_regular(file, MAX_BYTES))
    except OSError as error:
        if error.errno == errno.EFBIG:
            raise InvalidFileError(
                f"{file} is too large for records of a batch; move it away to start again."
            ) from None
    except ValueError:
        pass
    return None


def _parsed(content: Any) -> Record:
    record = Record(**{each.name: content[each.name] for each in fields(Record)})
    texts = [record.verb, record.output, record.error, record.host, record.identifier]
    lists = [*record.inputs, *record.remarks]
    if not all(isinstance(text, str) for text in [*texts, *lists]):
        raise ValueError("a text is missing")
    if not all(isinstance(each, dict) for each in (record.figures, record.after)):
        raise ValueError("the figures are missing")
    if not _is_below(record.output):
        raise ValueError("the output is in another folder")
    return record


def _is_below(output: str) -> bool:
    """Return whether a relative path stays in its folder."""
    path = PurePosixPath(output)
    return bool(path.name) and not path.is_absolute() and ".." not in path.parts
