"""Variants against copies, Perlin noise and two methods written from their papers.

make bench-variation                    # some seven minutes
make bench-variation ARGUMENTS=--docs   # into docs/benchmarks/variation.md
make bench-variation ARGUMENTS=--dev    # sets to tune on, a minute
make bench-variation ARGUMENTS="--part sets --part pictures"
"""

import argparse
import sys
from collections.abc import Callable, Sequence
from functools import partial
from time import perf_counter

import numpy as np

from solvers.feet import PlantSettings
from solvers.motion import Motion
from solvers.progress import unwatched
from solvers.variation import (
    Variant,
    VariationModel,
    VaryMethod,
    VarySettings,
    borrow_variation,
    draw_variants,
    learn_variation_model,
    synthesize,
)
from solvers.variation.plant_variant import plant_variant

from ..shared.report import DOCS, Report
from ..shared.tables import Scores, number, table
from . import variation_peers as peers
from .plot_variation import draw_components, draw_strips
from .variation_discriminator import classification_accuracy
from .variation_measures import Judge
from .variation_sets import development_sets, scored_sets

Sets = dict[str, list[Motion]]
Maker = Callable[..., Sequence[Variant]]

N_VARIANTS, N_PLANTED = 20, 4
OURS = "mixture (default)"
MIN_SPLIT_EXAMPLES = 9
"""Minimum number of examples of a set of which a part is held out."""
EXCUSED = ("published", "Lau et al., from its description")
"""Methods that a classifier always distinguishes from captures."""
PARTS = ("figures", "sets", "examples", "discriminator", "pictures")
FEET = ("slide of examples", "slide drawn", "slide", "stands of examples %", "stands %")
SECONDS, LEARNING = "s per s", "s to learn"
UNIT = "each set counts as one clip"


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--dev", action="store_true", help="sets to tune on instead")
    parser.add_argument("--docs", action="store_true", help="rewrite the document")
    parser.add_argument("--part", choices=PARTS, action="append", help="only this; again")
    chosen = parser.parse_args()
    sets = development_sets() if chosen.dev else scored_sets()
    report = Report(chosen.docs, DOCS / "benchmarks" / "variation.md")
    parts: dict[str, Callable[[Sets], list[str]]] = dict(
        zip(PARTS, (measured, by_set, by_examples, discriminated, drawn), strict=True)
    )
    for name in chosen.part or PARTS:
        part = parts[name]
        started = perf_counter()
        texts = part(sets)
        report.part(name, texts, perf_counter() - started)


def measured(sets: Sets) -> list[str]:
    """Measure all methods on all sets."""
    scores = Scores(f"{len(sets)} sets, {N_VARIANTS} variants of each", UNIT, "")
    for name, examples in sets.items():
        judge = Judge(examples)
        for method, method_parts in methods().items():
            for column, figure in _figures(judge, method_parts).items():
                scores.add(method, column, name, figure)
        print(f"Done: {name}", file=sys.stderr, flush=True)
    return [scores.markdown()]


def by_set(sets: Sets) -> list[str]:
    """Measure the default method set by set, and the feet of its variants."""
    rest = Scores(f"{OURS}, by set", "one set each", "")
    feet = Scores(f"Feet of {OURS}, by set", "one set each", "")
    for name, examples in sets.items():
        for column, figure in _figures(Judge(examples), methods()[OURS]).items():
            (feet if column in FEET else rest).add(name, column, name, figure)
        print(f"Done by itself: {name}", file=sys.stderr, flush=True)
    return [one.markdown() for one in (rest, feet)]


def _figures(
    judge: Judge, method_parts: tuple[Callable[..., VariationModel] | None, Maker]
) -> dict[str, float]:
    variants, seconds, learning = _timed(method_parts, judge.examples)
    drawn = [one.motion for one in variants]
    planted = [_planted(one) for one in variants[:N_PLANTED]]
    figures = judge.figures(drawn) | judge.contacts_of(drawn[:N_PLANTED], planted)
    return figures | {SECONDS: seconds, LEARNING: learning}


