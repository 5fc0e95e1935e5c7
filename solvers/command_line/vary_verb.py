"""`vary`: synthesize variants of a few clips of one behavior."""

import argparse
from pathlib import Path

from ..denoising import PlantSettings
from ..errors import InvalidMotionError
from ..motion import Motion
from ..pictures import StickFigureSettings, draw_stick_figures, stack_pictures
from ..progress import Progress, within
from ..recordings import write_bvh
from ..variation import VarySettings, measure_variation
from ..workflows import vary_motions
from .arguments import (
    Outcome,
    Task,
    VerbWork,
    add_preset_option,
    add_reading_options,
    arguments_from,
    read_all,
    settings_from_arguments,
)

SHEET = "variants.png"
MAX_DRAWN_VARIANTS = 20
MAX_MEASURED_MOTIONS = 10


def add_vary_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `vary`."""
    parser.add_argument(
        "--output", type=Path, required=True, metavar="DIR",
        help=f"Folder for the variants: BVH files named after the first clip, and {SHEET}, a"
        " contact sheet",
    )  # fmt: skip
    parser.add_argument(
        "--number", type=int, default=20, metavar="N", help="Number of variants [default 20]"
    )
    parser.add_argument(
        "--plant-feet", action=argparse.BooleanOptionalAction, default=True,
        help="Keep standing feet from sliding",
    )  # fmt: skip
    add_reading_options(parser)
    add_preset_option(parser, "vary")
    arguments_from(parser, VarySettings)


def perform_vary(task: Task, prepared: None, progress: Progress) -> Outcome:
    """Synthesize variants of all clips, write them and a contact sheet."""
    arguments = task.arguments
    clips = read_all(task.sources, arguments, within(progress, 0.0, 0.2))
    motions = [clip for clip in clips if isinstance(clip, Motion)]
    if len(motions) < len(clips):
        raise InvalidMotionError(
            "Variants need motions of skeletons, but some files hold points."
        )
    variants = vary_motions(
        motions,
        arguments.number,
        settings=settings_from_arguments(arguments, VarySettings),
        planting=PlantSettings() if arguments.plant_feet else None,
        progress=within(progress, 0.2, 0.8),
    )
    assert task.target is not None
    task.target.mkdir(parents=True, exist_ok=True)
    digits = len(str(arguments.number))
    names = [
        f"{task.source.stem}.{number:0{digits}}.bvh"
        for number in range(1, arguments.number + 1)
    ]
    for index, (name, motion) in enumerate(zip(names, variants.motions, strict=True)):
        progress(0.8 + 0.15 * index / len(names), f"Writing {name}")
        write_bvh(motion, task.target / name)
    _draw(motions[0], variants.motions, task.target / SHEET)
    figures: dict[str, object] = {
        "n_examples": len(motions),
        "variants": names,
        "remarks": list(variants.remarks),
    }
    lines = [f"{len(names)} variants of {_count_clips(len(motions))} in {task.target}."]
    if len(motions) > 1 and len(names) > 1:
        groups = [motions[:MAX_MEASURED_MOTIONS], variants.motions[:MAX_MEASURED_MOTIONS]]
        example_variation, variation = (measure_variation(group) for group in groups)
        figures |= {"variation_of_examples_m": example_variation, "variation_m": variation}
        lines.append(
            f"Their mean pairwise distance is {100 * variation:.1f} cm, that of the clips"
            f" {100 * example_variation:.1f} cm."
        )
    return Outcome("\n".join([*lines, *variants.remarks]), figures)


def _count_clips(n: int) -> str:
    return "1 clip" if n == 1 else f"{n} clips"


def _draw(example: Motion, variants: tuple[Motion, ...], path: Path) -> None:
    settings = StickFigureSettings(n_figures=10, height=140)
    shown = {"example": example} | {
        f"variant {number}": motion
        for number, motion in enumerate(variants[:MAX_DRAWN_VARIANTS], 1)
    }
    stack_pictures([
        draw_stick_figures({name: motion}, settings=settings) for name, motion in shown.items()
    ]).save(path)  # fmt: skip


VARY = VerbWork(add_vary_options, perform_vary)
