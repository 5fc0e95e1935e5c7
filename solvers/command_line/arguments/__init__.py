"""What the verbs share: their description, options, and the recordings that they are given."""

from typing import TYPE_CHECKING

from ...import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .files import (
        FOR_JOINTS,
        FOR_MOTIONS,
        JOINTS,
        LEARNED,
        MOTIONS,
        POINTS_BY_DEFAULT,
        RECORDED,
        add_body_option,
        add_reading_options,
        bodies_in,
        check_name_length,
        check_target,
        convert,
        find_recordings,
        output_extension,
        read,
        read_all,
        read_on_floor,
        read_recorded,
        scene_files_in,
        unique_targets,
        with_body,
        write,
    )
    from .options import (
        SentenceParser,
        add_cluster_option,
        add_preset_option,
        add_sharing_options,
        arguments_from,
        settings_from_arguments,
    )
    from .verb_description import Outcome, OutputKind, Task, Verb, VerbWork

__all__ = [
    "FOR_JOINTS",
    "FOR_MOTIONS",
    "JOINTS",
    "LEARNED",
    "MOTIONS",
    "POINTS_BY_DEFAULT",
    "RECORDED",
    "Outcome",
    "OutputKind",
    "SentenceParser",
    "Task",
    "Verb",
    "VerbWork",
    "add_body_option",
    "add_cluster_option",
    "add_preset_option",
    "add_reading_options",
    "add_sharing_options",
    "arguments_from",
    "bodies_in",
    "check_name_length",
    "check_target",
    "convert",
    "find_recordings",
    "output_extension",
    "read",
    "read_all",
    "read_on_floor",
    "read_recorded",
    "scene_files_in",
    "settings_from_arguments",
    "unique_targets",
    "with_body",
    "write",
]

import_on_demand(__name__)
