"""Submit a folder of takes to a render farm from a Blender with a window, and take pictures.

    make test-gui DRIVERS=submit

Runs inside that Blender; `bgui` comes with the tool and moves a real pointer. The farm is the
stand-in of the tests, which is copied next to this script.
"""

import tempfile
from pathlib import Path

import bgui
import bpy
from clusters import flamenco_stub
from driver_scene import empty_scene, load, ours, settle, unfold_alone, until_done

AWAY = (500, 500)
SUBMIT = "mocap_assist.submit_folder"
N_TAKES = 2


def press(text):
    yield from bgui.scan(columns=(0.25, 0.75))
    yield from bgui.click(*bgui.at(text))


def make_folder():
    """Write short takes into a folder, and return it."""
    samples = load("solvers.samples")
    walk = samples.walking_gait(samples.GaitSettings(duration=0.5, frame_rate=30.0))
    folder = Path(tempfile.mkdtemp()) / "shoot"
    folder.mkdir()
    for number in range(N_TAKES):
        load("solvers.recordings").write_bvh(walk, folder / f"take{number}.bvh")
    return folder


def load_two_samples():
    """Select two takes, so that all buttons for several takes show."""
    with bgui.override("WINDOW"):
        for _ in range(2):
            bpy.ops.mocap_assist.load_sample()
            bpy.ops.object.mode_set(mode="OBJECT")
    for each in bpy.data.objects:
        each.select_set(True)


def name_the_farm(address):
    preferences = ours("panel_parts.preference_values").preferences()
    preferences.flamenco_manager, preferences.flamenco_command = address, "mocap-assist"


def gray_while_offline():
    bpy.context.preferences.system.use_online_access = False
    yield from settle(pointer=AWAY)
    yield from bgui.scan(columns=(0.25, 0.75))
    yield from bgui.hover(*bgui.at(SUBMIT))
    bgui.shot("1-offline.png")
    bpy.context.preferences.system.use_online_access = True
    yield from settle(pointer=AWAY)


def choose(folder):
    """Choose the folder in the file browser that the button opened."""
    yield 2.0
    window = bpy.context.window_manager.windows[-1]
    area = next(each for each in window.screen.areas if each.type == "FILE_BROWSER")
    region = next(each for each in area.regions if each.type == "WINDOW")
    area.spaces.active.params.directory = str(folder).encode()
    yield 1.0
    bgui.shot("2-browser.png")
    with bpy.context.temp_override(window=window, area=area, region=region):
        bpy.ops.file.execute()
    yield 1.0


def steps():
    empty_scene()
    unfold_alone("fix")
    yield from bgui.open_sidebar("Mocap")
    load_two_samples()
    actions = [each.animation_data.action for each in bpy.data.objects]
    folder = make_folder()
    flamenco_stub.SCRIPTS = Path(load("solvers").__file__).parent.joinpath(
        "command_line", "farm", "scripts"
    )
    with flamenco_stub.flamenco_stub() as farm:
        name_the_farm(farm.address)
        yield from gray_while_offline()
        yield from press(SUBMIT)
        yield from choose(folder)
        yield from until_done()
        yield from settle(pointer=AWAY)
        bgui.shot("3-submitted.png")
    sent = [body for _, path, body in farm.requests if path == flamenco_stub.JOBS]
    assert [each["name"] for each in sent] == ["fix shoot"], farm.requests
    lines = next(folder.with_name("shoot_fixed").iterdir()).read_text().splitlines()
    assert len(lines) == N_TAKES, lines
    assert [each.animation_data.action for each in bpy.data.objects] == actions


bgui.run(steps, timeout=1500)
