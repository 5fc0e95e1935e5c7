"""The body that was tracked: kept with its armature, and where its segments are."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import lru_cache

import bpy
import numpy as np
from numpy.typing import NDArray

from ...solvers.depth_scene import Floor, ForegroundMethod, ForegroundSettings
from ...solvers.depth_tracking.body import CAPSULES, LENGTHS, SEGMENTS, BodyModel, rest_frames
from ...solvers.errors import InvalidMotionError, MocapAssistError
from ...solvers.rotations import fit_similarity
from ..blender.stored_json import parse_stored, store_json
from ..depth.depth_preview import Shown

Array = NDArray[np.float64]

KEY = "mocap_assist_tracked"
"""Custom property of an armature's data: the body, and the recording of it, as JSON."""
ROLE = "mocap_assist_joint"
"""Custom property of a bone: which joint of the body it is, whatever it is called."""
DIGITS = 6
N_KEPT = 8
EVEN = 0.01
"""Metres that bones at rest may be off before the rest pose counts as another one."""


@dataclass(frozen=True, eq=False)
class TrackedBody:
    """Whose motion an armature shows, and by which recording."""

    body: BodyModel
    shown: Shown
    floor: Floor | None
    actor: ForegroundSettings

    def write(self, armature: bpy.types.Object, bones: Mapping[str, str]) -> None:
        """Keep this with an armature, whose bones are given by the body's joints."""
        lengths = np.round(self.body.lengths, DIGITS).tolist()
        radii = np.round(self.body.radii, DIGITS).tolist()
        floor = self.floor
        told = {
            "lengths": dict(zip(LENGTHS, lengths, strict=True)),
            "radii": dict(zip(CAPSULES, radii, strict=True)),
            "shown": self.shown.told(),
            "floor": None if floor is None else [*floor.up.tolist(), floor.height],
            "actor": {**asdict(self.actor), "way": self.actor.way.name},
        }
        store_json(armature.data, KEY, told)
        for joint, bone in bones.items():
            armature.data.bones[bone][ROLE] = joint

    @classmethod
    def read(cls, armature: bpy.types.Object) -> "TrackedBody":
        """Return what is kept; raises MocapAssistError if nothing, or nothing whole."""
        try:
            return _parsed(armature.data[KEY])
        except (ValueError, TypeError, KeyError, MocapAssistError):
            raise InvalidMotionError(
                f"{armature.name} is not a tracked armature. Select one that Track has created."
            ) from None


@lru_cache(maxsize=N_KEPT)
def _parsed(text: str) -> TrackedBody:
    told = parse_stored(text, dict)
    floor, actor = told["floor"], told["actor"]
    return TrackedBody(
        BodyModel(
            np.array([told["lengths"][name] for name in LENGTHS]),
            np.array([told["radii"][name] for name in CAPSULES]),
        ),
        Shown.of(told["shown"]),
        None if floor is None else Floor(np.array(floor[:3]), float(floor[3])),
        ForegroundSettings(**actor | {"way": ForegroundMethod[actor["way"]]}),
    )


def is_tracked(armature: bpy.types.Object | None) -> bool:
    """Whether this is an armature that Track has made."""
    return armature is not None and armature.type == "ARMATURE" and KEY in armature.data


def bones_of(armature: bpy.types.Object) -> dict[str, str]:
    """Return the bone of each of the `SEGMENTS`; raises InvalidMotionError if one is gone.

    Copies of a bone have its role, too, and stand after it.
    """
    bones: dict[str, str] = {}
    for bone in armature.data.bones:
        bones.setdefault(str(bone.get(ROLE, "")), bone.name)
    gone = [name for name in SEGMENTS if name not in bones]
    if gone:
        raise InvalidMotionError(
            f"{armature.name} has no bones any more for {', '.join(gone)}. Track again."
        )
    return bones


def armature_from_motion(armature: bpy.types.Object, body: BodyModel) -> Array:
    """Return the similarity (4, 4) from the space of the motion, metres, to the armature's.

    It is found from the rest pose, so that transforms may have been applied to it.

    Raises
    ------
    InvalidMotionError
        The bones at rest are not as far apart as those of the body.
    """
    bones = bones_of(armature)
    there = np.array([armature.data.bones[bones[name]].head_local for name in SEGMENTS])
    rest = rest_frames(body)[:, :3, 3]
    rotation, scale, shift = fit_similarity(rest, there)
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = scale * rotation, shift
    off = np.abs(rest @ matrix[:3, :3].T + matrix[:3, 3] - there).max()
    if off > EVEN * scale:
        raise InvalidMotionError(
            f"The rest pose of {armature.name} is not the one that Track gave it. Undo what was"
            " changed in Edit Mode, or track again."
        )
    return matrix


def posed_frames(armature: bpy.types.Object, body: BodyModel) -> Array:
    """Return where the segments (17, 4, 4) are in the armature's space, as it is posed now."""
    bones = bones_of(armature)
    rest = armature_from_motion(armature, body) @ rest_frames(body)
    names = [bones[name] for name in SEGMENTS]
    posed = np.array([armature.pose.bones[name].matrix for name in names])
    still = np.array([armature.data.bones[name].matrix_local for name in names])
    frames: Array = posed @ np.linalg.inv(still) @ rest
    return frames
