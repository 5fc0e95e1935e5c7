"""Change the axes and size of what was imported, by turning its object."""

from dataclasses import asdict, dataclass
from typing import NamedTuple

import bpy
from mathutils import Matrix, Quaternion

from ...solvers.errors import InvalidMotionError
from ...solvers.motion import FileConventions
from ...solvers.recordings import Axis, FloorPlacement, FloorPlacementSettings, Unit
from ...solvers.recordings.conventions import floor_level, rotation_between, with_axes
from ...solvers.settings import setting
from ..actions.armature_read import read_take
from ..actions.markers.take import read_markers
from ..blender import compat
from ..scene.origin import note_origin, noted_conventions, origin_of
from ..scene.units import unit_of

OWN_CHANNELS = {
    "location",
    "rotation_euler",
    "rotation_quaternion",
    "rotation_axis_angle",
    "scale",
}


@dataclass(frozen=True, kw_only=True)
class AxesChange(FloorPlacementSettings):
    """Axes for another reading of an imported file."""

    up: Axis = setting(Axis.AUTO, "Axis of the file that points up; Auto keeps it")
    forward: Axis = setting(
        Axis.AUTO, "Axis of the file along which the actor faces; Auto keeps it"
    )
    unit: Unit = setting(Unit.GUESS, "Length unit of the file; Auto keeps it")
    global_scale: float = setting(
        0.0,
        "Scale the recording by this value; 1 leaves it in meters, 0 keeps the current scale",
        minimum=0.0,
        maximum=1e6,
        label="Scale",
    )


class AxesBundle(NamedTuple):
    """Settings of the button."""

    change: AxesChange


def imported_object(context: bpy.types.Context) -> bpy.types.Object | None:
    """Return the active armature or markers if they were imported here; None otherwise."""
    active = context.view_layer.objects.active
    for each in (active, active.parent if active is not None else None):
        if each is not None and noted_conventions(origin_of(each)) is not None:
            return each
    return None


def why_fixed(context: bpy.types.Context) -> str:
    """Return why the button is gray, or an empty text."""
    found = imported_object(context)
    if found is None:
        return "Select an armature or markers that Mocap Assist imported"
    if found.library is not None:
        return f"{found.name} is linked from another file; change it there"
    return ""


def noted_change(owner: bpy.types.Object) -> AxesChange:
    """Return the axes and scale that an imported object has now."""
    origin = origin_of(owner)
    noted = noted_conventions(origin) or FileConventions()
    return AxesChange(
        up=Axis.of(noted.up),
        forward=Axis.of(noted.forward),
        global_scale=_scale_of(origin),
        place_on_floor=FloorPlacement.AUTO,
    )


def change_axes(context: bpy.types.Context, owner: bpy.types.Object, change: AxesChange) -> str:
    """Rotate and scale an imported object as if its file had other axes; return a message.

    Only the object is turned: its actions, raw and cleaned, stay as they are.

    Raises
    ------
    InvalidMotionError
        The object is itself animated.
    InvalidSettingError
        Up and Forward are the same axis.
    """
    _refuse_animated(owner)
    origin = origin_of(owner)
    before = noted_conventions(origin) or FileConventions()
    after = with_axes(before, change.up.axis, change.forward.axis)
    after = FileConventions(**{**asdict(after), "unit": change.unit.meters or before.unit})
    scale = change.global_scale or _scale_of(origin)
    factor = scale / _scale_of(origin) * after.unit / before.unit
    rotation = Quaternion(rotation_between(before, after)).to_matrix().to_4x4()
    owner.matrix_basis = owner.matrix_basis @ rotation @ Matrix.Scale(factor, 4)
    note_origin(owner, origin | asdict(after) | {"scale": scale})
    floor = change.place_on_floor
    if floor is FloorPlacement.ALWAYS or (
        floor is FloorPlacement.AUTO and not before.has_floor
    ):
        _put_on_floor(context, owner)
    context.view_layer.update()
    return f"{owner.name}: {after.sentence()}, scaled by {scale:g}."


def _scale_of(origin: dict[str, object]) -> float:
    scale = origin.get("scale", 1.0)
    return float(scale) if isinstance(scale, int | float) and scale > 0.0 else 1.0


def _refuse_animated(owner: bpy.types.Object) -> None:
    animation = owner.animation_data
    if animation is None or animation.action is None or animation.action_slot is None:
        return
    bag = compat.channelbag(animation.action, animation.action_slot)
    if bag and any(curve.data_path in OWN_CHANNELS for curve in bag.fcurves):
        raise InvalidMotionError(
            f"{owner.name} is itself animated, so its rotation would not last. Import the file"
            " again with other axes."
        )


def _put_on_floor(context: bpy.types.Context, owner: bpy.types.Object) -> None:
    """Move an object so that the lowest level that its actor rests on is height 0."""
    context.view_layer.update()
    if owner.type == "ARMATURE":
        level = floor_level(read_take(owner, context.scene).parts[0].motion)
    else:
        level = floor_level(read_markers(owner, context.scene).tracks)
    lift = Matrix.Translation((0.0, 0.0, -level / unit_of(context.scene)))
    owner.matrix_world = lift @ owner.matrix_world
