"""Read BVH files, the common format of capture software and clip libraries."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from ....errors import InvalidFileError
from ....motion import Motion
from ....progress import Progress, Remark, unwatched, within
from ...containers import LineReader, UniqueNames, check_n_poses, stream_rows
from ...conventions import (
    MIN_BODY_JOINTS,
    SWAPPED,
    Bodies,
    UpAxisName,
    check_scale,
    conventions_of,
    has_swapped_sides,
    mirror_motion,
    observed_body,
    reinterpreted,
    rotate_to_z_up,
    stand_upright,
)
from .channels import BvhChannels, motion_from_poses
from .frame_time import rate_of_frame_time
from .hierarchy import read_hierarchies

DEFAULT_RATE_HZ = 30.0
MIN_TYPICAL_RATE_HZ, MAX_POSES = 10.0, 20
"""Frames per second below which the rate of a file is unusual, and the most frames of a list of
poses, which has any rate. Chosen by hand: no capture software records less; programs that write
a frame time of 1 s, as examples of research do, were seen. They decide a sentence of the report
only."""
MIN_FRAMES_FRACTION = 0.9
"""Rows relative to the number in the header below which the file may be cut short. Chosen by
hand: some programs count one frame more than they write. It decides a sentence of the report
only."""
MAX_LINES_ABOVE = 4096
"""Lines above the hierarchy, such as comments. It bounds the search."""
MAX_HIERARCHY_BYTES = 1 << 24
"""Maximum length of the hierarchy, bytes."""


def read_bvh(
    path: Path | str,
    *,
    scale: float | None = None,
    up: UpAxisName | None = None,
    progress: Progress = unwatched,
) -> Motion:
    """Read a BVH file, converted from Y up, facing +Z, to Z up, facing -Y.

    The rest pose is that of the file. Rows are counted; a larger number of frames in the
    header, and an unusual rate, are reported. A missing frame time means 30 Hz; values that are
    not numbers are gaps.

    A `Motion` has bones of fixed length, so position channels of joints other than the root
    are approximated. In an unbranched chain below the root they move the root. Their median
    replaces the OFFSET of the joint, and a joint with a single child is rotated toward it.
    Channels that would shrink the skeleton to a point are added to the OFFSET instead. Of
    several ROOTs the first body is read (`open_bvh`).

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: estimated from the length of the bones (`unit_of_skeleton`): centimeters for most
        files, 0.0254 / 0.45 for those made from CMU's library.
    up : "X", "Y", "Z", "-X", "-Y", "-Z" or None
        None estimates it from the body (`estimate_up_axis`): Y, as the format has it, unless
        the actor would not stand. The axis of the rest pose is estimated by itself.
    progress : Progress

    Returns
    -------
    Motion
        Names are unique (`hand`, `hand_2`); end sites are joints `<parent>_end`.

    Raises
    ------
    InvalidFileError
        The file is missing, not BVH, damaged, truncated or without a frame.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    bodies = _read_bodies(path, scale, up, progress)
    if len(bodies) == 1:
        return bodies[0]
    return _bodies(path, bodies).read_one(None, progress)


