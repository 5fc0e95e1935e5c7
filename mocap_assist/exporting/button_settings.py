"""Settings of the button Export."""

from dataclasses import dataclass
from typing import NamedTuple

from ...solvers.settings import Settings, setting
from ..actions.frames import FrameRange
from .file_formats import ExportedBones, FileFormat


@dataclass(frozen=True, kw_only=True)
class ExportChoices(Settings):
    """Settings of the export of a take."""

    file_format: FileFormat = setting(
        FileFormat.FBX,
        "Format of the file; a known file extension in the name overrides it",
        label="Format",
    )
    frame_range: FrameRange = setting(FrameRange.ACTION, "Frames of the action to export")
    exported_bones: ExportedBones = setting(ExportedBones.ALL, "Bones to export", label="Bones")
    meshes: bool = setting(
        False,
        "Include the meshes that the armature deforms; BVH has none",
        label="Skinned Meshes",
    )
    overwrite_recording: bool = setting(
        False, "Allow overwriting the file that the take was imported from"
    )


@dataclass(frozen=True, kw_only=True)
class ExportFile(Settings):
    """Location of the exported file."""

    filepath: str = setting("", "File to write", label="File")


class ExportPanelBundle(NamedTuple):
    """Settings that the sidebar keeps."""

    choices: ExportChoices


class ExportBundle(NamedTuple):
    """Settings of the button."""

    choices: ExportChoices
    file: ExportFile
