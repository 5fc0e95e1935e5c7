"""Solve of the button Learn."""

from ...solvers.denoising import FilterBases, FilterBasesSettings, learn_filter_bases
from ...solvers.progress import Progress, unwatched, within
from .example_source import ExampleSource


def learn(
    examples: ExampleSource, settings: FilterBasesSettings, *, progress: Progress = unwatched
) -> FilterBases:
    """Read the files among the examples, and learn from all of them."""
    clips = examples.read(within(progress, 0.0, 0.5)).clips
    return learn_filter_bases(clips, settings=settings, progress=within(progress, 0.5, 1.0))
