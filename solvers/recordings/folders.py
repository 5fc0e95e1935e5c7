"""Find the recordings in folders."""

from collections.abc import Callable, Sequence
from pathlib import Path

from ..faults import Failure, attempt
from .containers import files_below, frame_files, is_folder, names_by_number
from .depth_files import is_depth_folder
from .formats import detect_format
from .read_recording import is_depth_recording

FRAME_SUFFIXES = (".json", ".npy", ".npz")
"""Endings of files that may hold a single frame."""
MAX_FRAME_BYTES = 1 << 20
"""Size of a file, bytes, above which it holds more than one frame. It bounds the run time: the
joints of ten people take 100 kB as text."""


def recordings_in(folder: Path) -> list[Path]:
    """Return the recordings in a folder and its subfolders, sorted by name.

    Skip hidden files and folders, and skeletons without motion. Include files and folders that
    cannot be opened: the reader reports the reason. A take with a file per frame is listed once
    (`one_path_per_take`).
    """
    return one_path_per_take([path for path in files_below(folder) if may_contain_motion(path)])


def one_path_per_take(paths: Sequence[Path]) -> list[Path]:
    """Return the paths without the further files of takes that have a file per frame."""
    waiting = dict.fromkeys(path for path in paths if path.suffix.lower() in FRAME_SUFFIXES)
    names: dict[Path, list[str]] = {}
    for path in waiting:
        names.setdefault(path.parent, []).append(path.name)
    named = {folder: names_by_number(each) for folder, each in names.items()}
    further: set[Path] = set()
    for path in [*waiting]:
        if path not in waiting:
            continue
        files = [*frame_files(path, named[path.parent]).files.values()]
        if len(files) > 1 and _is_one_frame(max(files, key=_size)):
            further.update(each for each in files if each != path)
        for each in files:
            waiting.pop(each, None)
    return [path for path in paths if path not in further]


def _size(path: Path) -> int:
    found = attempt(path, path.stat)
    return 0 if isinstance(found, Failure) else found.st_size


def _is_one_frame(path: Path) -> bool:
    """Whether a file holds one frame of a take that has a file for each."""
    if _size(path) > MAX_FRAME_BYTES:
        return False
    format_ = attempt(path, detect_format, path)
    if isinstance(format_, Failure) or format_ is None or format_.is_one_frame is None:
        return False
    return attempt(path, format_.is_one_frame, path) is True


def may_contain_motion(path: Path) -> bool:
    """Whether a file is a recording by its first bytes, or cannot be opened."""
    format_ = attempt(path, detect_format, path)
    return format_ is not None and not getattr(format_, "is_refused", False)


def depth_takes_in(
    folder: Path, is_take: Callable[[Path], bool] = is_depth_folder
) -> list[Path]:
    """Return the depth recordings in a folder and below, by name; or the folder itself.

    A folder of images is one recording and is not searched. Skip hidden files and folders, and
    links to folders. Include files and folders that cannot be opened: the reader reports the
    reason.

    Parameters
    ----------
    folder : Path
    is_take : callable
        Returns whether a folder is one recording.
    """
    paths = files_below(folder, is_take)
    return [
        path for path in paths if is_folder(path) or attempt(path, is_depth_recording, path)
    ]


def takes_in(folder: Path) -> list[Path]:
    """Return the recordings in a folder and below, depth images included, by name.

    A folder of depth images is one recording: files in it are none.
    """
    depth = depth_takes_in(folder)
    others = [path for path in recordings_in(folder) if not {path, *path.parents} & set(depth)]
    return sorted([*others, *depth])


def describe_no_recording(folder: Path, needing_blender: Sequence[Path]) -> str:
    """Return that a folder has no recordings, and the way if it has files that need Blender."""
    text = f"There is no recording in the folder {folder}."
    if needing_blender:
        file = needing_blender[0].name
        text += (
            f" To import files such as {file}, press Fix Folder in Blender, or run"
            f" blender --background --command mocap_assist each {folder} --output-folder DIR"
            " -- import."
        )
    return text
