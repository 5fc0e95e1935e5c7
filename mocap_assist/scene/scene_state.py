"""Restore the selection and the scene's time after a failed import."""

from typing import NamedTuple

import bpy


class SceneState(NamedTuple):
    """The selection and time of a scene, by session numbers: undo invalidates pointers."""

    active: int | None
    mode: str
    """Of the active object."""
    selected: frozenset[int]
    fps: int
    fps_base: float
    frame_start: int
    frame_end: int
    frame_current: int

    @classmethod
    def of(cls, context: bpy.types.Context) -> "SceneState":
        """Store the state of a scene."""
        objects, scene = context.view_layer.objects, context.scene
        active = objects.active
        return cls(
            active=None if active is None else active.session_uid,
            mode="OBJECT" if active is None else active.mode,
            selected=frozenset(each.session_uid for each in objects.selected),
            fps=scene.render.fps,
            fps_base=scene.render.fps_base,
            frame_start=scene.frame_start,
            frame_end=scene.frame_end,
            frame_current=scene.frame_current,
        )

    def restore(self, context: bpy.types.Context) -> None:
        """Restore the state, for the objects that still exist."""
        scene, objects = context.scene, context.view_layer.objects
        scene.render.fps, scene.render.fps_base = self.fps, self.fps_base
        scene.frame_start, scene.frame_end = self.frame_start, self.frame_end
        if scene.frame_current != self.frame_current:
            scene.frame_set(self.frame_current)
        if SceneState.of(context) == self:
            return
        for each in objects:
            if each.select_get() != (each.session_uid in self.selected):
                each.select_set(each.session_uid in self.selected)
        objects.active = next((o for o in objects if o.session_uid == self.active), None)
        switch = bpy.ops.object.mode_set
        if objects.active is not None and objects.active.mode != self.mode and switch.poll():
            switch(mode=self.mode)
