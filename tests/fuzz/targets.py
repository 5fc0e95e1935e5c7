"""Fuzzing targets: every reader and loader, with a small complete seed file.

The files are made by tests/fixtures; of ../shared/data/formats smaller ones are added.
"""

import io
import json
import re
import zipfile
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
from complete_files import COMPLETE, JOINT_FILES, JOINT_TOKENS, RECORDING, SKELETON, TOKENS
from depth_files import depth_npz, matlab, pictures
from exports.complete_exports import EXPORT_TOKENS, EXPORTS
from fuzz_seeds import (
    QUERY,
    body_files,
    clip_library,
    crowds,
    depth_folders,
    journal_of,
    lines_of_joints,
    live_frame,
    png,
    raw_depth,
    scene_json,
    smpl_json,
    stream_packets,
)
from learned_files import LEARNED, npz
from mkv_files import k4a

from solvers.command_line.sharing import Records
from solvers.depth_scene.recording import DepthRecording
from solvers.errors import MocapAssistError
from solvers.json_text import parse_json
from solvers.motion import read_humanoid_map
from solvers.progress import unwatched
from solvers.recordings import DepthSettings, open_bodies, read_depth, read_recording
from solvers.recordings.containers.png_header import read_png_header
from solvers.recordings.depth_files.folder import is_depth_folder
from solvers.recordings.streams import StreamDecoder, StreamProtocol
from solvers.recordings.streams.frames.joint_frames import decode_frame
from solvers.retrieval import Clip, find_similar, load_clip_library

DATA = Path(__file__).parents[1] / "data"
FORMATS = Path(__file__).parents[3] / "shared" / "data" / "formats"
MAX_BYTES = 60_000
MAX_SEED_BYTES = 20_000
OWN_CAMERA = DepthSettings(fx=9.0, fy=8.0)
OWN_UNIT = DepthSettings(fx=9.0, fy=8.0, scale=0.001)
DEPTH = pictures(5)
BONE_MAP = b'{"kind":"mocap_assist humanoid map","version":1,"joints":{"hips":"a"}}'
BINARY_TOKENS = [
    b"\0\0\0\0", b"\xff\xff\xff\xff", b"\x01\0\0\0", b"\x80",
    b"\x01\xff\xff\xff\xff\xff\xff\xff",
    b"\x0e\0\0\0\xff\xff\xff\x7f", b"(1, 4096, 4096)", b"'<f8'", b"PK\x03\x04", b"\xa3\x81",
    b"SQLite format 3\0", b"\x50", b"POINT", b"RATE",
]  # fmt: skip


class Target(NamedTuple):
    """A reader, a complete file for it, and tokens to damage it with."""

    seed: bytes
    read: Callable[[Path], object]
    tokens: list[bytes]
    name: str = "take"
    """Of the file; a reader may look at its ending."""
    required_files: tuple[tuple[str, bytes], ...] = ()
    """Other files that the reader needs, by name."""
    is_archive: bool = False
    """Whether it is a zip, whose members are damaged before they are packed."""
    is_database: bool = False
    """Whether it is a library, of which also cells and tables are damaged."""


