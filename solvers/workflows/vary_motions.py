"""From a few clips to many: variants with planted feet."""

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
    learn_variation_model,
    middle_round,
    repeated,
)
from .plant_feet_if_possible import Footing, plant_feet_if_possible


@dataclass(frozen=True, eq=False)
class Variants:
    """New motions, and what is to be said of them.

    Attributes
    ----------
    motions : tuple of Motion
    loops : tuple of bool
        Which end as they begin, because the examples do.
    remarks : tuple of str
        What seems wrong with the examples, or why feet could not be planted.
    """

    motions: tuple[Motion, ...]
    loops: tuple[bool, ...]
    remarks: tuple[str, ...]


ROUNDS = 3
"""Of a loop that are planted together: the middle one goes on at both ends."""
USUAL, PLANTING = VarySettings(), PlantSettings()


def vary_motions(
    examples: Sequence[Motion],
    n_variants: int,
    *,
    settings: VarySettings = USUAL,
    planting: PlantSettings | None = PLANTING,
    progress: Progress = unwatched,
) -> Variants:
    """Make variants of examples of one behaviour, and plant their feet.

    Parameters
    ----------
    examples : Motion
        Of one rig and without gaps. How a single one varies is borrowed, and said.
    n_variants : int
    settings : VarySettings
    planting : PlantSettings or None
        None leaves feet as they are.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        The examples do not go together; see `learn_variation_model`.
    """
    if len(examples) == 1:
        model = borrow_variation(examples[0])
    else:
        model = learn_variation_model(
            examples, settings=settings, progress=within(progress, 0.0, 0.3)
        )
    drawn = draw_variants(
        model, n_variants, settings=settings, progress=within(progress, 0.3, 0.4)
    )
    remarks = [model.warning] if model.warning else []
    planted = []
    for place, variant in enumerate(drawn):
        part = within(progress, 0.4 + 0.6 * place / n_variants, 1.0)
        part(0.0, f"Planting feet of variant {place + 1}")
        footing = stand(variant, planting)
        remarks += [remark for remark in footing.remarks if remark not in remarks]
        planted.append(footing.motion)
    progress(1.0)
    return Variants(tuple(planted), tuple(one.loops for one in drawn), tuple(remarks))


def stand(variant: Variant, planting: PlantSettings | None = PLANTING) -> Footing:
    """Plant the feet of a variant when those of its examples stood, and its own stand.

    A loop stays one.
    """
    motion, contacts, is_loop = variant
    if planting is None:
        return plant_feet_if_possible(motion, None)
    if is_loop:
        motion = repeated(motion, ROUNDS)
        if contacts is not None:
            contacts = np.concatenate([*[contacts[:-1]] * ROUNDS, contacts[-1:]])
    if contacts is not None:
        contacts = contacts | detect_contacts(motion)
    footing = plant_feet_if_possible(motion, planting, contacts)
    if is_loop:
        return footing._replace(motion=middle_round(footing.motion, variant.motion))
    return footing
