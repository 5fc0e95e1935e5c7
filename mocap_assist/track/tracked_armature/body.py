"""The tracked body that an armature stores, and the positions of its segments."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import lru_cache

import bpy
import numpy as np

from ....solvers.arrays import Array
from ....solvers.depth_scene import FloorPlane, ForegroundMethod, ForegroundSettings
from ....solvers.depth_tracking.body import CAPSULES, LENGTHS, SEGMENTS, BodyModel, rest_frames
from ....solvers.errors import InvalidMotionError, MocapAssistError
from ....solvers.rotations import fit_similarity
from ....solvers.settings import with_present_names
from ...blender.stored_json import parse_stored, store_json
from ...depth.depth_preview import Shown

KEY = "mocap_assist_tracked"
"""Custom property of an armature's data: body and recording, as JSON."""
ROLE = "mocap_assist_joint"
"""Custom property of a bone: its joint of the body, independent of its name."""
DIGITS = 6
"""Number of stored decimals of lengths and radii: rounding to a micrometer."""
MAX_CACHED = 8
"""Number of parsed bodies that are kept. It bounds the memory."""
REST_TOLERANCE_M = 0.01
"""Maximum deviation, meters, of bones from the original rest pose. It guards armatures that
were edited: the pose would be that of another body."""


@dataclass(frozen=True, eq=False)
class TrackedBody:
    """Actor and recording of an armature's motion."""

    body: BodyModel
    shown: Shown
    floor: FloorPlane | None
    actor: ForegroundSettings
    person: int | None = None
    """Index of the actor among all people; None if only one was tracked."""

    def write(self, armature: bpy.types.Object, bones: Mapping[str, str]) -> None:
        """Store this in an armature; `bones` maps joints of the body to bones."""
        lengths = np.round(self.body.lengths, DIGITS).tolist()
        radii = np.round(self.body.radii, DIGITS).tolist()
        floor = self.floor
        stored = {
            "lengths": dict(zip(LENGTHS, lengths, strict=True)),
            "radii": dict(zip(CAPSULES, radii, strict=True)),
            "shown": self.shown.as_dict(),
            "floor": None if floor is None else [*floor.up.tolist(), floor.height],
            "actor": {**asdict(self.actor), "actor_mask": self.actor.actor_mask.name},
            "person": self.person,
        }
        store_json(armature.data, KEY, stored)
        for joint, bone in bones.items():
            armature.data.bones[bone][ROLE] = joint

    @classmethod
    def read(cls, armature: bpy.types.Object) -> "TrackedBody":
        """Return the stored body; raises MocapAssistError if it is missing or damaged."""
        try:
            return _parsed(armature.data[KEY])
        except (ValueError, TypeError, KeyError, MocapAssistError):
            raise InvalidMotionError(
                f"{armature.name} is not a tracked armature. Select one that Track has created."
            ) from None


@lru_cache(maxsize=MAX_CACHED)
def _parsed(text: str) -> TrackedBody:
    stored = parse_stored(text, dict)
    floor = stored["floor"]
    actor = with_present_names(ForegroundSettings, stored["actor"])
    return TrackedBody(
        BodyModel(
            np.array([stored["lengths"][name] for name in LENGTHS]),
            np.array([stored["radii"][name] for name in CAPSULES]),
        ),
        Shown.of(stored["shown"]),
        None if floor is None else FloorPlane(np.array(floor[:3]), float(floor[3])),
        ForegroundSettings(**actor | {"actor_mask": ForegroundMethod[actor["actor_mask"]]}),
        None if stored.get("person") is None else int(stored["person"]),
    )


def is_tracked(armature: bpy.types.Object | None) -> bool:
    """Whether Track has created this armature."""
    return armature is not None and armature.type == "ARMATURE" and KEY in armature.data


def bones_of(armature: bpy.types.Object) -> dict[str, str]:
    """Return the bone of each of the `SEGMENTS`; raises InvalidMotionError if one is missing.

    Copies of a bone share its role and come later in the list.
    """
    bones: dict[str, str] = {}
    for bone in armature.data.bones:
        bones.setdefault(str(bone.get(ROLE, "")), bone.name)
    missing = [name for name in SEGMENTS if name not in bones]
    if missing:
        raise InvalidMotionError(
            f"{armature.name} has lost its bones for {', '.join(missing)}. Track again."
        )
    return bones


def armature_from_motion(armature: bpy.types.Object, body: BodyModel) -> Array:
    """Return the transform (4, 4) from the motion's space, in meters, to the armature's.

    It is estimated from the rest pose and includes applied transforms.

    Raises
    ------
    InvalidMotionError
        The bones at rest do not have the proportions of the body.
    """
    bones = bones_of(armature)
    heads = np.array([armature.data.bones[bones[name]].head_local for name in SEGMENTS])
    rest = rest_frames(body)[:, :3, 3]
    rotation, scale, shift = fit_similarity(rest, heads)
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = scale * rotation, shift
    off = np.abs(rest @ matrix[:3, :3].T + matrix[:3, 3] - heads).max()
    if off > REST_TOLERANCE_M * scale:
        raise InvalidMotionError(
            f"The rest pose of {armature.name} has changed. Undo the changes of Edit Mode, or"
            " track again."
        )
    return matrix


def posed_frames(armature: bpy.types.Object, body: BodyModel) -> Array:
    """Return the posed segments' frames (17, 4, 4) in the armature's space."""
    bones = bones_of(armature)
    rest = armature_from_motion(armature, body) @ rest_frames(body)
    names = [bones[name] for name in SEGMENTS]
    posed = np.array([armature.pose.bones[name].matrix for name in names])
    rest_matrices = np.array([armature.data.bones[name].matrix_local for name in names])
    frames: Array = posed @ np.linalg.inv(rest_matrices) @ rest
    return frames