def read_target(target: Target, content: bytes, folder: Path) -> None:
    """Read the content as the target's file: it is read or refused in one sentence."""
    for name, other in target.required_files:
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
            COMPLETE[kind], read_recording, TOKENS, f"take.{kind}", (("take.asf", SKELETON),)
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
    for kind, content in EXPORTS.items():
        found[kind] = Target(content, read_recording, EXPORT_TOKENS)
    for kind, content in crowds().items():
        found[f"crowd_{kind}"] = Target(content, _read_bodies, JOINT_TOKENS)
    for kind, content in body_files().items():
        is_archive = content.startswith(b"PK")
        found[kind] = Target(content, _read_bodies, BINARY_TOKENS, is_archive=is_archive)
    found["smpl_json"] = Target(smpl_json(), _read_bodies, JOINT_TOKENS)
    found["lines_of_joints"] = Target(lines_of_joints(), _read_bodies, JOINT_TOKENS)
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
    library = clip_library()
    found["clip_library"] = Target(library, _search, BINARY_TOKENS, "a.clips", is_database=True)
    found["clip_journal"] = Target(
        journal_of(library),
        lambda path: _search(path.with_name("a.clips")),
        BINARY_TOKENS,
        "a.clips-journal",
        (("a.clips", library),),
    )
    found["depth_raw"] = Target(raw_depth(), _read_depth, BINARY_TOKENS)
    found["png"] = Target(
        png(DEPTH[0]), lambda path: read_png_header(path.parent, path.name), BINARY_TOKENS
    )
    for kind, content in depth_folders().items():
        found[f"folder_{kind}"] = Target(
            content, _read_folder, [*TOKENS, *BINARY_TOKENS], is_archive=True
        )
    found["json"] = Target(scene_json(), _read_json, JOINT_TOKENS)
    found |= stream_targets()
    found["bone_map"] = Target(
        BONE_MAP,
        read_humanoid_map,
        JOINT_TOKENS,
        "a.json",
    )
    found["batch_record"] = Target(
        b'{"walk.bvh": {"version": "0.1.0", "options": {}, "figures": {"a": 1}}}',
        lambda path: [*Records(path.parent).former()],
        JOINT_TOKENS,
        "mocap_assist.json",
    )
    return found


def stream_targets() -> dict[str, Target]:
    """Return the targets of live streams."""
    found = {"live_frame": Target(live_frame(), _read_frames, JOINT_TOKENS)}
    for protocol, packet in stream_packets().items():
        found[f"stream_{protocol.value}"] = Target(
            packet, partial(_read_packet, protocol), [*JOINT_TOKENS, *BINARY_TOKENS]
        )
    return found


def seeds(name: str, target: Target) -> Iterator[bytes]:
    """Yield complete files to begin with: our own, those that were found and, where they are,
    small ones of others."""
    yield target.seed
    for path in [*sorted(DATA.glob(f"*/{name}/*")), *sorted(FORMATS.glob(f"{name}/*"))]:
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


def _read_bodies(path: Path) -> None:
    bodies = open_bodies(path)
    for index in bodies.choose("all")[:3]:
        bodies.read(index, unwatched)
    read_recording(path)


def _read_depth(path: Path) -> DepthRecording:
    return read_depth(path, OWN_CAMERA)


def _read_frames(path: Path) -> list[object]:
    return [decode_frame(line) for line in path.read_bytes().split(b"\n")[:20]]


def _read_packet(protocol: StreamProtocol, path: Path) -> list[object]:
    decoder = StreamDecoder(protocol)
    parts = decoder.parts(path.read_bytes())[:20]
    return [frame for part in parts for frame in decoder.decode(part, 0.0)]


def _search(path: Path) -> object:
    with load_clip_library(path) as library:
        entries = library.numbered()
        postures = [library.postures(number) for number in list(entries)[:3]]
        found = find_similar(QUERY, library)
        library.add([Clip("more", QUERY)])
        library.remove(["more"])
        return postures, found, library.refused("1")


def _read_folder(path: Path) -> int:
    """Read a folder of depth images, which come packed as a zip."""
    with TemporaryDirectory(dir=path.parent) as folder:
        for name, content in _members_or_none(path.read_bytes()).items():
            inside = Path(folder) / name
            inside.parent.mkdir(parents=True, exist_ok=True)
            inside.write_bytes(content)
        is_depth_folder(Path(folder))
        recording = read_depth(folder, OWN_UNIT)
        for frame in range(min(recording.n_frames, 3)):
            recording.frame(frame)
            recording.color(frame)
        return recording.n_frames


def _members_or_none(content: bytes) -> dict[str, bytes]:
    """Return the files in a zip of a folder; only such names as ours are made."""
    try:
        members = members_of(content)
    except Exception:
        return {}
    return {
        name: inside
        for name, inside in members.items()
        if re.fullmatch(r"([a-z]+/)?[\w]+(\.[\w]+)*", name)
    }


def _read_json(path: Path) -> object:
    """Read JSON as scenes, permissions and reports keep it; what was read can be written."""
    try:
        return json.dumps(parse_json(path.read_bytes()))
    except ValueError:
        return None
