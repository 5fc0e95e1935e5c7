"""Properties of the sidebar that a .blend file stores: settings, and results of Check.

`scene.mocap_assist.clean` and `.check` hold the settings of the buttons Clean and Check, and
`scene.mocap_assist.issues` the worst issues. `window_manager.mocap_assist_job` holds the
progress of the running solve.
"""

import bpy

from .blender.settings_properties import settings_from
from .check.button_settings import CheckBundle
from .clean.button_settings import CleanBundle
from .exporting.button_settings import ExportPanelBundle
from .fix.button_settings import FixBundle
from .fix.queue import QUEUE
from .fix.queue_properties import PROPERTIES as QUEUE_PROPERTIES
from .fix.queue_properties import MOCAP_PG_fix_queue
from .library.button_settings import FindBundle, LibraryBundle, LoadBundle, UseBundle
from .live.live_take import LiveBundle
from .markers.scene_skeleton import SolveBundle
from .physics.scene_simulating import SimulateBundle
from .reconstruct.button_settings import ReconstructBundle
from .retarget.bone_highlight import show_pair
from .retarget.bone_map import explain_edited
from .retarget.button_settings import RetargetBundle, UnbakeBundle
from .track.following import FollowPanelBundle
from .track.retracking import RetrackBundle
from .track.tracking import TrackBundle
from .variants.button_settings import CrowdBundle, VaryBundle
from .variants.properties import CLASSES as VARIANTS
from .variants.properties import MOCAP_PG_variants


@settings_from(CleanBundle)
class MOCAP_PG_clean(bpy.types.PropertyGroup):
    """Settings of the button Clean."""


@settings_from(FixBundle)
class MOCAP_PG_fix(bpy.types.PropertyGroup):
    """Settings of the button Fix My Take."""


@settings_from(CheckBundle)
class MOCAP_PG_check(bpy.types.PropertyGroup):
    """Settings of the button Check."""


@settings_from(ExportPanelBundle)
class MOCAP_PG_export(bpy.types.PropertyGroup):
    """Settings of the button Export Clean Take."""


@settings_from(RetargetBundle)
class MOCAP_PG_retarget(bpy.types.PropertyGroup):
    """Settings of the button Retarget."""


@settings_from(SolveBundle)
class MOCAP_PG_solve(bpy.types.PropertyGroup):
    """Settings of the button Make Skeleton."""


@settings_from(LiveBundle)
class MOCAP_PG_live(bpy.types.PropertyGroup):
    """Settings of the button Record Live."""


@settings_from(SimulateBundle)
class MOCAP_PG_simulate(bpy.types.PropertyGroup):
    """Settings of the button Simulate."""


@settings_from(TrackBundle)
class MOCAP_PG_track(bpy.types.PropertyGroup):
    """Settings of the button Track."""


@settings_from(FollowPanelBundle)
class MOCAP_PG_track_live(bpy.types.PropertyGroup):
    """Settings of the button Track Live; it has those of Track too."""


@settings_from(RetrackBundle)
class MOCAP_PG_retrack(bpy.types.PropertyGroup):
    """Settings of the button Track from Here."""


@settings_from(UnbakeBundle)
class MOCAP_PG_unbake(bpy.types.PropertyGroup):
    """Settings of the button Unbake."""


@settings_from(ReconstructBundle)
class MOCAP_PG_reconstruct(bpy.types.PropertyGroup):
    """Settings of the button Reconstruct."""


@settings_from(LibraryBundle)
class MOCAP_PG_library(bpy.types.PropertyGroup):
    """Settings of the button Build Library."""


@settings_from(FindBundle)
class MOCAP_PG_find(bpy.types.PropertyGroup):
    """Settings of the button Find Similar."""


@settings_from(LoadBundle)
class MOCAP_PG_load(bpy.types.PropertyGroup):
    """Settings of the button Append as Action."""


@settings_from(UseBundle)
class MOCAP_PG_use(bpy.types.PropertyGroup):
    """Settings of the button Use as Examples."""


@settings_from(VaryBundle)
class MOCAP_PG_vary(bpy.types.PropertyGroup):
    """Settings of the button Vary."""


@settings_from(CrowdBundle)
class MOCAP_PG_crowd(bpy.types.PropertyGroup):
    """Settings of the button Assign to Selected."""


class MOCAP_PG_bone_pair(bpy.types.PropertyGroup):
    """Bones of source and target that play one part of the body; `name` is the role's."""

    source: bpy.props.StringProperty(
        name="Source Bone",
        description="Bone of the source for this part of the body",
        update=explain_edited("source"),
    )
    target: bpy.props.StringProperty(
        name="Target Bone",
        description="Bone or control of the target for this part of the body",
        update=explain_edited("target"),
    )
    source_confidence: bpy.props.FloatProperty(name="Source Confidence", default=1.0)
    target_confidence: bpy.props.FloatProperty(name="Target Confidence", default=1.0)
    source_reason: bpy.props.StringProperty(name="Source Reason")
    target_reason: bpy.props.StringProperty(name="Target Reason")


class MOCAP_PG_bone_map(bpy.types.PropertyGroup):
    """Roles of the bones of a source and a target armature."""

    source: bpy.props.StringProperty(name="Source")
    target: bpy.props.StringProperty(name="Target")
    source_score: bpy.props.FloatProperty(name="Source Matched", subtype="FACTOR")
    target_score: bpy.props.FloatProperty(name="Target Matched", subtype="FACTOR")
    rows: bpy.props.CollectionProperty(type=MOCAP_PG_bone_pair)
    active_row: bpy.props.IntProperty(
        name="Row",
        description="Selected row; its bones are selected and highlighted on both armatures",
        update=show_pair,
    )


