"""Refuse files that are recognized but hold no recording, and report what to do instead."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple, Never

from ..errors import InvalidFileError
from ..files import open_regular
from ..progress import Progress, unwatched
from .other_programs import PROGRAMS, is_old_pickle

SCENE_MAGIC = (b"Kaydara FBX Binary", b"; FBX", b"glTF", b"PXR-USDC", b"#usda")

COMPRESSED = (
    b"\x1f\x8b", b"BZh", b"\xfd7zXZ", b"\x28\xb5\x2f\xfd", b"\x04\x22\x4d\x18", b"7z\xbc\xaf",
    b"Rar!", b"\x78\x01", b"\x78\x5e", b"\x78\x9c", b"\x78\xda",
)  # fmt: skip
"""First bytes of gzip, bzip2, xz, zstd, LZ4, 7-Zip, RAR and, of joblib, zlib."""
COCO = re.compile(
    rb'"(image_id|category_id|num_keypoints|keypoint_scores|bbox)"'
    rb'|"keypoints"\s*:\s*\[\s*\[\s*[-+\d.e]+\s*,\s*[-+\d.e]+\s*\]'
)
TRIPLES = re.compile(
    rb'"keypoints"\s*:\s*\[\s*\[\s*[-+\d.e]+\s*,\s*[-+\d.e]+\s*,\s*[-+\d.e]+\s*\]'
)
"""Points with a third coordinate, which may be a score: `point_arrays` decides that."""
DEEPLABCUT = re.compile(
    rb"scorer,[^\r\n]*\r?\n(individuals,[^\r\n]*\r?\n)?bodyparts,[^\r\n]*\r?\n(?!coords,x,y,z,)"
)
"""Its tables of images; those of several cameras have a third coordinate."""
OPENSIM_BODIES = re.compile(rb"#?\s*times?\s*,\s*(\w+)_x\s*,\s*\1_y\s*,\s*\1_z\s*,\s*\1_rotx")


class Refusal(NamedTuple):
    """A kind of file that is not read."""

    name: str
    fits: Callable[[bytes], bool]
    """Detection from the first bytes."""
    sentence: str
    """What is wrong and what to do; `{path}` is the file."""

    def read(
        self, path: Path | str, /, *, scale: float | None = None, progress: Progress = unwatched
    ) -> Never:
        """Raise InvalidFileError with the sentence."""
        raise InvalidFileError(self.sentence.format(path=path))


def _is_acclaim_skeleton(head: bytes) -> bool:
    text = re.sub(rb"(?m)^\s*#.*$", b"", head).lstrip()
    return re.match(rb"(?i):(version|name|units|root)\b", text) is not None


def _is_scene_file(head: bytes) -> bool:
    return head.startswith(SCENE_MAGIC) or b"<COLLADA" in head[:512]


def _is_flat(head: bytes) -> bool:
    """Detect the keypoints of OpenPose, COCO and DeepLabCut, which lie in a picture."""
    has_depth = re.search(rb'"pose_keypoints_3d"\s*:\s*\[\s*[-\d]', head)
    openpose = b'"pose_keypoints_2d"' in head or re.search(
        rb'\s*\{\s*"version"\s*:[^{]*"people"\s*:\s*\[\s*\]', head
    )
    coco = re.match(rb"\s*[\[{]", head) and (
        (b'"keypoints"' in head and COCO.search(head) and not TRIPLES.search(head))
        or (b'"annotations"' in head and b'"image_id"' in head)
        or re.match(rb'\s*\{\s*"(info|images|licenses)"\s*:.*"(license|file_name)"', head, re.S)
    )
    return bool((openpose and not has_depth) or coco or DEEPLABCUT.match(head))


def _is_video(head: bytes) -> bool:
    """Detect MP4, QuickTime and AVI; Matroska may hold depth."""
    return head[4:8] in {b"ftyp", b"moov", b"mdat"} or (
        head[:4] == b"RIFF" and head[8:12] == b"AVI "
    )


def _is_opensim(head: bytes) -> bool:
    return b"endheader" in head or OPENSIM_BODIES.match(head) is not None


def _is_pickle(head: bytes) -> bool:
    """Detect pickles, also those in the archives of PyTorch, joblib and NumPy."""
    in_archive = head[:4] == b"PK\x03\x04" and b"data.pkl" in head[:300]
    in_array = head[:6] == b"\x93NUMPY" and b"'|O'" in head[:128]
    is_new = head[:1] == b"\x80" and head[1:2] in b"\x02\x03\x04\x05"
    return in_archive or in_array or is_new or is_old_pickle(head)


def _is_web_page(head: bytes) -> bool:
    return re.match(rb"(?i)\s*(<!--.*?-->\s*)?<(!doctype html|html\b)", head, re.S) is not None


def _is_compressed(head: bytes) -> bool:
    """Detect archives other than those of NumPy."""
    return head.startswith(COMPRESSED) or (
        head[:4] == b"PK\x03\x04" and b".npy" not in head[:300]
    )


STAND_INS = (
    Refusal(
        "web page",
        _is_web_page,
        "{path} is a web page that was saved under this name. Download the file itself.",
    ),
    Refusal(
        "Git LFS pointer",
        lambda head: head.startswith(b"version https://git-lfs"),
        "{path} is a Git LFS pointer, not the file itself. Get the file with git lfs pull,"
        " or download it.",
    ),
)
"""Files that stand where another one should be, whatever the name."""
REFUSALS = (
    *STAND_INS,
    Refusal("empty file", lambda head: not head.strip(), "{path} is empty. Export it again."),
    Refusal(
        "mocopi packets",
        lambda head: b"sony motion format" in head[:64],
        "{path} holds packets that mocopi sent. Record in its app, and import the BVH.",
    ),
    Refusal(
        "video",
        _is_video,
        "{path} is a video. Run a video model on it, such as GVHMR or MediaPipe, and import"
        " the 3D motion that it saves.",
    ),
    Refusal(
        "Acclaim ASF",
        _is_acclaim_skeleton,
        "{path} is a skeleton without motion. Choose its .amc file instead.",
    ),
    Refusal(
        "FBX, glTF or USD",
        _is_scene_file,
        "{path} is read by Blender's own importers. Import it in Blender, or run blender"
        " --background --command mocap_assist import.",
    ),
    Refusal(
        "2D keypoints",
        _is_flat,
        "{path} holds 2D keypoints of images, without depth. Import the triangulated TRC of"
        " Pose2Sim, or the 3D output of your tracker.",
    ),
    Refusal(
        "OpenSim motion",
        _is_opensim,
        "{path} holds results of OpenSim, which need its model. Import the TRC of the same"
        " take.",
    ),
    Refusal(
        "pickle",
        _is_pickle,
        "{path} is a pickle, which is never opened here: it may run any program. Where it was"
        " made, convert it with to_npz.py from the documentation of SMPL files, or with"
        " numpy.savez(file, global_orient=..., body_pose=..., transl=...), one row per frame.",
    ),
    *(Refusal(*each) for each in PROGRAMS),
    Refusal(
        "compressed file",
        _is_compressed,
        "{path} is compressed. Unpack it and import the file in it; a compressed pickle has to"
        " be saved as .npz where it was made, with numpy.savez.",
    ),
)


def refuse_stand_ins(path: Path | str) -> None:
    """Raise InvalidFileError for a web page or a pointer that stands where a file should be."""
    with open_regular(path) as file:
        head = file.read(512)
    for each in STAND_INS:
        if each.fits(head):
            each.read(path)
