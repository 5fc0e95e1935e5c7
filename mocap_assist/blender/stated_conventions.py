"""Axes and unit that the files of other programs state, which Blender's importers follow."""

import re
import struct
from typing import NamedTuple

import bpy

from ...solvers.errors import InvalidFileError
from ...solvers.files import open_regular
from ...solvers.motion import AxisName, FileConventions
from ...solvers.recordings import suffix_by_content
from ...solvers.recordings.conventions import CENTIMETER

HEAD_BYTES = 1 << 20
"""Of a file; each of these formats states its axes near its beginning."""
MAX_PROPERTY_BYTES = 200
BINARY_FBX = b"Kaydara FBX Binary"
FBX_CODES = {b"I": "<i", b"D": "<d"}
FBX_AXES: tuple[AxisName, ...] = ("X", "Y", "Z")
Y_UP: tuple[AxisName, AxisName] = ("Y", "Z")
Z_UP: tuple[AxisName, AxisName] = ("Z", "-Y")


class UsdStage(NamedTuple):
    """What a USD file states about all that is in it."""

    up: str
    unit: float
    """Meters."""
    frame_rate: float
    """Times of its keys per second, hertz."""


def read_stage(path: str) -> UsdStage:
    """Return what a USD file states, text or binary, by the USD library that Blender has.

    Raises
    ------
    InvalidFileError
        The file is damaged, or this Blender was built without the library's Python part.
    """
    bpy.utils.expose_bundled_modules()
    try:
        from pxr import Usd, UsdGeom
    except ImportError:
        raise InvalidFileError(
            f"{path} is a USD file, whose frame rate this Blender cannot read. Convert it to"
            " FBX or glTF, or use Blender from blender.org."
        ) from None
    try:
        stage = Usd.Stage.Open(path, Usd.Stage.LoadNone)
    except RuntimeError:
        raise InvalidFileError(f"{path} is damaged or incomplete. Export it again.") from None
    rate = float(stage.GetTimeCodesPerSecond())
    # In some files the number has single precision, which GetStageMetersPerUnit refuses.
    stated = stage.GetPseudoRoot().GetMetadata("metersPerUnit")
    unit = UsdGeom.LinearUnits.centimeters if stated is None else float(stated)
    return UsdStage(str(UsdGeom.GetStageUpAxis(stage)), unit, rate)


def stated_conventions(path: str) -> FileConventions:
    """Return up, forward and unit as a file states them, or as its format defines them."""
    with open_regular(path) as file:
        head = file.read(HEAD_BYTES)
    suffix = suffix_by_content(path)
    up, unit = "Y", 1.0
    if suffix == ".fbx":
        axis = _fbx_number(head, b"UpAxis")
        up = FBX_AXES[int(axis)] if axis in {0.0, 1.0, 2.0} else "Y"
        unit = CENTIMETER * (_fbx_number(head, b"UnitScaleFactor") or 1.0)
    elif suffix == ".dae":
        up = "Z" if re.search(rb"<up_axis>\s*Z_UP", head) else "Y"
        unit = _number(rb"<unit[^>]*meter\s*=\s*\"([^\"]*)\"", head)
    elif suffix.startswith(".usd"):
        up, unit, _ = read_stage(path)
    return FileConventions(*(Z_UP if up == "Z" else Y_UP), unit if unit > 0.0 else 1.0)


def _number(pattern: bytes, head: bytes) -> float:
    found = re.search(pattern, head)
    try:
        return float(found[1]) if found else 1.0
    except ValueError:
        return 1.0


def _fbx_number(head: bytes, name: bytes) -> float | None:
    """Return a number of the global settings of an FBX file, binary or text."""
    index = head.find(name)
    if index < 0:
        return None
    rest = head[index + len(name) : index + len(name) + MAX_PROPERTY_BYTES]
    if not head.startswith(BINARY_FBX):
        text = re.match(rb'"(?:\s*,\s*"[^"]*")*\s*,\s*([-+.\deE]+)', rest)
        return _number(rb"([-+.\deE]+)", text[1]) if text else None
    start = 0
    while rest[start : start + 1] == b"S":  # the type and flags of the property, as texts
        start += 5 + int.from_bytes(rest[start + 1 : start + 5], "little")
    code = FBX_CODES.get(rest[start : start + 1])
    raw = rest[start + 1 : start + 1 + struct.calcsize(code or "")]
    return float(struct.unpack(code, raw)[0]) if code and len(raw) > 3 else None