def open_bvh(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[Motion]:
    """List the bodies of a file, one for each ROOT; they are read as `read_bvh` does."""
    check_scale(scale)
    if len(read_hierarchies(_hierarchy(LineReader(path), path), path)) > 1:
        return _bodies(path, _read_bodies(path, scale, None, progress))
    return Bodies(
        str(path), (), lambda _, progress: read_bvh(path, scale=scale, progress=progress)
    )


def _bodies(path: Path | str, motions: list[Motion]) -> Bodies[Motion]:
    """List the bodies of a file with several; small ones are props."""
    names = UniqueNames()
    listed = tuple(
        observed_body(
            names.give(each.skeleton.names[0]),
            np.flatnonzero(each.observed.any(axis=1)),
            each.n_frames,
            each.n_frames / each.frame_rate,
            is_person=each.n_joints >= MIN_BODY_JOINTS,
        )
        for each in motions
    )
    return Bodies(str(path), listed, lambda index, progress: motions[index])


def _read_bodies(
    path: Path | str, scale: float | None, up: UpAxisName | None, progress: Progress
) -> list[Motion]:
    """Read each body; the largest one shows unit, axes and sides of all."""
    reader = LineReader(path)
    bodies = read_hierarchies(_hierarchy(reader, path), path)
    stated_rate, n_announced = _frame_rate(reader, progress)
    frame_rate = stated_rate or DEFAULT_RATE_HZ
    widths = [sum(len(joint.channels) for joint in joints) for joints in bodies]
    if not sum(widths):
        raise InvalidFileError(f"{path} has no CHANNELS, so nothing in it moves.")
    rows = stream_rows(reader, sum(widths), path, within(progress, 0.0, 0.7))
    if not len(rows):
        raise InvalidFileError(f"{path} has no frames: nothing follows its Frame Time.")
    check_n_poses(path, len(rows), sum(map(len, bodies)))
    _check_header(len(rows), n_announced, stated_rate, progress)
    ends = np.cumsum(widths)
    columns = np.split(rows, ends[:-1], axis=1)
    del rows
    parts = pairwise(np.linspace(0.7, 1.0, len(bodies) + 1))
    poses = [
        BvhChannels(joints, columns.pop(0)).poses(within(progress, *ends))
        for joints, ends in zip(bodies, parts, strict=True)
    ]
    main = max(range(len(bodies)), key=lambda body: len(bodies[body]))
    first = motion_from_poses(bodies[main], poses[main], frame_rate, scale, progress)
    unit = conventions_of(first).unit
    first = stand_upright(first, progress) if up is None else reinterpreted(first, up, None)
    motions = [
        first
        if body == main
        else _rotated_like(
            first, motion_from_poses(joints, poses[body], frame_rate, unit, progress)
        )
        for body, joints in enumerate(bodies)
    ]
    if not has_swapped_sides(first):
        return motions
    progress(1.0, Remark(SWAPPED))
    return [mirror_motion(motion) for motion in motions]


def _check_header(
    n_frames: int, n_announced: int, frame_rate: float | None, progress: Progress
) -> None:
    """Report a number of frames, or a rate, that is probably wrong."""
    if n_frames < MIN_FRAMES_FRACTION * n_announced:
        progress(
            0.7,
            Remark(
                f"The file announces {n_announced} frames but has {n_frames}; it may be cut"
                " short"
            ),
        )
    if frame_rate is None:
        if n_frames > 1:
            progress(
                0.7, Remark(f"The file has no frame rate; {DEFAULT_RATE_HZ:g} Hz is assumed")
            )
    elif frame_rate < MIN_TYPICAL_RATE_HZ and n_frames > MAX_POSES:
        progress(
            0.7,
            Remark(
                f"The file states {frame_rate:.3g} frames per second, which is unusual; scale"
                " the keys in time if it plays too slowly"
            ),
        )


def _rotated_like(first: Motion, motion: Motion) -> Motion:
    """Turn another body of a file, read with Y up, as the first one was turned."""
    axes = conventions_of(first)
    rotated = rotate_to_z_up(motion, axes.up, axes.rest_up or axes.up)
    added = conventions_of(motion).offset_added
    return replace(rotated, conventions=replace(axes, offset_added=added))


def _hierarchy(reader: LineReader, path: Path | str) -> bytes:
    """Take the lines up to the word MOTION; return those before it."""
    lines: list[bytes] = []
    while (line := reader.peek()) and not _begins(line[0]) and len(lines) < MAX_LINES_ABOVE:
        reader.take()
        lines.append(b"")
    if not line or not _begins(line[0]):
        raise InvalidFileError(f"{path} is not a BVH file: it does not begin with HIERARCHY.")
    length = 0
    while (line := reader.take()) and length < MAX_HIERARCHY_BYTES:
        if line[0].strip(b" \t").upper() == b"MOTION":
            return b"\n".join(lines)
        lines += line
        length += len(line[0])
    raise InvalidFileError(f"{path} has no MOTION section: it is cut short. Export it again.")


def _begins(line: bytes) -> bool:
    return line.lstrip().upper().startswith(b"HIERARCHY")


def _frame_rate(reader: LineReader, progress: Progress) -> tuple[float | None, int]:
    """Take the lines before the first frame; return the rate in hertz, and how many follow.

    The rate is None where none is stated, or one that no recording has.
    """
    rate: float | None = None
    n_frames = 0
    while line := reader.peek():
        words = line[0].lower().replace(b":", b" ").split()
        if words[:2] == [b"frame", b"time"] and len(words) > 2:
            stated = b" ".join(words[2:]).decode("ascii", "replace")
            rate = rate_of_frame_time(stated, progress)
        elif (
            words[:1] == [b"frames"] and words[1:] and words[1].isdigit() and len(words[1]) < 10
        ):
            n_frames = int(words[1])
        elif words and not words[0].startswith(b"frame"):
            break
        reader.take()
    return rate, n_frames
