"""Where Blender's own importer puts the joints of a BVH file: run by test_in_blender.py.

`python import_in_blender.py TAKE.bvh OUT.npz STEP`: every STEP-th frame, Blender's units.
"""

import os
import sys

import bpy
import numpy as np


def main(source: str, target: str, step: int) -> None:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_anim.bvh(filepath=source)
    rig = bpy.context.object
    names = [bone.name for bone in rig.pose.bones]
    positions = []
    last = int(rig.animation_data.action.frame_range[1])
    for frame in range(1, last + 1, step):
        bpy.context.scene.frame_set(frame)
        heads = [rig.matrix_world @ bone.head for bone in rig.pose.bones]
        positions.append([tuple(head) for head in heads])
    np.savez(target, names=names, positions=np.array(positions))
    os._exit(0)  # bpy may hang when the interpreter closes.


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], int(sys.argv[3]))
