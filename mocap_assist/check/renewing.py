"""Check again after each result, so that the list of issues is of what is played."""

import bpy

from ...solvers.errors import MocapAssistError
from ..blender.subscriptions import subscription
from ..runtime import after_result, watch
from ..runtime.selection import selected_subject
from ..runtime.solver_operator import SolverOperator
from . import raw_view
from .scene_checking import is_stale

_awaited: dict[int, bool] = {}
"""Number of each scene that a quiet check is for, until a check has ended there, and whether it
is checked even if the list is of the action that is played."""


class CheckOperator(SolverOperator):
    """Mix in before bpy.types.Operator: a check that may be quiet.

    The message of the result that it follows stays in the status bar. The animator works on
    meanwhile: a check that was not requested blocks nothing, and a press of a button ends it.
    """

    is_quiet: bpy.props.BoolProperty(options={"SKIP_SAVE", "HIDDEN"})

    def is_requested(self) -> bool:
        return not self.is_quiet

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if self.is_quiet and self._watch.is_on and event.type != "TIMER":
            return {"PASS_THROUGH"}
        return super().modal(context, event)

    def _finish(self, message: str) -> set[str]:
        _awaited.pop(self._subject.scene.number, None)
        renew_awaited()  # in other scenes
        return {"FINISHED"} if self.is_quiet else super()._finish(message)

    def _give_up(self, error: MocapAssistError | MemoryError) -> set[str]:
        return {"CANCELLED"} if self.is_quiet else super()._give_up(error)


def renew_later(scene: bpy.types.Scene) -> None:
    """Check again once Blender is idle, where Check was pressed in this scene before."""
    _await(scene, always=False)


def renew_always(scene: bpy.types.Scene) -> None:
    """Do so even if the list is of the played action, whose keys may have changed."""
    _await(scene, always=True)


def _await(scene: bpy.types.Scene, *, always: bool) -> None:
    if not scene.mocap_assist.report or bpy.app.background:
        return
    watch.abandon_quiet(bpy.context)  # a check of what was played before
    _awaited[scene.session_uid] = always or _awaited.get(scene.session_uid, False)
    _renew_when_idle()


def renew_awaited() -> None:
    """Take up a quiet check that was ended by a press, or met the recorded action, or whose
    scene was not shown."""
    if _awaited and not watch.is_quiet_on():
        _renew_when_idle()


def is_awaited(context: bpy.types.Context) -> bool:
    """Whether a quiet check of what the selection plays runs, or will."""
    is_on = watch.is_quiet_on() or bpy.app.timers.is_registered(check_again)
    return is_on and context.scene.session_uid in _awaited


def _renew_when_idle() -> None:
    if not bpy.app.timers.is_registered(check_again):
        bpy.app.timers.register(check_again, first_interval=0.0)


def check_again() -> None:
    """Press Check quietly in a window of an awaited scene.

    While another solve runs, the recorded action is shown or no window shows the scene there is
    no press; `renew_awaited` is called after each of them.
    """
    if raw_view.is_shown():
        return
    check = bpy.ops.mocap_assist.measure_quality
    for window in bpy.context.window_manager.windows:
        scene = window.scene
        if scene.session_uid not in _awaited:
            continue
        area = max(window.screen.areas, key=lambda each: each.type == "VIEW_3D")
        region = next(each for each in area.regions if each.type == "WINDOW")
        with bpy.context.temp_override(window=window, area=area, region=region):
            if not check.poll():
                continue
            if _awaited[scene.session_uid] or _is_outdated(scene):
                check("INVOKE_DEFAULT", is_quiet=True)
                return
        del _awaited[scene.session_uid]


def _is_outdated(scene: bpy.types.Scene) -> bool:
    """Whether the list is of another action than the one that is played.

    A result of Fix brings its list along, and one for another rig changes nothing here.
    """
    return is_stale(scene.mocap_assist.checked_action, selected_subject(bpy.context))


_watch_scenes, _ignore_scenes = subscription((bpy.types.Window, "scene"), renew_awaited)


def register() -> None:
    """Check again after each result from now on."""
    after_result.listeners.append(renew_later)
    watch.at_end.append(renew_awaited)
    raw_view.at_end.append(renew_awaited)
    _watch_scenes()


def unregister() -> None:
    """Stop checking after results."""
    _ignore_scenes()
    after_result.listeners.remove(renew_later)
    watch.at_end.remove(renew_awaited)
    raw_view.at_end.remove(renew_awaited)
    if bpy.app.timers.is_registered(check_again):
        bpy.app.timers.unregister(check_again)
