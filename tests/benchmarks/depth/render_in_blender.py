"""Blender moves a skinned body and renders its depth: run by `blender_depth.py`.

`python render_in_blender.py SCENE.npz OUT.npz`. Bones get local rotations, the mesh follows by
vertex groups, and Cycles returns how far each pixel sees; nothing of ours is called.
"""

import os
import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix

FAR = 1000.0
AHEAD = np.array([0.0, 0.05, 0.0])


def main(source: str, target: str) -> None:
    """Render each pose of the scene."""
    with np.load(source) as archive:
        scene = {name: archive[name] for name in archive.files}
    bpy.ops.wm.read_factory_settings(use_empty=True)
    rig = _rig(scene)
    _mesh(scene, rig)
    _camera(scene)
    depths = []
    with tempfile.TemporaryDirectory() as folder:
        for frame in range(len(scene["rotations"])):
            _pose(rig, scene, frame)
            depths.append(_rendered(Path(folder) / f"{frame:04d}.exr", scene))
    np.savez_compressed(target, depth=np.array(depths))
    os._exit(0)  # bpy may hang when the interpreter closes.


def _rig(scene: dict[str, np.ndarray]) -> bpy.types.Object:
    """Make an armature whose bones point along +Y, so that bone and world axes agree."""
    armature = bpy.data.armatures.new("rig")
    rig = bpy.data.objects.new("rig", armature)
    bpy.context.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    for name, parent, head in zip(
        scene["names"], scene["parents"], scene["heads"], strict=True
    ):
        bone = armature.edit_bones.new(str(name))
        bone.head, bone.tail, bone.roll = head, head + AHEAD, 0.0
        if parent >= 0:
            bone.parent = armature.edit_bones[str(scene["names"][parent])]
    bpy.ops.object.mode_set(mode="OBJECT")
    return rig


def _mesh(scene: dict[str, np.ndarray], rig: bpy.types.Object) -> None:
    mesh = bpy.data.meshes.new("body")
    mesh.from_pydata(scene["vertices"].tolist(), [], scene["triangles"].tolist())
    mesh.materials.append(_depth_material())
    body = bpy.data.objects.new("body", mesh)
    bpy.context.collection.objects.link(body)
    for joint, name in enumerate(scene["names"]):
        group = body.vertex_groups.new(name=str(name))
        weights = scene["weights"][:, joint]
        for vertex in np.flatnonzero(weights).tolist():
            group.add([vertex], float(weights[vertex]), "REPLACE")
    body.modifiers.new("rig", "ARMATURE").object = rig


def _depth_material() -> bpy.types.Material:
    material = bpy.data.materials.new("depth")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    camera_data, light = nodes.new("ShaderNodeCameraData"), nodes.new("ShaderNodeEmission")
    links.new(camera_data.outputs["View Z Depth"], light.inputs["Color"])
    links.new(light.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return material


def _camera(scene: dict[str, np.ndarray]) -> None:
    fx, fy, cx, cy, width, height = scene["camera"].tolist()
    lens = bpy.data.cameras.new("camera")
    lens.sensor_fit, lens.sensor_width = "HORIZONTAL", 32.0
    lens.lens = 32.0 * fx / width
    lens.shift_x = (width / 2.0 - 0.5 - cx) / width
    lens.shift_y = (cy + 0.5 - height / 2.0) * fx / fy / width
    lens.clip_start, lens.clip_end = 0.01, FAR
    camera = bpy.data.objects.new("camera", lens)
    bpy.context.collection.objects.link(camera)
    render = bpy.context.scene.render
    bpy.context.scene.camera = camera
    render.engine, render.film_transparent = "CYCLES", True
    render.resolution_x, render.resolution_y = int(width), int(height)
    render.resolution_percentage = 100
    render.pixel_aspect_x, render.pixel_aspect_y = max(1.0, fy / fx), max(1.0, fx / fy)
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_mode, render.image_settings.color_depth = "RGBA", "32"
    cycles = bpy.context.scene.cycles
    cycles.samples, cycles.use_denoising, cycles.max_bounces = 1, False, 0
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 0.01


def _pose(rig: bpy.types.Object, scene: dict[str, np.ndarray], frame: int) -> None:
    for joint, name in enumerate(scene["names"]):
        bone = rig.pose.bones[str(name)]
        bone.rotation_mode = "QUATERNION"
        bone.rotation_quaternion = scene["rotations"][frame, joint]
        if scene["parents"][joint] < 0:
            bone.location = scene["roots"][frame] - scene["heads"][joint]
    rotation, position = scene["view_rotations"][frame], scene["view_position"]
    matrix = np.eye(4)
    matrix[:3, :3] = rotation * [1.0, -1.0, -1.0]
    matrix[:3, 3] = -rotation @ position
    bpy.context.scene.camera.matrix_world = Matrix(matrix.tolist())


def _rendered(path: Path, scene: dict[str, np.ndarray]) -> np.ndarray:
    bpy.context.scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Non-Color"
    width, height = scene["camera"][4:].astype(int).tolist()
    pixels = np.empty(width * height * 4, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    pixels = pixels.reshape(height, width, 4)[::-1]
    return np.where(pixels[..., 3] > 0.5, pixels[..., 0], np.float32(0.0))


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
