"""The nodes that draw a mesh's vertices as points."""

import bpy

NAME = "Depth Points"
MADE = "mocap_assist_depth_points"
"""Custom property that marks the node group, even if it was renamed."""
POINT_RADIUS_M = 0.006
OBSERVED = "seen"
"""Attribute of a point: whether the camera measured a depth there."""


def point_nodes() -> bpy.types.NodeTree:
    """Return the node group that shows the observed vertices as points."""
    existing = next((each for each in bpy.data.node_groups if each.get(MADE) == OBSERVED), None)
    if existing is not None and existing.library is None:
        return existing
    tree = bpy.data.node_groups.new(NAME, "GeometryNodeTree")
    tree[MADE] = OBSERVED
    for direction in ("INPUT", "OUTPUT"):
        tree.interface.new_socket(
            "Geometry", in_out=direction, socket_type="NodeSocketGeometry"
        )
    given, points, made = (
        tree.nodes.new(kind)
        for kind in ("NodeGroupInput", "GeometryNodeMeshToPoints", "NodeGroupOutput")
    )
    attribute = tree.nodes.new("GeometryNodeInputNamedAttribute")
    attribute.data_type = "BOOLEAN"
    attribute.inputs["Name"].default_value = OBSERVED
    points.inputs["Radius"].default_value = POINT_RADIUS_M
    for column, node in enumerate((given, points, made)):
        node.location = (220.0 * column, 0.0)
    attribute.location = (0.0, -140.0)
    selection = next(socket for socket in attribute.outputs if socket.enabled)
    tree.links.new(given.outputs[0], points.inputs["Mesh"])
    tree.links.new(selection, points.inputs["Selection"])
    tree.links.new(points.outputs[0], made.inputs[0])
    return tree
