"""`python -m solvers VERB ...`: the project without Blender.

`arguments_from` and `settings_from_arguments` also serve `blender --command mocap_assist`.
"""

from .options import SentenceParser, arguments_from, settings_from_arguments

__all__ = ["SentenceParser", "arguments_from", "settings_from_arguments"]
