"""Read `.skeleton` files of NTU RGB+D: bodies of a Kinect v2 as text."""

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...motion import SENSOR_JOINTS, JointRecording, Sensor
from ...progress import Progress, Remark, unwatched, within
from ..containers import read_bytes, read_rows
from ..conventions import (
    DEFAULT_FRAME_RATE,
    Bodies,
    JointSamples,
    bodies_of_frames,
    check_scale,
    from_kinect_space,
    joint_recording,
    no_body_error,
    stack_body_frames,
)
from ..identities import follow_bodies
from .kinect_csv import checked_states

NAMES = SENSOR_JOINTS[Sensor.KINECT_V2]
HEAD = re.compile(
    rb"\s*\d+\s*\n\s*\d{1,2}[ \t]*\r?\n"
    rb"(?:\s*\d{1,2}[ \t]*\r?\n)*(?:\s*\d+(?:[ \t]+[-+.\de]+){9}\s|\s*\Z)",
    re.IGNORECASE,
)
BODY_WORDS, JOINT_WORDS = 10, 12
MAX_BODIES = 6
"""Maximum number of bodies that a Kinect v2 tracks."""
Frames = list[dict[bytes, range]]


def is_ntu_skeleton(head: bytes) -> bool:
    """Return whether the first bytes are counts of frames and bodies, and data of a body."""
    return HEAD.match(head) is not None


