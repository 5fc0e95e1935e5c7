"""`simulate`: let a body with mass and muscles make recorded motions."""

import argparse

import numpy as np

from ..errors import InvalidMotionError
from ..motion import Motion
from ..physics import Simulated, SimulateSettings, simulate
from ..progress import Progress, within
from .files import add_reading_options, read, write
from .options import arguments_from, settings_from_arguments
from .verb import Outcome, Task


def add_simulate_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `simulate`."""
    add_reading_options(parser)
    arguments_from(parser, SimulateSettings)


def perform_simulate(task: Task, prepared: None, progress: Progress) -> Outcome:
    """Simulate one motion and write it; tell how the feet and the ground fared."""
    motion = read(task.source, task.arguments, within(progress, 0.0, 0.1))
    if not isinstance(motion, Motion):
        raise InvalidMotionError(
            f"{task.source} holds points without a skeleton; only skeletons have a body that"
            " can be simulated. Make one of labelled markers with the verb solve."
        )
    settings = settings_from_arguments(task.arguments, SimulateSettings)
    simulated = simulate(motion, settings=settings, progress=within(progress, 0.1, 0.95))
    write(simulated.motion, task.target, within(progress, 0.95, 1.0))
    return Outcome(_said(simulated), _figures(simulated))


def _figures(simulated: Simulated) -> dict[str, object]:
    return {
        "n_frames": simulated.motion.n_frames,
        "frames_not_followed": int((~simulated.followed).sum()),
        "message": simulated.message,
        "ground_m": simulated.ground,
        "penetration_before_m": simulated.penetration_before,
        "penetration_after_m": simulated.penetration_after,
        "slide_before_m": simulated.slide_before,
        "slide_after_m": simulated.slide_after,
        "distance_m": simulated.distance,
        "mean_support": float(np.mean(simulated.support)),
    }


def _said(simulated: Simulated) -> str:
    return (
        f"{simulated.message} The body was {100 * simulated.penetration_before:.1f} cm under"
        f" the ground at worst, now {100 * simulated.penetration_after:.1f} cm; its feet slid"
        f" {100 * simulated.slide_before:.0f} cm in all while they touched it, now"
        f" {100 * simulated.slide_after:.0f} cm. Joints moved by"
        f" {100 * simulated.distance:.1f} cm on average."
    )
