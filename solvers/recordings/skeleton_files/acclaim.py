"""Read Acclaim recordings (AMC with the ASF of the actor): CMU's library and HDM05."""

import re
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError, InvalidSettingError
from ...motion import Motion, Skeleton
from ...progress import Progress, unwatched, within
from ...rotations import inverse, multiply, quaternion_from_euler
from ..containers import Block, LineReader, check_n_poses, parse_rows, shown
from ..conventions import (
    check_scale,
    file_conventions,
    rotations_z_up_from_y_up,
    unit_of_skeleton,
    z_up_from_y_up,
)
from .acclaim_skeleton import AcclaimBone, AcclaimSkeleton, read_acclaim_skeleton

LINES_OF_HEAD = 100
RADIANS = re.compile(rb"^[ \t]*:RADIANS", re.MULTILINE | re.IGNORECASE)


def read_acclaim(
    amc_path: Path | str,
    asf_path: Path | str | None = None,
    *,
    frame_rate: float = 120.0,
    scale: float | None = None,
    progress: Progress = unwatched,
) -> Motion:
    """Read an AMC file and the ASF file of its actor, converted from Y up to Z up.

    In these files a rotation M belongs to a bone and is relative to the bone's own axes C;
    C M C^-1 rotates the bone in rest-pose axes [1]_. Each bone becomes a joint of the same name
    at the start of the bone, and the last bone of a branch gets an end site. Bones that the
    recording never mentions stay at rest; a bone that is missing in single frames has a gap
    (NaN) there. Files of CMU and HDM05 omit one of the three angles of the feet, so toes are
    off by some centimeters when the ankle flexes far.

    Parameters
    ----------
    amc_path : Path or str
    asf_path : Path, str or None
        None: the file next to the AMC file with the same name, otherwise with the longest name
        that the name of the recording starts with.
    frame_rate : float, hertz
        AMC files do not store it. CMU and HDM05 were recorded at 120 Hz.
    scale : float, meters per unit of the files, or None
        None: 0.0254 / `length` of the ASF file, unless the size of the body makes another unit
        far more probable.
    progress : Progress

    Returns
    -------
    Motion

    Raises
    ------
    InvalidFileError
        A file is missing or damaged, or the two do not belong together.
    InvalidSettingError
        The frame rate or scale is not positive.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [1] Lander (1998). Working with motion capture file formats. Game Developer, January.
    """
    check_scale(scale)
    if not (np.isfinite(frame_rate) and frame_rate > 0.0):
        raise InvalidSettingError(f"A frame rate of {frame_rate} Hz is not positive.")
    skeleton = read_acclaim_skeleton(find_skeleton(amc_path) if asf_path is None else asf_path)
    reader = LineReader(amc_path)
    in_radians = RADIANS.search(b"\n".join(reader.peek(LINES_OF_HEAD)))
    angle_unit = 1.0 if in_radians else skeleton.angle_unit
    recorded = _read_channels(reader, skeleton, amc_path, within(progress, 0.0, 0.7))
    return _build_motion(
        skeleton, recorded, frame_rate, scale, angle_unit, within(progress, 0.7, 1.0)
    )


def find_skeleton(amc_path: Path | str) -> Path:
    """Return the ASF file of a recording in the same folder, by its name or as the only one.

    Raises
    ------
    InvalidFileError
        There is none, or the folder is missing or unreadable.
    """
    amc_path = Path(amc_path)
    try:
        others = sorted(amc_path.parent.iterdir())
    except OSError as error:
        raise InvalidFileError(
            f"The folder {amc_path.parent} cannot be searched for the skeleton of"
            f" {amc_path.name} ({error.strerror}). Name the .asf file, or move both."
        ) from None
    skeletons = [path for path in others if path.suffix.lower() == ".asf"]
    if len(skeletons) > 1:
        skeletons = [path for path in skeletons if amc_path.stem.startswith(path.stem)]
    if not skeletons:
        raise InvalidFileError(
            f"There is no skeleton for {amc_path}. Put the actor's .asf file next to it, under"
            " the same name or the beginning of it, or as the only one."
        )
    return max(skeletons, key=lambda path: len(path.stem))


class _Mentions(NamedTuple):
    """The lines of a block that describe one bone."""

    frames: NDArray[np.intp]
    rows: NDArray[np.float64]
    """Shape (n, n_channels)."""


