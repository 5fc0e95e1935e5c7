"""`python -m solvers VERB ...`: the project without Blender.

Its options also serve `blender --command mocap_assist`.
"""

from .options import (
    SentenceParser,
    add_preset_option,
    arguments_from,
    settings_from_arguments,
)

__all__ = [
    "SentenceParser",
    "add_preset_option",
    "arguments_from",
    "settings_from_arguments",
]
