"""One module per button."""

import bpy

from .denoise import MOCAP_OT_denoise
from .import_job import MOCAP_OT_import_job
from .import_recording import MOCAP_OT_import_recording
from .jump_to_spot import MOCAP_OT_jump_to_spot
from .learn_patterns import MOCAP_OT_learn_patterns
from .listen import MOCAP_OT_listen
from .measure_quality import MOCAP_OT_measure_quality
from .plant_feet import MOCAP_OT_plant_feet
from .reconstruct import MOCAP_OT_reconstruct
from .reduce_keys import MOCAP_OT_reduce_keys
from .retarget import MOCAP_OT_retarget
from .revert_to_raw import MOCAP_OT_revert_to_raw
from .simulate import MOCAP_OT_simulate
from .solve_skeleton import MOCAP_OT_solve_skeleton

OPERATORS = (
    MOCAP_OT_import_recording,
    MOCAP_OT_import_job,
    MOCAP_OT_denoise,
    MOCAP_OT_reconstruct,
    MOCAP_OT_measure_quality,
    MOCAP_OT_jump_to_spot,
    MOCAP_OT_plant_feet,
    MOCAP_OT_learn_patterns,
    MOCAP_OT_simulate,
    MOCAP_OT_listen,
    MOCAP_OT_solve_skeleton,
    MOCAP_OT_retarget,
    MOCAP_OT_reduce_keys,
    MOCAP_OT_revert_to_raw,
)


def register() -> None:
    """Make the buttons known to Blender."""
    for operator in OPERATORS:
        bpy.utils.register_class(operator)


def unregister() -> None:
    """Take the buttons away again."""
    for operator in reversed(OPERATORS):
        bpy.utils.unregister_class(operator)
