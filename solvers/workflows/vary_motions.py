"""Synthesize variants of a few clips, with planted feet."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..denoising import PlantSettings
from ..motion import Motion
from ..motion.humanoid import detect_contacts
from ..progress import Progress, unwatched, within
from ..variation import (
    Variant,
    VarySettings,
    borrow_variation,
    draw_variants,
    extract_middle_cycle,
    learn_variation_model,
    repeat_loop,
)
from .plant_feet_if_possible import PlantingResult, plant_feet_if_possible


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


N_CYCLES = 3
"""Number of cycles of a loop to plant together. By definition: the middle one of three
continues at both ends."""
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
    variants = draw_variants(
        model, n_variants, settings=settings, progress=within(progress, 0.3, 0.4)
    )
    remarks = [model.warning] if model.warning else []
    planted = []
    for index, variant in enumerate(variants):
        variant_progress = within(progress, 0.4 + 0.6 * index / n_variants, 1.0)
        variant_progress(0.0, f"Planting feet of variant {index + 1}")
        result = plant_variant(variant, planting)
        remarks += [remark for remark in result.remarks if remark not in remarks]
        planted.append(result.motion)
    progress(1.0)
    return Variants(
        tuple(planted), tuple(variant.loops for variant in variants), tuple(remarks)
    )


def plant_variant(
    variant: Variant, planting: PlantSettings | None = PLANT_SETTINGS
) -> PlantingResult:
    """Plant the feet of a variant where its examples or the variant itself are in contact.

    A loop stays a loop.
    """
    motion, contacts, is_loop = variant
    if planting is None:
        return plant_feet_if_possible(motion, None)
    if is_loop:
        motion = repeat_loop(motion, N_CYCLES)
        if contacts is not None:
            contacts = np.concatenate([*[contacts[:-1]] * N_CYCLES, contacts[-1:]])
    if contacts is not None:
        contacts = contacts | detect_contacts(motion)
    result = plant_feet_if_possible(motion, planting, contacts)
    if is_loop:
        return result._replace(motion=extract_middle_cycle(result.motion, variant.motion))
    return result
