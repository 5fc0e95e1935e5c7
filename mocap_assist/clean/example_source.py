"""Clean motion to learn from, and what is learned of it."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from ...solvers.denoising import (
    FilterBases,
    learn_filter_bases,
    learn_joint_limits,
    load_filter_bases,
)
from ...solvers.errors import InvalidFileError
from ...solvers.motion import JointLimits, Motion, Tracks
from ...solvers.progress import Progress, unwatched, within
from ...solvers.recordings import is_scene_file, read_motion_or_tracks
from ..jobs.in_blender import BackgroundBlender, read_blends

if TYPE_CHECKING:  # imports every family of solvers, which the process of Clean waits for
    from ..library.solve_prior import LibraryPrior


class Learned(NamedTuple):
    """Patterns and limits learned from examples."""

    bases: FilterBases | None
    limits: JointLimits | None
    message: str = ""
    """Source of the prior, if it differs from the setting, or files that were left out."""


class Examples(NamedTuple):
    """Clean motion, and a sentence about files of folders that could not be read."""

    clips: list[Motion | Tracks]
    remark: str = ""


@dataclass(frozen=True, eq=False, kw_only=True)
class ExampleSource:
    """Source of clean motion to learn from; by default the take itself."""

    motions: tuple[Motion, ...] = ()
    files: tuple[str, ...] = ()
    """Recordings, and files that the background Blender reads."""
    found: tuple[str, ...] = ()
    """The same from folders; those that cannot be read or have no motion are left out."""
    bases_file: str = ""
    library: "LibraryPrior | None" = None
    blender: BackgroundBlender | None = None

    def read(self, progress: Progress = unwatched) -> Examples:
        """Return the motions, and those in the files.

        Raises InvalidFileError if a file that was named cannot be read, or if none has motion.
        """
        paths = (*self.files, *self.found)
        scenes = [path for path in paths if is_scene_file(path)]
        others = [path for path in paths if path not in scenes]
        motions: list[Motion | Tracks] = list(self.motions)
        left_out: list[InvalidFileError] = []
        for index, path in enumerate(others):
            ends = (each / len(paths) for each in (index, index + 1))
            try:
                motions.append(read_motion_or_tracks(path, progress=within(progress, *ends)))
            except InvalidFileError as error:
                self._leave_out(path, error, left_out)
        if scenes and self.blender is not None:
            rest = within(progress, len(others) / len(paths), 1.0)
            read = read_blends(self.blender, scenes, progress=rest)
            for path, file in zip(scenes, read, strict=True):
                motions += [clip.motion for clip in file.clips]
                if not file.clips and not (file.is_empty and path in self.found):
                    refusal = InvalidFileError(" ".join(file.refused))
                    self._leave_out(path, refusal, left_out)
        if paths and not motions:
            raise InvalidFileError("None of the files in the folder of examples has motion.")
        return Examples(motions, _describe(left_out))

    def _leave_out(
        self, path: str, error: InvalidFileError, left_out: list[InvalidFileError]
    ) -> None:
        """Note a file of a folder that cannot be read; raise the error of a file named."""
        if path not in self.found:
            raise error
        left_out.append(error)

    def learned(self, body: Motion | Tracks, limits: bool, progress: Progress) -> Learned:
        """Learn from the examples, or load what was learned."""
        if self.library is not None:
            found = self.library.bases(body, progress)
            return Learned(found.bases, None, found.message)
        if self.bases_file:
            return Learned(load_filter_bases(self.bases_file), None)
        clips, remark = self.read(within(progress, 0.0, 0.5))
        if not clips:
            return Learned(None, None)
        bases = learn_filter_bases(clips, progress=within(progress, 0.5, 0.9))
        bodies = [clip for clip in clips if isinstance(clip, Motion)]
        return Learned(bases, learn_joint_limits(bodies) if limits else None, remark)


def _describe(left_out: list[InvalidFileError]) -> str:
    """Return a sentence about files that were left out."""
    if not left_out:
        return ""
    if len(left_out) == 1:
        return f"A file of the examples was left out: {left_out[0]}"
    return f"{len(left_out)} files of the examples were left out; the first: {left_out[0]}"
