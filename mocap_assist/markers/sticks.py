"""Sticks between markers: a mesh of edges whose vertices follow the markers by nodes."""

from collections.abc import Sequence

import bpy

from ..actions.markers.holders import STICKS
from ..blender.data_names import fitting_name
from ..scene.scene_objects import add_unselected

COLUMN, ROW = 220.0, 140.0
"""Distances of nodes in the editor, units of the editor. Any values that keep them apart."""


def build_sticks(
    context: bpy.types.Context,
    holder: bpy.types.Object,
    empties: Sequence[bpy.types.Object],
    pairs: Sequence[tuple[int, int]],
) -> bpy.types.Object | None:
    """Add edges between pairs of markers, below their parent; None if there are no pairs.

    Blender moves them, so they follow the markers without this extension, too.
    """
    if not pairs:
        return None
    used = sorted({index for pair in pairs for index in pair})
    vertex_of = {index: vertex for vertex, index in enumerate(used)}
    name = fitting_name(f"{holder.name} sticks")
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(
        [empties[index].location for index in used],
        [(vertex_of[one], vertex_of[other]) for one, other in pairs],
        [],
    )
    sticks = bpy.data.objects.new(name, mesh)
    sticks[STICKS] = True
    sticks.parent = holder
    sticks.hide_render = True
    add_unselected(context, sticks)
    tree = _nodes(name, [empties[index] for index in used])
    sticks.modifiers.new("Follow Markers", "NODES").node_group = tree
    return sticks


def _nodes(name: str, empties: Sequence[bpy.types.Object]) -> bpy.types.NodeTree:
    """Return nodes that set vertex k of a mesh to the position of empty k."""
    tree = bpy.data.node_groups.new(name, "GeometryNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        tree.interface.new_socket(
            "Geometry", in_out=direction, socket_type="NodeSocketGeometry"
        )
    given, index, switch, moved, made = (
        tree.nodes.new(kind)
        for kind in (
            "NodeGroupInput", "GeometryNodeInputIndex", "GeometryNodeIndexSwitch",
            "GeometryNodeSetPosition", "NodeGroupOutput",
        )
    )  # fmt: skip
    switch.data_type = "VECTOR"
    switch.index_switch_items.clear()
    for row, empty in enumerate(empties):
        switch.index_switch_items.new()
        info = tree.nodes.new("GeometryNodeObjectInfo")
        info.transform_space = "RELATIVE"
        info.inputs["Object"].default_value = empty
        info.location = (-COLUMN, -ROW * row)
        info.hide = True
        tree.links.new(info.outputs["Location"], switch.inputs[1 + row])
    for column, node in enumerate((given, moved, made)):
        node.location = (COLUMN * (column + 1), ROW)
    index.location, switch.location = (0.0, ROW), (COLUMN, 0.0)
    tree.links.new(index.outputs[0], switch.inputs[0])
    tree.links.new(given.outputs[0], moved.inputs["Geometry"])
    tree.links.new(switch.outputs[0], moved.inputs["Position"])
    tree.links.new(moved.outputs[0], made.inputs[0])
    return tree
