"""Files of other programs that are refused, each with the format to export instead."""

import re
from collections.abc import Callable

OLD_PICKLE = re.compile(
    rb"\(dp?\d|\(lp?\d|\}q[\x00-\xff]|\]q[\x00-\xff]|c(copy_reg|copyreg|numpy|torch|__builtin__)"
)
"""First bytes of pickles of protocol 0 and 1."""
HDF5 = b"\x89HDF\r\n\x1a\n"
SAFETENSORS = re.compile(rb"[\x00-\xff]{8}\s*\{\s*\"[^\"]+\"\s*:\s*\{\s*\"(dtype|format)\"")
HTR = re.compile(rb"(?:\s*#[^\n]*\n)*\s*\[Header\]\s*(#[^\n]*\n\s*)*FileType\s+[hg]tr")
PRINTED_JOINT = re.compile(rb"Joint \d+: Position\(|Joint info:\s+position: \[")
"""The first joint as programs on the sensor's SDK print it, in C++ or Python."""

THREE_TRACK = re.compile(
    rb"\"(?:tracks|hierarchy)\"\s*:\s*\[\s*\{[^\[\]]{0,300}\"(?:times|keys)\"\s*:\s*\["
    rb"|\"name\"\s*:\s*\"[^\"]{1,200}\.(?:quaternion|position|scale)\"\s*,\s*"
    rb"\"(?:times|values|type)\"\s*:"
)
"""The first track of an AnimationClip, whose name is that of a bone and its property."""
SOURCE_ENGINE = re.compile(rb"(?:\s*//[^\n]*\n)*\s*version\s+1\s+nodes\s+\d+\s+\"")
LIVE_2D = re.compile(rb"\"Target\"\s*:\s*\"(Model|Parameter|PartOpacity)\"\s*,\s*\"Id\"")
SIMULATED = re.compile(rb"\s*\{\s*\"Loop\"\s*:\s*\"?\w+\"?\s*,[^\[{]*\"Frames\"\s*:\s*\[\s*\[")

Detector = Callable[[bytes], bool]


def _starts(*magic: bytes) -> Detector:
    return lambda head: head.lstrip().startswith(magic)


def _member(*names: bytes) -> Detector:
    """Return a function that detects an archive whose first members have one of these names."""
    return lambda head: head[:4] == b"PK\x03\x04" and any(name in head[:300] for name in names)


def is_old_pickle(head: bytes) -> bool:
    """Detect pickles of protocol 0 and 1, which Python 2 wrote."""
    return OLD_PICKLE.match(head) is not None


