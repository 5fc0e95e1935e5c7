"""What an animator chooses for Index and Find Similar, besides the settings of the search."""

from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

from ...solvers.retrieval import FindSettings
from ...solvers.settings import Settings, setting
from ..actions.armature_write import Output
from ..actions.frames import FrameRange
from ..runtime.selection import Bones


@dataclass(frozen=True, kw_only=True)
class LibraryChoices(Settings):
    """Which library, and what is in it."""

    library_file: str = setting(
        "", "File of the clip library; empty for the one that all your files share"
    )
    sources: str = setting(
        "", "Recordings, .blend files and folders of them, separated by semicolons"
    )
    asset_libraries: bool = setting(
        False,
        "Index the actions that are assets in all asset libraries of the preferences, too",
    )
    rig_file: str = setting(
        "",
        ".blend file with the rig of actions that lie in a file without one",
    )
    tags: str = setting("", "Tags that these clips get, separated by commas")


class LibraryBundle(NamedTuple):
    """All that the button Index offers."""

    choices: LibraryChoices


@dataclass(frozen=True, kw_only=True)
class FindChoices(Settings):
    """What of the action is looked for."""

    frame_range: FrameRange = setting(
        FrameRange.ACTION, "Look for all frames of the action, or only for some of them"
    )
    bones: Bones = setting(
        Bones.ALL,
        "Compare the parts of the body that are chosen below, or those of the selected bones",
    )


class FindBundle(NamedTuple):
    """All that the button Find Similar offers."""

    choices: FindChoices
    finding: FindSettings


class Part(Enum):
    """What of the clip is taken."""

    MATCH = "what matches"
    WHOLE = "whole clip"


@dataclass(frozen=True, kw_only=True)
class LoadChoices(Settings):
    """How a clip comes to the armature."""

    part: Part = setting(Part.MATCH, "Take the frames that are like the query, or all of them")
    result_as: Output = setting(
        Output.ACTION,
        "Let the armature play the clip in the place of its action, or put it on an NLA track"
        " at the current frame, as long as what it is like",
    )
    at_query: bool = setting(
        True, "Let it begin where the query stands, facing the same way", label="Stand There"
    )


@dataclass(frozen=True, kw_only=True)
class UseChoices(Settings):
    """Which matches become examples of Vary."""

    n_best: int = setting(
        5, "How many of the best serve; more show more of how the behaviour varies",
        minimum=1, maximum=10, label="Clips",
    )  # fmt: skip


class UseBundle(NamedTuple):
    """All that the button Use as Examples offers."""

    choices: UseChoices


class LoadBundle(NamedTuple):
    """All that the button offers."""

    choices: LoadChoices
