"""Solve of the button Learn: filter bases of the files among the examples."""

from typing import NamedTuple

from ...solvers.denoising import FilterBases, FilterBasesSettings, learn_filter_bases
from ...solvers.progress import Progress, unwatched, within
from .example_source import ExampleSource


class Patterns(NamedTuple):
    """What was learned, and a sentence about files that could not be read."""

    bases: FilterBases
    remark: str


def learn(
    examples: ExampleSource, settings: FilterBasesSettings, *, progress: Progress = unwatched
) -> Patterns:
    """Read the files among the examples, and learn from all of them."""
    clips, remark = examples.read(within(progress, 0.0, 0.5))
    bases = learn_filter_bases(clips, settings=settings, progress=within(progress, 0.5, 1.0))
    return Patterns(bases, remark)
