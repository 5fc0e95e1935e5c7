"""Settings of Build Library and Find Similar, in addition to those of the search."""

from dataclasses import dataclass
from typing import NamedTuple

from ...solvers.retrieval import FindSettings
from ...solvers.settings import Choice, Settings, setting
from ..actions.armature_write import Output
from ..actions.frames import FrameRange
from ..runtime.selection import Bones


@dataclass(frozen=True, kw_only=True)
class LibraryChoices(Settings):
    """File of the library, and the sources of its clips."""

    library_file: str = setting(
        "",
        "File that stores the library; empty for the one that all your projects share",
        label="Library File",
    )
    sources: str = setting(
        "", "Recordings, .blend files and folders of them, separated by semicolons"
    )
    asset_libraries: bool = setting(
        False,
        "Also index the action assets of all asset libraries in the preferences",
    )
    rig_file: str = setting(
        "",
        "File (.blend) with a rig, to read actions of files that have no armature themselves",
        label="Action Rig",
    )
    tags: str = setting(
        "",
        "Words such as walk, tired, separated by commas, shown with these clips when found",
        label="Clip Tags",
    )


class LibraryBundle(NamedTuple):
    """Settings of the button Build Library."""

    choices: LibraryChoices


@dataclass(frozen=True, kw_only=True)
class FindChoices(Settings):
    """Part of the action that is the query."""

    frame_range: FrameRange = setting(FrameRange.ACTION, "Frames of the action to search for")
    bones: Bones = setting(
        Bones.ALL,
        "Compare the body parts chosen below, or those of the selected bones",
    )


class FindBundle(NamedTuple):
    """Settings of the button Find Similar."""

    choices: FindChoices
    finding: FindSettings


class ClipPart(Choice):
    """Part of the clip that is loaded."""

    MATCH = "what matches", "Append only the frames that match the query", "Matching Frames"
    WHOLE = "whole clip", "Append all frames of the clip"


@dataclass(frozen=True, kw_only=True)
class LoadChoices(Settings):
    """Settings of the loading of a clip."""

    part: ClipPart = setting(ClipPart.MATCH, "Frames of the clip to append")
    result_as: Output = setting(
        Output.ACTION,
        "Assign the clip as an action, or add it to the NLA at this frame, in the query's"
        " timing",
        label="Output",
    )
    at_query: bool = setting(
        True, "Start where the query stands, facing the same direction", label="Place at Query"
    )


@dataclass(frozen=True, kw_only=True)
class UseChoices(Settings):
    """Choice of the matches that become examples of Vary."""

    n_best: int = setting(
        5, "Number of best matches to use; more gives more variation",
        minimum=1, maximum=10, label="Clips",
    )  # fmt: skip


class UseBundle(NamedTuple):
    """Settings of the button Use as Examples."""

    choices: UseChoices


class LoadBundle(NamedTuple):
    """Settings of the button."""

    choices: LoadChoices
