"""Perform a verb on many files: tasks, records, workers, progress and report."""

from typing import TYPE_CHECKING

from ...import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .batch import (
        FinishedTask,
        already_made,
        draw_task,
        has_called_hook,
        made_record,
        note_other_builds,
        record_end,
        report_folder,
        task_entries,
        verb_name,
        work_if_unclaimed,
    )
    from .files_of_people import (
        check_files_of_people,
        check_is_no_person,
        left_of_earlier_run,
        path_of_person,
        take_of_person,
    )
    from .parallel import run_tasks, until_released, workers_for
    from .report import PAGE, PICTURE, has_picture, picture_file, remove_picture, write_report
    from .screen import Screen, escape_undecodable_names, printable
    from .tasks import check_output_folder, find_inputs, note_pipe, shared_tasks, tasks_of

__all__ = [
    "PAGE",
    "PICTURE",
    "FinishedTask",
    "Screen",
    "already_made",
    "check_files_of_people",
    "check_is_no_person",
    "check_output_folder",
    "draw_task",
    "escape_undecodable_names",
    "find_inputs",
    "has_called_hook",
    "has_picture",
    "left_of_earlier_run",
    "made_record",
    "note_other_builds",
    "note_pipe",
    "path_of_person",
    "picture_file",
    "printable",
    "record_end",
    "remove_picture",
    "report_folder",
    "run_tasks",
    "shared_tasks",
    "take_of_person",
    "task_entries",
    "tasks_of",
    "until_released",
    "verb_name",
    "work_if_unclaimed",
    "workers_for",
    "write_report",
]

import_on_demand(__name__)
