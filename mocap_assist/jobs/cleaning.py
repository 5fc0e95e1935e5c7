"""What the button Clean has solved for it: every part of a take denoised, then feet planted."""

from dataclasses import dataclass

from ...solvers.denoising import (
    Denoised,
    DenoiseSettings,
    FilterBases,
    denoise,
    learn_filter_bases,
    load_filter_bases,
)
from ...solvers.motion import Motion, Tracks
from ...solvers.progress import Progress, unwatched, within
from ...solvers.recordings import read_bvh

LEARNING = 0.2  # share of the time that learning from examples takes


@dataclass(frozen=True, eq=False, kw_only=True)
class Examples:
    """Where clean motion to learn from comes from; with nothing given, the take itself."""

    motions: tuple[Motion, ...] = ()
    files: tuple[str, ...] = ()
    bases_file: str = ""

    def bases(self, progress: Progress) -> FilterBases | None:
        """Learn, or load what was learned."""
        if self.bases_file:
            return load_filter_bases(self.bases_file)
        clips = [*self.motions, *map(read_bvh, self.files)]
        return learn_filter_bases(clips, progress=progress) if clips else None


@dataclass(frozen=True, eq=False)
class Cleaned:
    """The parts of a take after cleaning, in the order in which they came."""

    denoised: tuple[Denoised, ...]

    @property
    def recordings(self) -> tuple[Motion | Tracks, ...]:
        """What is to be written."""
        return tuple(each.recording for each in self.denoised)


def clean(
    recordings: tuple[Motion | Tracks, ...],
    settings: DenoiseSettings,
    examples: Examples,
    *,
    progress: Progress = unwatched,
) -> Cleaned:
    """Denoise the body by what the examples teach, and all else by what the take teaches."""
    start = LEARNING if examples.motions or examples.files else 0.0
    bases = examples.bases(within(progress, 0.0, start))
    sizes = [1 if isinstance(each, Tracks) else each.n_joints for each in recordings]
    denoised = []
    for index, recording in enumerate(recordings):
        share = [
            start + (1.0 - start) * sum(sizes[:n]) / sum(sizes) for n in (index, index + 1)
        ]
        denoised.append(
            denoise(
                recording,
                None if index else bases,
                settings=settings,
                progress=within(progress, *share),
            )
        )
    return Cleaned(tuple(denoised))