class MOCAP_PG_issue(bpy.types.PropertyGroup):
    """An issue of the list of Check; `name` is the bone's."""

    start: bpy.props.FloatProperty(name="First Frame")
    stop: bpy.props.FloatProperty(name="Last Frame")
    kind: bpy.props.StringProperty(name="Issue")
    severity: bpy.props.FloatProperty(name="Severity")
    sentence: bpy.props.StringProperty(name="Text")


class MOCAP_PG_scene(bpy.types.PropertyGroup):
    """Everything that Mocap Assist keeps in a scene."""

    clean: bpy.props.PointerProperty(type=MOCAP_PG_clean)
    check: bpy.props.PointerProperty(type=MOCAP_PG_check)
    fix: bpy.props.PointerProperty(type=MOCAP_PG_fix)
    export: bpy.props.PointerProperty(type=MOCAP_PG_export)
    solve: bpy.props.PointerProperty(type=MOCAP_PG_solve)
    live: bpy.props.PointerProperty(type=MOCAP_PG_live)
    reconstruct: bpy.props.PointerProperty(type=MOCAP_PG_reconstruct)
    simulate: bpy.props.PointerProperty(type=MOCAP_PG_simulate)
    track: bpy.props.PointerProperty(type=MOCAP_PG_track)
    track_live: bpy.props.PointerProperty(type=MOCAP_PG_track_live)
    retrack: bpy.props.PointerProperty(type=MOCAP_PG_retrack)
    retarget: bpy.props.PointerProperty(type=MOCAP_PG_retarget)
    unbake: bpy.props.PointerProperty(type=MOCAP_PG_unbake)
    library: bpy.props.PointerProperty(type=MOCAP_PG_library)
    find: bpy.props.PointerProperty(type=MOCAP_PG_find)
    load: bpy.props.PointerProperty(type=MOCAP_PG_load)
    use: bpy.props.PointerProperty(type=MOCAP_PG_use)
    vary: bpy.props.PointerProperty(type=MOCAP_PG_vary)
    crowd: bpy.props.PointerProperty(type=MOCAP_PG_crowd)
    variants: bpy.props.PointerProperty(type=MOCAP_PG_variants)
    bone_map: bpy.props.PointerProperty(type=MOCAP_PG_bone_map)
    checked_action: bpy.props.PointerProperty(
        type=bpy.types.Action, name="Checked", description="Action whose issues are listed"
    )
    issues: bpy.props.CollectionProperty(type=MOCAP_PG_issue)
    active_issue: bpy.props.IntProperty(name="Issue", description="Selected issue of the list")
    report: bpy.props.StringProperty(name="Report", description="Results of the last check")


class MOCAP_PG_job(bpy.types.PropertyGroup):
    """Progress of the running solve."""

    running: bpy.props.BoolProperty(name="Running")
    fraction: bpy.props.FloatProperty(name="Done", subtype="FACTOR", min=0.0, max=1.0)
    message: bpy.props.StringProperty(name="Message")
    ending: bpy.props.StringProperty(
        name="Ending", description="What Esc does", default="Esc cancels"
    )
    owner: bpy.props.StringProperty(name="Panel", description="Panel that shows the progress")


CLASSES = (
    MOCAP_PG_fix,
    MOCAP_PG_clean,
    MOCAP_PG_check,
    MOCAP_PG_export,
    MOCAP_PG_solve,
    MOCAP_PG_live,
    MOCAP_PG_retarget,
    MOCAP_PG_simulate,
    MOCAP_PG_track,
    MOCAP_PG_track_live,
    MOCAP_PG_retrack,
    MOCAP_PG_unbake,
    MOCAP_PG_reconstruct,
    MOCAP_PG_library,
    MOCAP_PG_find,
    MOCAP_PG_load,
    MOCAP_PG_use,
    MOCAP_PG_vary,
    MOCAP_PG_crowd,
    *VARIANTS,
    MOCAP_PG_bone_pair,
    MOCAP_PG_bone_map,
    MOCAP_PG_issue,
    MOCAP_PG_scene,
    MOCAP_PG_job,
    *QUEUE_PROPERTIES,
)


def register() -> None:
    """Add the properties to scenes and to the window manager, which is never saved."""
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.types.Scene.mocap_assist = bpy.props.PointerProperty(type=MOCAP_PG_scene)
    manager = bpy.types.WindowManager
    manager.mocap_assist_job = bpy.props.PointerProperty(type=MOCAP_PG_job)
    setattr(manager, QUEUE, bpy.props.PointerProperty(type=MOCAP_PG_fix_queue))
    manager.mocap_assist_all_panels = bpy.props.BoolProperty(
        name="All Panels", description="Show all panels, whatever is selected"
    )
    manager.mocap_assist_fix_details = bpy.props.BoolProperty(
        name="Details", description="Show what was done to the take, and why"
    )


def unregister() -> None:
    """Remove the properties."""
    manager = bpy.types.WindowManager
    del manager.mocap_assist_fix_details, manager.mocap_assist_all_panels
    del manager.mocap_assist_job
    delattr(manager, QUEUE)
    del bpy.types.Scene.mocap_assist
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
