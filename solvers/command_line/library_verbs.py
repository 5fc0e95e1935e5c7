"""`index` and `find`: build a clip library, and search it for similar motion."""

import argparse
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Any

from ..errors import InvalidMotionError, InvalidSettingError
from ..faults import escaped
from ..files import real_path
from ..motion import JointRecording
from ..processes import Workers, threads_from
from ..progress import Progress, within
from ..recordings import read_tracked
from ..retrieval import (
    FindSettings,
    FoundClip,
    find_in_libraries,
    libraries_in,
    load_clip_library,
)
from ..workflows import IndexReport, index_files
from .arguments import (
    Outcome,
    Task,
    VerbWork,
    add_body_option,
    arguments_from,
    settings_from_arguments,
)
from .farm import cluster_workers

DEFAULT_N_MATCHES = 10
"""Default number of matches."""


def add_index_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `index`."""
    parser.add_argument(
        "--tag", action="append", default=[], metavar="WORD",
        help="Tag for these clips; may be repeated",
    )  # fmt: skip
    parser.add_argument(
        "--remove-missing", action="store_true",
        help="Remove clips from the library whose files were in these folders and are gone",
    )  # fmt: skip
    parser.add_argument(
        "--vocabulary", type=Path, metavar="LIBRARY",
        help="Describe clips by the vocabulary of LIBRARY and never learn another one, so that"
        " find can search several libraries; LIBRARY may be the library itself",
    )  # fmt: skip
    add_body_option(parser)


def perform_index(task: Task, prepared: None, progress: Progress) -> Outcome:
    """Update a library from files and folders."""
    arguments = task.arguments
    assert task.target is not None
    with _workers(task) as workers:
        report = index_files(
            task.target,
            task.sources,
            tags=arguments.tag,
            body=arguments.body,
            jobs=arguments.jobs,
            n_threads=threads_from(arguments),
            workers=workers,
            vocabulary_of=arguments.vocabulary,
            remove_missing=arguments.remove_missing,
            progress=progress,
        )
    figures = {
        "library": str(task.target),
        "n_clips": report.n_clips,
        "added": list(report.added),
        "changed": list(report.changed),
        "unchanged": list(report.unchanged),
        "removed": list(report.removed),
        "refused": [{"file": path, "why": why} for path, why in report.refused],
    }
    failures = tuple(why for _, why in report.refused)
    return Outcome(_format_report(report, task.target), figures, failures)


def _workers(task: Task) -> AbstractContextManager[Workers | None]:
    """Return the workers of a cluster that see the recordings, or None for this machine."""
    address: str | None = task.arguments.cluster
    if address is None:
        return nullcontext()
    named = [real_path(path) for path in task.sources]
    folders = {path if path.is_dir() else path.parent for path in named}
    return cluster_workers(address, sorted(folders))


def _format_report(report: IndexReport, library: Path) -> str:
    parts = [
        f"{len(names)} {what}"
        for names, what in (
            (report.added, "added"),
            (report.changed, "read again"),
            (report.unchanged, "unchanged"),
            (report.removed, "removed"),
            (report.refused, "refused"),
        )
        if names
    ]
    clips = "1 clip" if report.n_clips == 1 else f"{report.n_clips} clips"
    return f"{', '.join(parts) or 'Nothing to do'}; {escaped(str(library))} has {clips}."


def add_find_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `find`."""
    parser.add_argument(
        "--frames", type=_frames, metavar="A:B",
        help="Frames of the recording to search with, from A to B - 1, counted from 0"
        " [default: all]",
    )  # fmt: skip
    parser.add_argument(
        "--ignore", nargs="+", default=[], metavar="CLIP",
        help="Names of clips to leave out, such as the recording itself",
    )  # fmt: skip
    parser.add_argument(
        "--scale", type=float, metavar="X",
        help="Meters per unit of the recording [default: as stored in the file, or estimated"
        " from the size of the body]",
    )  # fmt: skip
    add_body_option(parser)
    arguments_from(parser, FindSettings)


def perform_find(task: Task, prepared: None, progress: Progress) -> Outcome:
    """Search one or more libraries with a recording."""
    arguments = task.arguments
    query = read_tracked(
        task.source,
        scale=arguments.scale,
        body=arguments.body,
        progress=within(progress, 0.0, 0.5),
    )
    tracks = query.tracks if isinstance(query, JointRecording) else query
    if arguments.frames is not None:
        first, last = arguments.frames
        last = min(tracks.n_frames, last)
        if first >= last:
            raise InvalidSettingError(
                f"{task.source} has {tracks.n_frames} frames; the range from {first} is empty."
            )
        query = query.slice(first, last)
    if not hasattr(arguments, "n_matches"):
        arguments.n_matches = DEFAULT_N_MATCHES
    libraries = libraries_in(task.sources[1:])
    found = find_in_libraries(
        query,
        libraries,
        settings=settings_from_arguments(arguments, FindSettings),
        ignore=arguments.ignore,
        progress=within(progress, 0.5, 1.0),
    )
    if not found:
        _refuse_empty(libraries)
    figures = [_figures(each) for each in found]
    return Outcome(_table(found, len(libraries) > 1), {"matches": figures})


def _refuse_empty(libraries: Sequence[Path]) -> None:
    """Raise InvalidMotionError if no library has clips."""
    for path in libraries:
        with load_clip_library(path) as library:
            if library.entries:
                return
    which = f"The library {libraries[0]} has" if len(libraries) == 1 else "The libraries have"
    raise InvalidMotionError(f"{which} no clips; index some first.")


def _figures(found: FoundClip) -> dict[str, Any]:
    match, entry, origin = found.match, found.entry, found.entry.origin
    return {
        "clip": match.clip,
        "library": str(found.library),
        "score": match.score,
        "first_frame": match.frames.start,
        "last_frame": match.frames.stop - 1,
        "frame_rate_hz": entry.frame_rate,
        "tags": list(entry.tags),
        "path": None if origin is None else origin.path,
        "item": None if origin is None else origin.item,
    }


def _table(found: Sequence[FoundClip], names_library: bool) -> str:
    if not found:
        return "No similar clip was found."
    head = ("clip", *(["library"] * names_library), "score", "frames", "seconds", "tags")
    rows = [head]
    for each in found:
        match, entry = each.match, each.entry
        first, last = match.frames.start, match.frames.stop - 1
        begin, end = (frame / entry.frame_rate for frame in (first, last))
        rows.append((
            match.clip, *([escaped(each.library.name)] * names_library), f"{match.score:.2f}",
            f"{first + 1}-{last + 1}", f"{begin:.1f}-{end:.1f}", ", ".join(entry.tags),
        ))  # fmt: skip
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return "\n".join(
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    )


def _frames(text: str) -> tuple[int, int]:
    first, _, last = text.partition(":")
    return int(first or 0), int(last) if last else 2**62


_frames.__name__ = "range of frames"


INDEX = VerbWork(add_index_options, perform_index)


FIND = VerbWork(add_find_options, perform_find)
