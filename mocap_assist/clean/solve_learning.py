"""Solve of the button Learn."""

from ...solvers.denoising import FilterBases, FilterBasesSettings, learn_filter_bases
from ...solvers.progress import Progress, unwatched, within
from ...solvers.recordings import read_motion_or_tracks
from .solve_cleaning import ExampleSource


def learn(
    examples: ExampleSource, settings: FilterBasesSettings, *, progress: Progress = unwatched
) -> FilterBases:
    """Read the files among the examples, and learn from all of them."""
    files = []
    for index, path in enumerate(examples.files):
        fractions = (0.5 * index / len(examples.files), 0.5 * (index + 1) / len(examples.files))
        files.append(read_motion_or_tracks(path, progress=within(progress, *fractions)))
    clips = [*examples.motions, *files]
    return learn_filter_bases(clips, settings=settings, progress=within(progress, 0.5, 1.0))