def methods() -> dict[str, tuple[Callable[..., VariationModel] | None, Maker]]:
    """Return what learns, if anything does, and what makes variants."""
    found: dict[str, tuple[Callable[..., VariationModel] | None, Maker]] = {}
    for method, label in (
        (VaryMethod.MIXTURE, OURS),
        (VaryMethod.COREGIONALISED, "coregionalised"),
        (VaryMethod.PUBLISHED, "published"),
    ):
        settings = VarySettings(method=method)
        learn = partial(learn_variation_model, settings=settings)
        found[label] = (learn, partial(draw_variants, settings=settings, planting=None))
    found["one clip, generic"] = (
        lambda examples: borrow_variation(examples[0]),
        partial(draw_variants, planting=None),
    )
    for label, make in (
        ("copies", peers.copies),
        ("Perlin noise", peers.perlin),
        ("Lau et al., from its description", peers.lau),
        ("motion matching, from its paper", peers.motion_matching),
    ):
        found[label] = (None, partial(_seeded, make))
    return found


def _seeded(
    make: Callable[..., list[Motion]], examples: Sequence[Motion], n: int
) -> list[Variant]:
    return [Variant(one, None) for one in make(examples, n, np.random.default_rng(0))]


def _timed(
    method_parts: tuple[Callable[..., VariationModel] | None, Maker], examples: Sequence[Motion]
) -> tuple[Sequence[Variant], float, float]:
    """Return variants, seconds per second of motion, and seconds that learning takes."""
    learn, make = method_parts
    start = perf_counter()
    source = learn(examples) if learn else examples
    learned = perf_counter()
    variants = make(source, N_VARIANTS)
    made = perf_counter() - learned
    length = sum(one.motion.n_frames / one.motion.frame_rate for one in variants)
    return variants, made / length, learned - start


def by_examples(sets: Sets) -> list[str]:
    """Measure variation against the number of examples (fig. 4.6)."""
    counts, rows = (2, 3, 4, 6, 8, 10, 12), {}
    for name, examples in sets.items():
        if len(examples) < MIN_SPLIT_EXAMPLES:
            continue
        judge, cells = Judge(examples), []
        for count in counts:
            if count > len(examples):
                cells.append("-")
                continue
            model = learn_variation_model(examples[:count])
            variants = draw_variants(model, N_VARIANTS, planting=None)
            figures = judge.figures([one.motion for one in variants])
            cells.append(f"{number(figures['V'])} / {number(figures['coverage'])}")
        rows[name] = cells
    title = "**V in cm / coverage, against the number of examples** (mixture; fig. 4.6)\n\n"
    return [title + table(["set", *map(str, counts)], rows) + "\n"]


def _planted(variant: Variant) -> Motion:
    return plant_variant(*variant, PlantSettings(), unwatched)


def discriminated(sets: Sets) -> list[str]:
    """Train on variants of every second clip and on the clips between them."""
    rows: dict[str, list[str]] = {}
    large = {name: one for name, one in sets.items() if len(one) >= MIN_SPLIT_EXAMPLES}
    for examples in large.values():
        given, held = examples[::2], examples[1::2]
        rows.setdefault("the captures that variants are made of", []).append(
            number(classification_accuracy(held, given))
        )
        for method, method_parts in methods().items():
            if method in EXCUSED:
                continue
            variants = _timed(method_parts, given)[0]
            motions = [one.motion for one in variants]
            rows.setdefault(method, []).append(number(classification_accuracy(held, motions)))
            if method == OURS:
                planted = [_planted(one) for one in variants]
                accuracy = number(classification_accuracy(held, planted))
                rows.setdefault(f"{OURS}, feet planted", []).append(accuracy)
    title = "**Distinguished from held-out captures** (balanced accuracy, %; 50 is chance)\n\n"
    return [title + table(["method", *large], rows) + "\n"]


def drawn(sets: Sets) -> list[str]:
    """Draw principal components and strips."""
    made = {
        name: list(synthesize(learn_variation_model(examples), 15))
        for name, examples in sets.items()
    }
    texts = [draw_components({name: (sets[name], made[name]) for name in list(sets)[:8]})]
    texts.extend(
        f"{name}\n\n" + draw_strips(name, sets[name], made[name]) for name in list(sets)[::3]
    )
    return texts


if __name__ == "__main__":
    main()