PROGRAMS: tuple[tuple[str, Detector, str], ...] = (
    (
        "MikuMikuDance motion",
        _starts(b"Vocaloid Motion Data"),
        "{path} is a motion of MikuMikuDance. Import it with MMD Tools, select its armature,"
        " and use Clean there.",
    ),
    (
        "SMD",
        lambda head: SOURCE_ENGINE.match(head) is not None,
        "{path} is a model or motion of the Source engine. Import it with Blender Source Tools,"
        " select its armature, and use Clean there.",
    ),
    (
        "MD5",
        _starts(b"MD5Version"),
        "{path} is a model or motion of Doom 3. Import it with an add-on for MD5, select its"
        " armature, and use Clean there.",
    ),
    (
        "model of a game engine",
        _starts(b"xof 03", b"INTERQUAKEMODEL\0", b"3DMO"),
        "{path} is a model for games. Convert it to FBX or GLB, with its animation.",
    ),
    (
        "motion of Live2D",
        lambda head: LIVE_2D.search(head) is not None,
        "{path} is a motion of Live2D, which moves a drawing and has no joints. Export the body"
        " of the take as BVH, FBX or GLB where it was recorded.",
    ),
    (
        "motion of DeepMimic",
        lambda head: SIMULATED.match(head) is not None,
        "{path} is a motion for simulations, without its skeleton. Import the recording that it"
        " was made of.",
    ),
    (
        "analog signals",
        lambda head: re.match(rb"(?i)\s*File_Type:\s+Analog", head) is not None,
        "{path} holds signals of force plates or muscles, and no markers. Import the TRC or C3D"
        " of the take.",
    ),
    (
        "TRB",
        lambda head: head.startswith(b"\0" * 4 + b"\xff" * 4) and head[12:16] == b"\1\1\1\0",
        "{path} is a TRB file of Cortex or EVaRT. Export TRC or C3D there.",
    ),
    (
        "Blender file",
        _starts(b"BLENDER"),
        "{path} is a Blender file. Open it, or append the action from it, and use Clean there.",
    ),
    (
        "Maya scene",
        lambda head: (
            head.lstrip().startswith((b"//Maya ASCII", b"animVersion"))
            or (head[:4] in {b"FOR4", b"FOR8"} and b"Maya" in head[:64])
        ),
        "{path} is a file of Maya. Export the skeleton with its animation as FBX.",
    ),
    (
        "Unity asset",
        lambda head: head.startswith(b"%YAML") and b"tag:unity3d.com" in head[:200],
        "{path} is an asset of Unity. Export the animated character as FBX, with the FBX"
        " Exporter.",
    ),
    (
        "HTR",
        lambda head: HTR.match(head) is not None,
        "{path} is an HTR or GTR file. Export it as BVH, FBX or C3D.",
    ),
    (
        "OpenSim model",
        lambda head: b"<OpenSimDocument" in head[:400],
        "{path} is a file of OpenSim without positions of joints. Import the TRC of the take.",
    ),
    (
        "DAZ file",
        lambda head: b'"file_version"' in head[:200] and b'"asset_info"' in head,
        "{path} is a file of DAZ Studio. Export the figure with its animation as BVH or FBX.",
    ),
    (
        "printout of Azure Kinect joints",
        lambda head: PRINTED_JOINT.search(head) is not None,
        "{path} is a printout of the joints of one frame of the Azure Kinect. Save all frames"
        " as the JSON of its offline_processor, or as a table with columns such as Pelvis_x.",
    ),
    (
        "MATLAB 7.3 file",
        _starts(b"MATLAB 7.3"),
        "{path} is a MATLAB 7.3 file, which is HDF5. Save it again in MATLAB, with"
        " save(file, '-v7').",
    ),
    (
        "HDF5",
        _starts(HDF5),
        "{path} is an HDF5 file. Save its 3D points as a NumPy array of the shape (frames,"
        " joints, 3), with numpy.save.",
    ),
    (
        "columns of data science",
        _starts(b"PAR1", b"ARROW1"),
        "{path} is a table of Parquet or Arrow. Save it as CSV where it was made, such as with"
        " pandas.read_parquet(file).to_csv(file).",
    ),
    (
        "common data format",
        _starts(b"\xcd\xf3\x00\x01", b"\xcd\xf2\x60\x02"),
        "{path} is a CDF file, as of Human3.6M. Save its 3D joints as a NumPy array of the"
        " shape (frames, joints, 3), with numpy.save.",
    ),
    (
        "clip of three.js",
        lambda head: THREE_TRACK.search(head) is not None,
        "{path} is an animation of three.js. Export the animated model as GLB, with its"
        " GLTFExporter.",
    ),
    (
        "tensors",
        lambda head: SAFETENSORS.match(head) is not None,
        "{path} holds tensors. Save the pose as .npz where it was made: numpy.savez(file,"
        " global_orient=..., body_pose=..., transl=...), one row per frame.",
    ),
    (
        "workbook",
        _member(b"[Content_Types].xml", b"xl/"),
        "{path} is a workbook. Save its table of positions as CSV, or export BVH or MVNX from"
        " the program that wrote it.",
    ),
    (
        "USD archive",
        _member(b".usdc", b".usda"),
        "{path} is read by Blender's own importers. Import it in Blender, or run blender"
        " --background --command mocap_assist import.",
    ),
)
"""Name, detection from the first bytes, and the sentence, with `{path}` for the file."""