def _read_channels(
    reader: LineReader, skeleton: AcclaimSkeleton, path: Path | str, progress: Progress
) -> dict[str, NDArray[np.float64]]:
    """Return the channels of each bone, shape (n_frames, n_channels), by its name."""
    bones = {bone.name.encode(): bone for bone in skeleton.bones}
    parts_by_bone: dict[bytes, list[_Mentions]] = {}
    n_frames = 0
    for block in reader.rest():
        frame_lines, mentions = _mentions(block, n_frames > 0, path)
        if unknown_bones := [
            shown(name.decode("ascii", "backslashreplace")) for name in mentions.keys() - bones
        ]:
            raise InvalidFileError(
                f"{path} moves bones that its skeleton does not have:"
                f" {', '.join(unknown_bones[:5])}. It belongs to another .asf file, or is"
                " damaged."
            )
        for name, numbers in mentions.items():
            texts = [
                block.lines[number - block.first].lstrip()[len(name) :] for number in numbers
            ]
            rows = parse_rows(texts, len(bones[name].channels), path, numbers)
            frames = np.searchsorted(frame_lines, numbers) - 1 + n_frames
            parts_by_bone.setdefault(name, []).append(_Mentions(frames, rows))
        n_frames += len(frame_lines)
        progress(block.stop, "Reading")
    if not parts_by_bone:
        raise InvalidFileError(f"{path} is not an Acclaim recording: nothing moves in it.")
    check_n_poses(path, n_frames, len(bones))
    return {bones[name].name: _table(parts, n_frames) for name, parts in parts_by_bone.items()}


def _table(parts: list[_Mentions], n_frames: int) -> NDArray[np.float64]:
    """Return a row for each frame, NaN where the bone is missing; empties the list."""
    table = np.full((n_frames, parts[0].rows.shape[1]), np.nan)
    parts.reverse()
    while parts:
        frames, rows = parts.pop()
        table[frames] = rows
    return table


def _mentions(
    block: Block, begun: bool, path: Path | str
) -> tuple[list[int], dict[bytes, list[int]]]:
    """Return the lines with frame numbers, and the lines of each bone.

    Lines are counted from 1. Bones are allowed only after the first frame has `begun`.
    """
    frame_lines: list[int] = []
    mentions: defaultdict[bytes, list[int]] = defaultdict(list)
    for number, line in enumerate(block.lines, start=block.first):
        words = line.split(None, 1)
        if not words or words[0][:1] in b"#:":
            continue
        if len(words) == 1 and words[0].isdigit():
            frame_lines.append(number)
        elif (begun or frame_lines) and len(words) == 2:
            mentions[words[0]].append(number)
        else:
            raise InvalidFileError(
                f"{path}, line {number}: neither a frame number nor a bone with its angles. The"
                " file is damaged, cut short or not an Acclaim recording."
            )
    return frame_lines, mentions


def _build_motion(
    skeleton: AcclaimSkeleton,
    recorded: dict[str, NDArray[np.float64]],
    frame_rate: float,
    scale: float | None,
    angle_unit: float,
    progress: Progress,
) -> Motion:
    """Build a motion from the recorded channels, which are emptied to save memory."""
    n_frames = len(next(iter(recorded.values())))
    names, parents, offsets = _joints(skeleton)
    rest = Skeleton(names, parents, z_up_from_y_up(offsets))
    if scale is None:
        scale = unit_of_skeleton(rest, progress, stated=skeleton.stated_unit)
    rotations = np.zeros((n_frames, len(names), 4))
    rotations[..., 0] = 1.0
    root_positions = np.tile(skeleton.position, (n_frames, 1))
    for joint, bone in enumerate(skeleton.bones):
        if bone.name not in recorded:
            continue
        columns = dict(zip(bone.channels, recorded.pop(bone.name).T, strict=True))
        local_rotations = _rotations_from_channels(bone, columns, angle_unit)
        rotations[:, joint] = rotations_z_up_from_y_up(local_rotations)
        if joint == 0:
            for axis, letter in enumerate("xyz"):
                root_positions[:, axis] = columns.get(f"t{letter}", root_positions[:, axis])
        progress((joint + 1) / len(skeleton.bones), "Reading")
    rest = replace(rest, offsets=scale * rest.offsets)
    positions = scale * z_up_from_y_up(root_positions)
    return Motion(rest, rotations, positions, frame_rate, file_conventions("Y", unit=scale))


def _joints(
    skeleton: AcclaimSkeleton,
) -> tuple[tuple[str, ...], tuple[int, ...], NDArray[np.float64]]:
    """Return names, parents and offsets, Y up, of the starts of bones and of end sites."""
    names = [bone.name for bone in skeleton.bones]
    parents = list(skeleton.parents)
    offsets = [skeleton.position]
    offsets += [skeleton.bones[parent].vector for parent in parents[1:]]
    for last in sorted(set(range(len(names))) - set(parents)):
        names.append(f"{names[last]}_end")
        parents.append(last)
        offsets.append(skeleton.bones[last].vector)
    return tuple(names), tuple(parents), np.array(offsets)


def _rotations_from_channels(
    bone: AcclaimBone, columns: Mapping[str, NDArray[np.float64]], angle_unit: float
) -> NDArray[np.float64]:
    """Return C M C^-1 as quaternions, shape (n_frames, 4), in the file's axes."""
    n_frames = len(next(iter(columns.values())))
    order = bone.order[::-1]  # The rotation that is applied first is the last factor.
    zero = np.zeros(n_frames)
    angles = np.stack([columns.get(f"r{axis.lower()}", zero) for axis in order], axis=-1)
    rotations = quaternion_from_euler(angle_unit * angles, order)
    rotations[np.isnan(rotations).any(axis=-1)] = np.nan
    return multiply(multiply(bone.frame, rotations), inverse(bone.frame))
