"""Read the XML files of Xsens MVN: segments with positions and orientations."""

import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element, ParseError, iterparse
from xml.parsers.expat import ExpatError, ParserCreate

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...files import open_regular
from ...motion import Motion
from ...progress import Progress, unwatched
from ..containers import UniqueNames, printable
from ..conventions import Bodies, check_scale, common_rate, file_conventions, observed_body
from .world_poses import motion_from_world_poses

PARENTS = {
    "Pelvis": "", "L5": "Pelvis", "L3": "L5", "T12": "L3", "T8": "T12", "Neck": "T8",
    "Head": "Neck",
    **{
        f"{side}{part}": above if above in {"T8", "Pelvis"} else f"{side}{above}"
        for side in ("Right", "Left")
        for part, above in (
            ("Shoulder", "T8"), ("UpperArm", "Shoulder"), ("ForeArm", "UpperArm"),
            ("Hand", "ForeArm"), ("UpperLeg", "Pelvis"), ("LowerLeg", "UpperLeg"),
            ("Foot", "LowerLeg"), ("Toe", "Foot"),
        )
    },
}  # fmt: skip
"""The segments of a body with their parents."""
NORMAL = {"normal", ""}
"""Types of frames that belong to the take; others are calibration poses."""
DEFAULT_RATE_HZ = 60.0
BLOCK_BYTES = 65_536


def is_mvnx(head: bytes) -> bool:
    """Return whether a file is of MVN, from its first bytes."""
    return re.search(rb"<mvnx[\s>]", head) is not None


class MvnxSubject(NamedTuple):
    """An actor as in the file."""

    label: str
    rate: float
    segments: list[str]
    frames: list[tuple[Array, Array]]
    """Numbers of positions and orientations."""


def open_mvnx(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[Motion]:
    """Open a take of Xsens MVN (`.mvnx`), in meters, Z up.

    Frames of the types identity, tpose and tpose-isb, which come first, are left out. Bones
    are the mean of the segments' origins seen from their parents.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: 1.
    progress : Progress

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, declares entities, or has no positions and orientations
        of the segments of a body.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    _refuse_declarations(path)
    subjects = _subjects(path, progress)
    n_frames = max(len(subject.frames) for subject in subjects)
    names = UniqueNames()
    listed = tuple(
        observed_body(
            names.give(printable(subject.label) or str(number)),
            np.arange(len(subject.frames)),
            max(n_frames, 1),
            n_frames / subject.rate,
        )
        for number, subject in enumerate(subjects, start=1)
    )
    unit = 1.0 if scale is None else scale

    def read(index: int, progress: Progress) -> Motion:
        return _motion(path, subjects[index], unit)

    return Bodies(str(path), listed, read)


def _subjects(path: Path | str, progress: Progress) -> list[MvnxSubject]:
    """Return all subjects; one without frames if there is none."""
    subjects: list[MvnxSubject] = []
    names: list[str] = []
    frames: list[tuple[Array, Array]] = []
    try:
        for element in _elements(path):
            tag = element.tag.rpartition("}")[2]
            if tag == "segment":
                names.append(element.get("label", ""))
            elif tag == "frame" and element.get("type", "") in NORMAL:
                frames.append(_frame(element))
                if len(frames) % 100 == 0:
                    progress(0.5, "Reading")
            elif tag == "subject":
                rate = common_rate(float(element.get("frameRate", DEFAULT_RATE_HZ)))
                subjects.append(MvnxSubject(element.get("label", ""), rate, names, frames))
                names, frames = [], []
    except (ParseError, ValueError, LookupError):
        raise InvalidFileError(f"{path} is damaged or cut short. Export it again.") from None
    except FileNotFoundError:
        raise InvalidFileError(f"There is no file {path}.") from None
    return subjects or [MvnxSubject("", DEFAULT_RATE_HZ, names, frames)]


def _motion(path: Path | str, subject: MvnxSubject, scale: float) -> Motion:
    names, frames = subject.segments, subject.frames
    known = [index for index, name in enumerate(names) if name in PARENTS]
    kept = sorted(known, key=lambda index: list(PARENTS).index(names[index]))
    ordered = [names[index] for index in kept]
    sizes = {(len(positions), len(rotations)) for positions, rotations in frames}
    if ordered[:1] != ["Pelvis"] or sizes != {(3 * len(names), 4 * len(names))}:
        raise InvalidFileError(
            f"{path} has no positions and orientations of the segments of a body. Export it"
            " from MVN with both."
        )
    positions = scale * np.array([each for each, _ in frames]).reshape(len(frames), -1, 3)
    rotations = np.array([each for _, each in frames]).reshape(len(frames), -1, 4)
    parents = [_parent(ordered, name) for name in ordered]
    try:
        motion = motion_from_world_poses(
            ordered,
            parents,
            _facing_front(positions[:, kept]),
            _facing_front(rotations[:, kept]),
            subject.rate,
        )
    except InvalidFileError as error:
        raise InvalidFileError(f"{path}: {error}. Export it again.") from None
    return replace(motion, conventions=file_conventions("Z", "X", scale))


def _parent(names: list[str], name: str) -> int:
    """Return the index of the nearest segment above that the file has; -1 for the root."""
    while (name := PARENTS[name]) and name not in names:
        pass
    return names.index(name) if name else -1


def _facing_front(values: Array) -> Array:
    """Turn positions x y z, or quaternions w x y z, by a quarter from +X to -Y."""
    front, left = values[..., -3], values[..., -2]
    return np.asarray(
        np.concatenate(
            [values[..., :-3], left[..., None], -front[..., None], values[..., -1:]], axis=-1
        )
    )


def _frame(element: Element) -> tuple[Array, Array]:
    """Return the numbers of positions and orientations of a frame."""
    found = {child.tag.rpartition("}")[2]: child.text or "" for child in element}
    positions, rotations = (
        np.array(found.get(name, "").split(), dtype=float)
        for name in ("position", "orientation")
    )
    return positions, rotations


def _elements(path: Path | str) -> Iterator[Element]:
    """Yield elements when they end, and forget frames after."""
    with open_regular(path) as file:
        for _, element in iterparse(file, events=("end",)):
            yield element
            if element.tag.endswith(("}frame", "}segment")) or element.tag in {
                "frame",
                "segment",
            }:
                element.clear()


def _refuse_declarations(path: Path | str) -> None:
    """Raise InvalidFileError where XML would expand entities, which may grow without end.

    All that stands before the first element is parsed: a declaration can stand nowhere else.
    """
    found: list[str] = []
    parser = ParserCreate()
    parser.StartDoctypeDeclHandler = lambda *_: found.append("declaration")
    parser.StartElementHandler = lambda *_: found.append("element")
    try:
        with open_regular(path) as file:
            while not found and (block := file.read(BLOCK_BYTES)):
                parser.Parse(block)
    except FileNotFoundError:
        raise InvalidFileError(f"There is no file {path}.") from None
    except ExpatError:
        pass  # the reader reports it
    if "declaration" in found[:1]:
        raise InvalidFileError(
            f"{path} declares a document type, which is not read. Export it from MVN without"
            " one."
        )