def open_ntu_skeleton(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[JointRecording]:
    """Open an NTU RGB+D `.skeleton` file [1]_, in meters, Z up; joints not tracked are NaN.

    Bodies are identified by their id, in any order, and numbered as they appear. Frames
    without the body are gaps. Identity switches are undone (`follow_bodies`). Of several
    bodies, those with damaged numbers are left out and reported. Image coordinates,
    orientations, hand states and lean are not read. The files have no times; the Kinect v2
    records 30 frames per second.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: meters.
    progress : Progress

    Returns
    -------
    Bodies of JointRecording
        All 25 joints of the Kinect v2 in its own order; the camera looks along +Y.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, truncated, or has no body.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [1] Shahroudy, Liu, Ng, Wang (2016). NTU RGB+D: a large scale dataset for 3D human
       activity analysis. CVPR. doi:10.1109/CVPR.2016.115
    """
    check_scale(scale)
    lines = read_bytes(path).splitlines()
    line_indices = [index for index, line in enumerate(lines) if line.strip()]
    frames = _find_bodies(lines, line_indices, path)
    if not any(frames):
        raise no_body_error(path)
    frames = _with_people_followed(lines, frames, path, progress)
    keys, bodies = bodies_of_frames(
        frames, len(frames) / DEFAULT_FRAME_RATE, lambda number, key: str(number)
    )

    def read(index: int, progress: Progress) -> JointRecording:
        joints = _read_body(lines, frames, keys[index], path, within(progress, 0.0, 0.9))
        return joint_recording(
            path,
            JointSamples(
                NAMES,
                from_kinect_space(joints[..., :3]),
                Sensor.KINECT_V2,
                states=checked_states(joints[..., 3], path),
            ),
            scale=scale,
            progress=progress,
        )

    progress(1.0, "Reading")
    return Bodies(str(path), bodies, read)


def _with_people_followed(
    lines: list[bytes], frames: Frames, path: Path | str, progress: Progress
) -> Frames:
    """Return frames in which identity switches of the sensor are undone.

    Damaged bodies are left out and reported if there are others.
    """
    keys = list(dict.fromkeys(key for frame in frames for key in frame))
    if len(keys) < 2:
        return frames
    points: dict[int, NDArray[np.float64]] = {}
    damaged: dict[bytes, InvalidFileError] = {}
    for number, key in enumerate(keys, start=1):
        found = [frame[key] for frame in frames if key in frame]
        part = within(progress, 0.7 * (number - 1) / len(keys), 0.7 * number / len(keys))
        try:
            rows = _read_joints(lines, found, path, part)
            checked_states(rows[..., -1], path)
        except InvalidFileError as error:
            damaged[key] = error
            progress(0.7, Remark(f"Body {number} is damaged and is left out: {error}"))
            continue
        points |= {joints.start: row[:, :3] for joints, row in zip(found, rows, strict=True)}
    if len(damaged) == len(keys):
        raise damaged[keys[0]]
    intact = [
        {key: joints for key, joints in frame.items() if key not in damaged} for frame in frames
    ]
    return follow_bodies(intact, lambda joints: points[joints.start], None, progress)


def _read_joints(
    lines: list[bytes], joints: list[range], path: Path | str, progress: Progress
) -> NDArray[np.float64]:
    """Return all words of the joints in these lines, shape (n_frames, n_joints, n_words)."""
    used = [index for each in joints for index in each]
    rows = read_rows(
        [lines[index] for index in used],
        JOINT_WORDS,
        path,
        [index + 1 for index in used],
        progress,
    )
    return rows.reshape(-1, len(NAMES), JOINT_WORDS)


def _read_body(
    lines: list[bytes], frames: Frames, body: bytes, path: Path | str, progress: Progress
) -> NDArray[np.float64]:
    """Return x, y, z and state of the joints of a body, shape (n_frames, n_joints, 4)."""
    found = [frame[body] for frame in frames if body in frame]
    rows = _read_joints(lines, found, path, progress)
    tracked = iter(np.concatenate([rows[..., :3], rows[..., -1:]], axis=-1))
    joints = stack_body_frames(
        body, [{body: next(tracked)} if body in frame else {} for frame in frames]
    )
    missing = np.isnan(joints).all(axis=(1, 2))
    joints[missing, :, 3] = 0.0
    return joints


def _find_bodies(lines: list[bytes], line_indices: list[int], path: Path | str) -> Frames:
    """Return the line indices of the joints of each body, by frame."""
    cursor = _Cursor(lines, line_indices, path)
    n_frames = cursor.count("the number of frames")
    frames: Frames = []
    while cursor.n_remaining:
        frame: dict[bytes, range] = {}
        for _ in range(cursor.count("the number of bodies", MAX_BODIES)):
            body = cursor.words("a body's id and nine words about it", BODY_WORDS)[0]
            n_joints = cursor.count("the number of joints")
            if n_joints != len(NAMES):
                raise cursor.error(f"{n_joints} joints instead of {len(NAMES)}")
            frame.setdefault(body, cursor.skip(n_joints))
        frames.append(frame)
    if len(frames) < n_frames:
        raise InvalidFileError(
            f"{path} is cut short: its first line states {n_frames} frames, but it has"
            f" {len(frames)}. Copy it again, or correct its first line."
        )
    return frames


class _Cursor:
    """Iterate over the nonblank lines."""

    def __init__(self, lines: list[bytes], line_indices: list[int], path: Path | str) -> None:
        self._lines, self._line_indices, self._path = lines, line_indices, path
        self._at = 0

    @property
    def n_remaining(self) -> int:
        """Number of remaining lines."""
        return len(self._line_indices) - self._at

    def words(self, what: str, n_words: int) -> list[bytes]:
        """Return the words of the next line."""
        if not self.n_remaining:
            raise InvalidFileError(
                f"{self._path} is cut short: it ends before {what}. Copy it again."
            )
        words = self._lines[self._line_indices[self._at]].split()
        if len(words) != n_words:
            raise self.error(f"{len(words)} words instead of {what}")
        self._at += 1
        return words

    def count(self, what: str, maximum: int = 10**9) -> int:
        """Return the number in the next line."""
        (word,) = self.words(what, 1)
        if not word.isdigit() or len(word) > 9 or int(word) > maximum:
            self._at -= 1
            raise self.error(f"something other than {what}")
        return int(word)

    def skip(self, n_lines: int) -> range:
        """Skip consecutive lines; return their indices in the file."""
        if self.n_remaining < n_lines:
            raise InvalidFileError(
                f"{self._path} is cut short: it ends within the joints of a body. Copy it"
                " again."
            )
        taken = self._line_indices[self._at : self._at + n_lines]
        if taken[-1] - taken[0] != n_lines - 1:
            raise self.error("a blank line among joints")
        self._at += n_lines
        return range(taken[0], taken[-1] + 1)

    def error(self, found: str) -> InvalidFileError:
        """Return the error for unexpected content of the next line, or of the last one."""
        index = self._line_indices[min(self._at, len(self._line_indices) - 1)]
        return InvalidFileError(
            f"{self._path}, line {index + 1}: found {found}. The file is damaged; copy it"
            " again."
        )
