"""Press Physics in a Blender with a window, as an animator does; take pictures.

    make test-gui DRIVERS=physics

Runs inside that Blender; `bgui` comes with the tool. The take, of a skeleton, is copied next to
this script as walk.bvh. The plain zip brings no MuJoCo: where Blender has none, the button says
so in one sentence, and that is what the pictures show.
"""

from importlib.util import find_spec
from pathlib import Path

import bgui
import bpy
from driver_scene import empty_scene, settle, unfold_alone

FOLDER = Path(__file__).parent
TAKE = FOLDER / "walk.bvh"
HAS_ENGINE = find_spec("mujoco") is not None


def steps():
    empty_scene()
    unfold_alone("physics")
    yield from bgui.open_sidebar("Mocap")
    view = bgui.area().spaces.active
    view.overlay.show_relationship_lines = False
    yield from settle()
    bgui.shot("1-nothing.png")
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.import_recording(
            directory=str(FOLDER), files=[{"name": TAKE.name}], frame_rate="UPDATE"
        )
    armature = bpy.context.object
    view.region_3d.view_location = (0.0, 0.0, 0.9)
    view.region_3d.view_distance = 6.0
    bpy.context.scene.frame_set(40)
    yield from settle()
    bgui.shot("2-before.png")
    with bgui.override("WINDOW"):
        assert bpy.ops.mocap_assist.simulate("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    bgui.redraw()
    yield 0.3
    bgui.shot("3-pressed.png")
    for _ in range(240):
        yield 0.5
        if not bpy.context.window_manager.mocap_assist_job.running:
            break
    yield from settle()
    bgui.shot("4-after.png")
    made = armature.animation_data.action.name.endswith(".physics")
    assert made == HAS_ENGINE, armature.animation_data.action.name


bgui.run(steps, timeout=1500)
