"""Blender's own Gaussian and Butterworth graph-editor operators, really run in Blender.

`python -m tests.benchmarks.peers.blender_graph IN.npz OUT.npz` is the child process; it puts
every channel on an F-curve of its own (so no quaternion is split: kinder to Blender than
an armature would be), at the clip's frame rate, selects all and calls the operators.
"""

import contextlib
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from solvers.arrays import Array

WIDTHS = (2, 3, 4, 6, 8, 10, 12, 16)
"""Filter widths of the Gaussian, frames; sigma is a third of it. Blender's default is 6."""
CUTOFFS = (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0)
"""Cut-off frequencies of the Butterworth filter, hertz. Blender's default is 3."""
DEFAULTS = {"gaussian": 6, "butterworth": 3.0}
TIMEOUT = 600.0


def smooth_in_blender(takes: Sequence[Array], frame_rate: float) -> list[dict[str, Array]]:
    """Filter each take by both operators at all settings.

    Returns for each take {"gaussian": (settings, frames, channels), "butterworth": the same}.
    """
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder) / "in.npz", Path(folder) / "out.npz"
        np.savez(source, *takes, frame_rate=frame_rate)
        command = [sys.executable, "-m", "tests.benchmarks.peers.blender_graph"]
        environment = {**os.environ, "BLENDER_USER_RESOURCES": folder}
        done = subprocess.run(
            [*command, source, target],
            env=environment,
            timeout=TIMEOUT,
            capture_output=True,
            text=True,
        )
        if done.returncode or not target.exists():
            raise RuntimeError(f"Blender failed: {done.stdout[-2000:]} {done.stderr[-2000:]}")
        with np.load(target) as found:
            return [
                {name: found[f"{name}_{number}"] for name in DEFAULTS}
                for number in range(len(takes))
            ]


def _child(source: str, target: str) -> None:
    import bpy

    with np.load(source) as given:
        frame_rate = float(given["frame_rate"])
        takes = [given[f"arr_{number}"] for number in range(len(given.files) - 1)]
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    # Butterworth takes its cut-off in hertz of the scene's rate.
    bpy.context.scene.render.fps = round(frame_rate)
    results = {}
    for number, take in enumerate(takes):
        for name, grid in (("gaussian", WIDTHS), ("butterworth", CUTOFFS)):
            outputs = [_filtered(bpy, take, name, setting) for setting in grid]
            results[f"{name}_{number}"] = np.array(outputs)
    np.savez(target, **results)


def _filtered(bpy: Any, take: Array, name: str, setting: float) -> Array:
    ob = bpy.data.objects.new("take", None)
    bpy.context.scene.collection.objects.link(ob)
    curves = _write(bpy, ob, take)
    bpy.context.view_layer.objects.active = ob
    ob.select_set(True)
    with _graph_editor(bpy, ob):
        bpy.ops.graph.select_all(action="SELECT")
        if name == "gaussian":
            # filter_width before sigma: their product, in frames, is the filter's own sigma.
            bpy.ops.graph.gaussian_smooth(factor=1.0, filter_width=int(setting), sigma=0.33)
        else:
            bpy.ops.graph.butterworth_smooth(cutoff_frequency=setting, filter_order=4)
    keys = np.empty(2 * len(take), np.float32)
    result = np.empty_like(take)
    for channel, curve in enumerate(curves):
        curve.keyframe_points.foreach_get("co", keys)
        result[:, channel] = keys[1::2]
    bpy.data.actions.remove(ob.animation_data.action)
    bpy.data.objects.remove(ob)
    return result


def _write(bpy: Any, ob: Any, take: Array) -> Sequence[Any]:
    action = bpy.data.actions.new("take")
    slot = action.slots.new(id_type="OBJECT", name="take")
    strip = action.layers.new("take").strips.new(type="KEYFRAME")
    curves = strip.channelbag(slot, ensure=True).fcurves
    ob.animation_data_create().action = action
    ob.animation_data.action_slot = slot
    keys = np.empty((len(take), 2), np.float32)
    keys[:, 0] = np.arange(len(take))
    for channel, values in enumerate(take.T):
        ob[f"c{channel}"] = 0.0
        curve = curves.new(data_path=f'["c{channel}"]')
        curve.keyframe_points.add(len(take))
        keys[:, 1] = values
        curve.keyframe_points.foreach_set("co", keys.ravel())
        curve.update()
    return list(curves)


@contextlib.contextmanager
def _graph_editor(bpy: Any, ob: Any) -> Iterator[None]:
    window = bpy.context.window or bpy.context.window_manager.windows[0]
    area = max(window.screen.areas, key=lambda one: one.width * one.height)
    before, area.type = area.type, "GRAPH_EDITOR"
    region = next(one for one in area.regions if one.type == "WINDOW")
    area.spaces.active.dopesheet.show_only_selected = False
    try:
        with bpy.context.temp_override(
            window=window, screen=window.screen, area=area, region=region, object=ob
        ):
            yield
    finally:
        area.type = before


if __name__ == "__main__":
    _child(*sys.argv[1:])
    # Blender 4.5 may hang at a normal exit.
    sys.stdout.flush()
    os._exit(0)
