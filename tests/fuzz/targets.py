"""What is fuzzed: every reader and loader, with a small complete file to begin with.

The files are made by tests/fixtures; of ../shared/data/formats smaller ones join them.
"""

import io
import sqlite3
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
from depth_files import depth_npz, matlab, pictures
from learned_files import LEARNED, npz
from mkv_files import k4a
from whole_files import JOINT_FILES, JOINT_TOKENS, RECORDING, SKELETON, TOKENS, WHOLE

from solvers.command_line.batch import Made
from solvers.errors import MocapAssistError
from solvers.motion import read_humanoid_map
from solvers.motion.depth_recording import DepthRecording
from solvers.recordings import DepthSettings, read_depth, read_recording
from solvers.recordings.live_frames import LiveFrame, decode_frame, encode_frame
from solvers.retrieval import Clip, build_clip_library, load_clip_library
from solvers.samples import GaitSettings, walking_gait

FORMATS = Path(__file__).parents[3] / "shared" / "data" / "formats"
MAX_SEED_BYTES = 20_000
OWN_CAMERA = DepthSettings(fx=9.0, fy=8.0)
DEPTH = pictures(5)
BONE_MAP = b'{"kind":"mocap_assist humanoid map","version":1,"joints":{"hips":"a"}}'
BINARY_TOKENS = [
    b"\0\0\0\0", b"\xff\xff\xff\xff", b"\x01\0\0\0", b"\x80",
    b"\x01\xff\xff\xff\xff\xff\xff\xff",
    b"\x0e\0\0\0\xff\xff\xff\x7f", b"(1, 4096, 4096)", b"'<f8'", b"PK\x03\x04", b"\xa3\x81",
    b"SQLite format 3\0", b"\x50", b"POINT", b"RATE",
]  # fmt: skip


class Target(NamedTuple):
    """A reader, a complete file for it, and pieces of which damage is made."""

    seed: bytes
    read: Callable[[Path], object]
    tokens: list[bytes]
    name: str = "take"
    """Of the file; a reader may look at its ending."""
    beside: tuple[tuple[str, bytes], ...] = ()
    """Other files that the reader needs, by name."""
    is_archive: bool = False
    """Whether it is a zip, whose members are damaged before they are packed."""


def read_target(target: Target, content: bytes, folder: Path) -> None:
    """Read the content as the target's file: it is read or refused in one sentence."""
    for name, other in target.beside:
        (folder / name).write_bytes(other)
    path = folder / target.name
    path.write_bytes(content)
    try:
        found = target.read(path)
        if isinstance(found, DepthRecording):
            for frame in {0, found.n_frames // 2, found.n_frames - 1}:
                found.frame(frame)
                found.color(frame)
    except MocapAssistError as error:
        sentence = str(error)
        assert sentence.endswith("."), sentence
        assert "\n" not in sentence, sentence


def targets() -> dict[str, Target]:
    """Return all targets by name."""
    found = {
        kind: Target(
            WHOLE[kind], read_recording, TOKENS, f"take.{kind}", (("take.asf", SKELETON),)
        )
        for kind in ("bvh", "c3d", "trc", "amc")
    }
    found["asf"] = Target(
        SKELETON,
        lambda path: read_recording(path.with_suffix(".amc")),
        TOKENS,
        "take.asf",
        (("take.amc", RECORDING),),
    )
    for kind, (_, content) in JOINT_FILES.items():
        found[kind.replace(" ", "_")] = Target(content, read_recording, JOINT_TOKENS)
    depth = {"depth_mat": matlab("depth", DEPTH.transpose(1, 2, 0)), "depth_mkv": k4a(DEPTH)}
    for kind, content in depth.items():
        found[kind] = Target(content, _read_depth, BINARY_TOKENS)
    found["depth_npz"] = Target(
        depth_npz(DEPTH, color=np.zeros((5, 6, 8, 3), np.uint8)),
        _read_depth,
        BINARY_TOKENS,
        is_archive=True,
    )
    for kind, learned in LEARNED.items():
        name = kind.replace(" ", "_")
        content = npz(learned.arrays)
        found[name] = Target(content, learned.load, BINARY_TOKENS, is_archive=True)
    found["clip_library"] = Target(_clip_library(), _search, BINARY_TOKENS, "a.clips")
    found["live_frame"] = Target(_live_frame(), _read_frames, JOINT_TOKENS)
    found["bone_map"] = Target(
        BONE_MAP,
        read_humanoid_map,
        JOINT_TOKENS,
        "a.json",
    )
    found["batch_record"] = Target(
        b'{"walk.bvh": {"version": "0.1.0", "options": {}, "figures": {"a": 1}}}',
        lambda path: Made(path.parent).notes,
        JOINT_TOKENS,
        "mocap_assist.json",
    )
    return found


def seeds(name: str, target: Target) -> Iterator[bytes]:
    """Yield complete files to begin with: our own and, where they are, foreign small ones."""
    yield target.seed
    for path in sorted(FORMATS.glob(f"{name}/*")) if FORMATS.is_dir() else ():
        if path.is_file() and path.stat().st_size <= MAX_SEED_BYTES:
            yield path.read_bytes()


def members_of(archive: bytes) -> dict[str, bytes]:
    """Return the unpacked members of a zip, by name."""
    with zipfile.ZipFile(io.BytesIO(archive)) as file:
        return {name: file.read(name) for name in file.namelist()}


def packed(members: dict[str, bytes]) -> bytes:
    """Return a zip of these members."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as file:
        for name, content in members.items():
            file.writestr(name, content)
    return buffer.getvalue()


def _read_depth(path: Path) -> DepthRecording:
    return read_depth(path, OWN_CAMERA)


def _read_frames(path: Path) -> list[object]:
    return [decode_frame(line) for line in path.read_bytes().split(b"\n")[:20]]


def _live_frame() -> bytes:
    positions = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 1.7]])
    frame = LiveFrame(0.1, 1, ("hips", "head"), positions, np.array([1.0, 0.9]))
    return encode_frame(frame).rstrip(b"\n")


def _clip_library() -> bytes:
    walk = walking_gait(GaitSettings(duration=2.0, frame_rate=30.0))
    with TemporaryDirectory() as folder:
        path = Path(folder) / "a.clips"
        build_clip_library([Clip("walk", walk, ("calm",))]).save(path)
        database = sqlite3.connect(path)
        database.execute("VACUUM")
        database.close()
        return path.read_bytes()


def _search(path: Path) -> object:
    with load_clip_library(path) as library:
        entries = library.numbered()
        postures = [library.postures(number) for number in list(entries)[:3]]
        return postures, library.blocks, library.vocabulary
