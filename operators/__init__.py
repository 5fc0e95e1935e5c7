"""One module per button."""

import bpy

from .accept_fix import MOCAP_OT_accept_fix
from .add_workspace import MOCAP_OT_add_workspace
from .assign_variants import MOCAP_OT_assign_variants
from .browse_matches import MOCAP_OT_browse_matches
from .cancel_solve import MOCAP_OT_cancel_solve
from .change_axes import MOCAP_OT_change_axes
from .choose_live import MOCAP_OT_choose_live
from .denoise import MOCAP_OT_denoise
from .draw_variants import MOCAP_OT_draw_variants
from .export_take import MOCAP_OT_export_take
from .find_similar import MOCAP_OT_find_similar
from .fix_folder import MOCAP_OT_fix_folder
from .fix_take import MOCAP_OT_fix_take
from .fix_takes import MOCAP_OT_fix_takes
from .import_job import MOCAP_OT_import_job
from .import_recording import MOCAP_OT_import_recording
from .index_library import MOCAP_OT_index_library
from .jump_to_issue import MOCAP_OT_jump_to_issue
from .keep_current import MOCAP_OT_keep_current
from .keep_variants import MOCAP_OT_keep_variants
from .learn_from_matches import MOCAP_OT_learn_from_matches
from .learn_patterns import MOCAP_OT_learn_patterns
from .link_match import MOCAP_OT_link_match
from .listen import MOCAP_OT_listen
from .load_match import MOCAP_OT_load_match
from .load_sample import MOCAP_OT_load_sample
from .mark_asset import MOCAP_OT_mark_asset
from .mark_issues import MOCAP_OT_mark_issues
from .mark_variants import MOCAP_OT_mark_variants
from .measure_quality import MOCAP_OT_measure_quality
from .plant_feet import MOCAP_OT_plant_feet
from .reconstruct import MOCAP_OT_reconstruct
from .record_live import MOCAP_OT_record_live
from .reduce_keys import MOCAP_OT_reduce_keys
from .retarget import MOCAP_OT_retarget
from .retrack import MOCAP_OT_retrack
from .revert_to_raw import MOCAP_OT_revert_to_raw
from .set_range import MOCAP_OT_set_range
from .show_depth import MOCAP_OT_show_depth
from .show_raw import MOCAP_OT_show_raw
from .simulate import MOCAP_OT_simulate
from .solve_skeleton import MOCAP_OT_solve_skeleton
from .stack_variants import MOCAP_OT_stack_variants
from .submit_folder import MOCAP_OT_submit_folder
from .track_depth import MOCAP_OT_track_depth
from .track_live import MOCAP_OT_track_live
from .use_matches import MOCAP_OT_use_matches
from .vary import MOCAP_OT_vary

OPERATORS = (
    MOCAP_OT_import_recording,
    MOCAP_OT_import_job,
    MOCAP_OT_cancel_solve,
    MOCAP_OT_load_sample,
    MOCAP_OT_add_workspace,
    MOCAP_OT_fix_take,
    MOCAP_OT_fix_takes,
    MOCAP_OT_fix_folder,
    MOCAP_OT_submit_folder,
    MOCAP_OT_accept_fix,
    MOCAP_OT_change_axes,
    MOCAP_OT_show_depth,
    MOCAP_OT_track_depth,
    MOCAP_OT_choose_live,
    MOCAP_OT_track_live,
    MOCAP_OT_retrack,
    MOCAP_OT_denoise,
    MOCAP_OT_reconstruct,
    MOCAP_OT_measure_quality,
    MOCAP_OT_jump_to_issue,
    MOCAP_OT_mark_issues,
    MOCAP_OT_set_range,
    MOCAP_OT_plant_feet,
    MOCAP_OT_learn_patterns,
    MOCAP_OT_simulate,
    MOCAP_OT_listen,
    MOCAP_OT_record_live,
    MOCAP_OT_solve_skeleton,
    MOCAP_OT_retarget,
    MOCAP_OT_reduce_keys,
    MOCAP_OT_revert_to_raw,
    MOCAP_OT_show_raw,
    MOCAP_OT_export_take,
    MOCAP_OT_index_library,
    MOCAP_OT_keep_current,
    MOCAP_OT_find_similar,
    MOCAP_OT_browse_matches,
    MOCAP_OT_load_match,
    MOCAP_OT_link_match,
    MOCAP_OT_learn_from_matches,
    MOCAP_OT_use_matches,
    MOCAP_OT_mark_asset,
    MOCAP_OT_vary,
    MOCAP_OT_keep_variants,
    MOCAP_OT_assign_variants,
    MOCAP_OT_stack_variants,
    MOCAP_OT_mark_variants,
    MOCAP_OT_draw_variants,
)


def register() -> None:
    """Make the buttons known to Blender."""
    for operator in OPERATORS:
        bpy.utils.register_class(operator)


def unregister() -> None:
    """Take the buttons away again."""
    for operator in reversed(OPERATORS):
        bpy.utils.unregister_class(operator)
