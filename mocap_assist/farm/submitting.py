"""Submit Folder: read the preferences, and report what the Flamenco Manager accepted."""

from pathlib import Path

import bpy

from ...solvers.errors import InvalidSettingError
from ..jobs.protocol import PreviewSolve
from ..panel_parts.preference_values import preference_value
from .button_settings import FarmBundle
from .solve_submitting import Submission, Submitted, submit_takes

OUTPUT_ENDING = "_fixed"
"""Ending of the default output folder, next to that of the takes."""
NO_MANAGER = "Enter the address of your Flamenco Manager in the preferences of Mocap Assist."
OFFLINE = (
    "Blender's online access is off. Allow it in Preferences > System to submit jobs to a farm."
)
RETARGETS = (
    "The farm fixes takes without a scene, and cannot retarget them. Clear Retarget To in Last"
    " Steps."
)
NO_NAMES = ("", "..")
"""Last part of a drive, of an empty path, and of the folder above another one."""
UNNAMED = "Choose a folder of takes that has a name, or choose an output folder as well."


def why_not_submit(context: bpy.types.Context) -> str:
    """Return why no job can be submitted, or an empty text."""
    if not preference_value("flamenco_manager").strip():
        return NO_MANAGER
    return "" if bpy.app.online_access else OFFLINE


def read_submission(
    takes: Path, output_folder: Path | None, settings: FarmBundle
) -> PreviewSolve[Submitted]:
    """Return the submission of a folder. Its paths are absolute: workers have other folders.

    The address and the command come from the preferences: a .blend file of another person
    cannot set them.
    """
    if bpy.context.scene.mocap_assist.fix.rig:
        raise InvalidSettingError(RETARGETS)
    if output_folder is None:
        if takes.name in NO_NAMES:
            raise InvalidSettingError(UNNAMED)
        output_folder = takes.with_name(takes.name + OUTPUT_ENDING)
    problem = Submission(
        takes=takes.absolute(),
        output_folder=output_folder.absolute(),
        address=preference_value("flamenco_manager"),
        command=preference_value("flamenco_command"),
        settings=settings.job,
        fixing=settings.fixing,
    )
    return PreviewSolve(submit_takes, problem)


def report_submitted(
    takes: Path,
    output_folder: Path | None,
    settings: FarmBundle,
    submitted: Submitted,
    solved_digest: str | None = None,
) -> str:
    """Return the message for the status bar."""
    message = f"Submitted {submitted.n_takes} takes of {takes.name} to {submitted.job.page}."
    if submitted.n_left_out:
        message += (
            f" {submitted.n_left_out} files need Blender and were left out."
            " Move them to another folder and press Fix Folder there."
        )
    return message
