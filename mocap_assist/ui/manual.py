"""F1 on a button opens its chapter of the manual that came with the extension."""

import bpy

from ..panel_parts.manual_page import MANUAL

CHAPTERS = {
    "bpy.ops.mocap_assist.import_*": "import",
    "bpy.ops.mocap_assist.load_sample*": "import",
    "bpy.ops.mocap_assist.add_workspace*": "import",
    "bpy.types.windowmanager.mocap_assist_all_panels*": "import",
    "bpy.ops.mocap_assist.*fix*": "fix",
    "bpy.ops.mocap_assist.submit_folder*": "fix",
    "bpy.types.mocap_pg_fix*": "fix",
    "bpy.types.mocap_pg_queued*": "fix",
    "bpy.types.windowmanager.mocap_assist_fix_details*": "fix",
    "bpy.ops.mocap_assist.change_axes*": "import",
    "bpy.ops.mocap_assist.show_depth*": "import",
    "bpy.ops.mocap_assist.denoise*": "clean",
    "bpy.ops.mocap_assist.cancel_solve*": "clean",
    "bpy.ops.mocap_assist.learn_patterns*": "clean",
    "bpy.ops.mocap_assist.*_preset*": "presets",
    "bpy.ops.mocap_assist.*_example*": "clean",
    "bpy.ops.mocap_assist.measure_quality*": "check",
    "bpy.ops.mocap_assist.jump_to_issue*": "check",
    "bpy.ops.mocap_assist.mark_issues*": "check",
    "bpy.ops.mocap_assist.set_range*": "check",
    "bpy.types.windowmanager.mocap_assist_strip*": "check",
    "bpy.types.windowmanager.mocap_assist_raw_curves*": "compare",
    "bpy.types.windowmanager.mocap_assist_issue*": "check",
    "bpy.ops.mocap_assist.revert_to_raw*": "compare",
    "bpy.ops.mocap_assist.show_raw*": "compare",
    "bpy.ops.mocap_assist.export_take*": "export",
    "bpy.types.mocap_pg_export*": "export",
    "bpy.ops.mocap_assist.plant_feet*": "feet",
    "bpy.ops.mocap_assist.reconstruct*": "reconstruct",
    "bpy.types.mocap_pg_reconstruct*": "reconstruct",
    "bpy.types.windowmanager.mocap_assist_confidence*": "reconstruct",
    "bpy.ops.mocap_assist.track_depth*": "track",
    "bpy.ops.mocap_assist.track_live*": "track",
    "bpy.ops.mocap_assist.choose_live*": "track",
    "bpy.types.mocap_pg_track*": "track",
    "bpy.ops.mocap_assist.retrack*": "track",
    "bpy.types.mocap_pg_retrack*": "track",
    "bpy.types.windowmanager.mocap_assist_body*": "track",
    "bpy.ops.mocap_assist.simulate*": "physics",
    "bpy.types.mocap_pg_simulate*": "physics",
    "bpy.ops.mocap_assist.solve_skeleton*": "markers",
    "bpy.types.mocap_pg_solve*": "markers",
    "bpy.ops.mocap_assist.retarget*": "retarget",
    "bpy.ops.mocap_assist.tick_action*": "retarget",
    "bpy.ops.mocap_assist.find_bones*": "retarget",
    "bpy.ops.mocap_assist.*_bone_map*": "retarget",
    "bpy.types.windowmanager.mocap_assist_highlight*": "retarget",
    "bpy.types.windowmanager.mocap_assist_rest_poses*": "retarget",
    "bpy.ops.mocap_assist.reduce_keys*": "unbake",
    "bpy.types.mocap_pg_retarget*": "retarget",
    "bpy.types.mocap_pg_bone*": "retarget",
    "bpy.types.mocap_pg_unbake*": "unbake",
    "bpy.ops.mocap_assist.index_library*": "library",
    "bpy.ops.mocap_assist.keep_current*": "library",
    "bpy.ops.mocap_assist.*_source*": "library",
    "bpy.ops.mocap_assist.find_similar*": "library",
    "bpy.ops.mocap_assist.*_match*": "library",
    "bpy.ops.mocap_assist.learn_from_matches*": "library",
    "bpy.ops.mocap_assist.mark_asset*": "library",
    "bpy.types.mocap_pg_library*": "library",
    "bpy.types.mocap_pg_find*": "library",
    "bpy.types.mocap_pg_load*": "library",
    "bpy.types.windowmanager.mocap_assist_ghost*": "library",
    "bpy.ops.mocap_assist.vary*": "vary",
    "bpy.ops.mocap_assist.*_variants*": "vary",
    "bpy.types.mocap_pg_vary*": "vary",
    "bpy.types.mocap_pg_variant*": "vary",
    "bpy.types.mocap_pg_crowd*": "vary",
    "bpy.ops.mocap_assist.listen*": "perform",
    "bpy.ops.mocap_assist.record_live*": "perform",
    "bpy.types.mocap_pg_live*": "perform",
    "bpy.ops.mocap_assist.reset_preferences*": "preferences",
    "bpy.ops.mocap_assist.stop_keeping*": "preferences",
    "bpy.ops.mocap_assist.copy_diagnostics*": "preferences",
    "bpy.types.mocap_pg_clean*": "clean",
    "bpy.types.mocap_pg_check*": "check",
    "bpy.types.windowmanager.mocap_assist_overlay*": "compare",
    "bpy.types.windowmanager.mocap_assist_onion*": "compare",
    "bpy.types.windowmanager.mocap_assist_wipe*": "compare",
    "bpy.types.mocap_ap_preferences*": "preferences",
}


def manual_map() -> tuple[str, tuple[tuple[str, str], ...]]:
    """Return the manual's address and, for each kind of button, its chapter."""
    return MANUAL.as_uri(), tuple((what, f"#{name}") for what, name in CHAPTERS.items())


def register() -> None:
    """Let F1 find the manual."""
    bpy.utils.register_manual_map(manual_map)


def unregister() -> None:
    """Forget the manual."""
    bpy.utils.unregister_manual_map(manual_map)
