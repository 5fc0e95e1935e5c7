"""Plant hands, knees and feet in a Blender with a window, and look at their rows and keys.

    make test-gui DRIVERS=supports

Runs inside that Blender; `bgui` comes with the tool and moves a real pointer. The actor of the
take lies down and bears on both hands.
"""

from pathlib import Path

import bgui
import bpy
import numpy as np
from driver_scene import empty_scene, ours, settle, unfold_alone, until_done

TAKE = Path(__file__).parent / "HDM_dg_lieDownFloor_014_120.amc"
AWAY = (500, 700)
HANDS = {"Left Hand", "Right Hand"}
HIPS = "mocap_contact_hips"
MAX_MOVED_M, BLEND_FRAMES = 0.01, 36
"""Of held hips, away from both ends by the frames of the blend of planting, at 120 Hz."""


def import_take():
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.import_recording(filepath=str(TAKE))
    yield 0.5
    yield from until_done()
    return bpy.context.view_layer.objects.active


def look_at(armature, frame):
    view = bgui.area().spaces.active.region_3d
    bpy.context.scene.frame_set(round(frame))
    view.view_location = armature.matrix_world @ armature.pose.bones[0].head
    view.view_rotation, view.view_distance = (0.76, 0.6, 0.15, 0.2), 4.0


def open_timeline():
    """Show a tall Dope Sheet below the 3D View, where the strip names its rows."""
    with bgui.override("WINDOW"):
        bpy.ops.screen.area_split(direction="HORIZONTAL", factor=0.4)
    yield 0.5
    views = [each for each in bgui.window().screen.areas if each.type == "VIEW_3D"]
    min(views, key=lambda each: each.y).ui_type = "DOPESHEET"
    yield 0.5
    with bgui.override("WINDOW", "DOPESHEET_EDITOR"):
        bpy.ops.action.view_all()


def rows():
    with bgui.override("WINDOW", "DOPESHEET_EDITOR"):
        found = ours("overlays.strip.reading").strip_of(bpy.context)
    return {row.value: ranges for row, ranges in found.rows.items()}


def hold_hips(armature, held):
    """Key *Hips Contact* as long as a hand bears on the floor, and plant again."""
    scene, planted = bpy.context.scene, armature.animation_data.action
    for frame, value in ((held.first - 1.0, 0), (held.first, 1), (held.last, 1)):
        scene.frame_set(round(frame))
        armature[HIPS] = value
        assert armature.keyframe_insert(f'["{HIPS}"]')
        yield 0.2  # a key and the next frame are two steps of an animator
    look_at(armature, (held.first + held.last) / 2.0)
    yield from settle(pointer=AWAY)
    assert "Hips" in rows(), list(rows())
    bgui.shot("4-hips-keyed.png")
    yield from bgui.scan()
    yield from bgui.click(*bgui.at("mocap_assist.plant_feet"))
    yield 0.5
    yield from until_done()
    assert armature.animation_data.action != planted
    look_at(armature, (held.first + held.last) / 2.0)
    yield from settle(pointer=AWAY)
    (shown,) = rows()["Hips"]
    assert np.allclose((shown.first, shown.last), (held.first, held.last), atol=1.0), shown
    positions = []
    for frame in np.linspace(held.first + BLEND_FRAMES, held.last - BLEND_FRAMES, 9):
        scene.frame_set(round(frame))
        positions.append(armature.matrix_world @ armature.pose.bones[0].head)
    moved_m = np.ptp(np.array(positions), axis=0).max()
    print(f"bgui: held hips move {1000.0 * moved_m:.1f} mm", flush=True)
    assert moved_m < MAX_MOVED_M, moved_m
    look_at(armature, (held.first + held.last) / 2.0)
    yield from settle(pointer=AWAY)
    bgui.shot("5-hips-held.png")


def steps():
    empty_scene()
    unfold_alone("feet")
    armature = yield from import_take()
    recorded = armature.animation_data.action
    yield from open_timeline()
    yield from bgui.open_sidebar("Mocap")
    yield from settle(pointer=AWAY)
    bgui.shot("1-before.png")
    yield from bgui.scan()
    yield from bgui.click(*bgui.at("mocap_assist.plant_feet"))
    yield 0.5
    yield from until_done()
    assert armature.animation_data.action != recorded
    shown = rows()
    assert set(shown) >= HANDS, list(shown)
    hand = shown["Left Hand"][0]
    look_at(armature, (hand.first + hand.last) / 2.0)
    yield from settle(pointer=AWAY)
    bgui.shot("2-planted.png")
    assert armature["mocap_contact_left_hand"] == 1
    look_at(armature, hand.first - 10.0)
    yield from settle(pointer=AWAY)
    bgui.shot("3-before-contact.png")
    assert armature["mocap_contact_left_hand"] == 0
    yield from hold_hips(armature, hand)


bgui.run(steps, timeout=1500)
