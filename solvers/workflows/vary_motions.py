"""Synthesize variants of a few clips, with planted feet."""

from collections.abc import Sequence
from dataclasses import dataclass

from ..feet import PlantSettings
from ..motion import Motion
from ..progress import Progress, Remark, collect_remarks, unwatched, within
from ..variation import (
    VarySettings,
    borrow_variation,
    draw_variants,
    learn_variation_model,
)


@dataclass(frozen=True, eq=False)
class Variants:
    """New motions and remarks on them.

    Attributes
    ----------
    motions : tuple of Motion
    loops : tuple of bool
        Whether each variant is a loop, as the examples are.
    remarks : tuple of str
        Problems of the examples, or why feet could not be planted.
    """

    motions: tuple[Motion, ...]
    loops: tuple[bool, ...]
    remarks: tuple[str, ...]


VARY_SETTINGS, PLANT_SETTINGS = VarySettings(), PlantSettings()


def vary_motions(
    examples: Sequence[Motion],
    n_variants: int,
    *,
    settings: VarySettings = VARY_SETTINGS,
    planting: PlantSettings | None = PLANT_SETTINGS,
    progress: Progress = unwatched,
) -> Variants:
    """Synthesize variants of examples of one behavior, and plant their feet.

    Parameters
    ----------
    examples : Motion
        Of one rig and without gaps. A single example gets shipped variation, with a remark.
    n_variants : int
    settings : VarySettings
    planting : PlantSettings or None
        None skips planting.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        The examples do not fit together; see `learn_variation_model`.
    """
    if len(examples) == 1:
        model = borrow_variation(examples[0])
    else:
        model = learn_variation_model(
            examples, settings=settings, progress=within(progress, 0.0, 0.3)
        )
    remarks = [Remark(model.warning)] if model.warning else []
    variants = draw_variants(
        model,
        n_variants,
        settings=settings,
        planting=planting,
        progress=collect_remarks(within(progress, 0.3, 1.0), remarks),
    )
    return Variants(
        tuple(variant.motion for variant in variants),
        tuple(variant.loops for variant in variants),
        tuple(remarks),
    )
