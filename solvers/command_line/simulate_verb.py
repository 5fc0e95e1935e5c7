"""`simulate`: track recorded motions with a physical body."""

import argparse

import numpy as np

from ..errors import InvalidMotionError
from ..motion import Motion
from ..physics import Simulated, SimulateSettings, describe_first_failure, simulate
from ..progress import Progress, within
from .arguments import (
    Outcome,
    Task,
    VerbWork,
    add_preset_option,
    add_reading_options,
    arguments_from,
    read,
    settings_from_arguments,
    write,
)


def add_simulate_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `simulate`."""
    add_reading_options(parser)
    add_preset_option(parser, "simulate")
    arguments_from(parser, SimulateSettings)


def perform_simulate(task: Task, prepared: None, progress: Progress) -> Outcome:
    """Simulate one motion, write it and report penetration and foot slide."""
    motion = read(task.source, task.arguments, within(progress, 0.0, 0.1))
    if not isinstance(motion, Motion):
        raise InvalidMotionError(
            f"{task.source} holds points without a skeleton. Solve a skeleton from labeled"
            " markers with the verb solve first."
        )
    settings = settings_from_arguments(task.arguments, SimulateSettings)
    simulated = simulate(motion, settings=settings, progress=within(progress, 0.1, 0.95))
    write(simulated.motion, task.target, within(progress, 0.95, 1.0))
    return Outcome(_summary(simulated), _figures(simulated))


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


def _summary(simulated: Simulated) -> str:
    frames = range(1, len(simulated.followed) + 1)
    failure = describe_first_failure(simulated.followed, frames)
    message = f"{simulated.message} {failure}".rstrip()
    return (
        f"{message} Maximum ground penetration was"
        f" {100 * simulated.penetration_before:.1f} cm, now"
        f" {100 * simulated.penetration_after:.1f} cm; feet in contact slid"
        f" {100 * simulated.slide_before:.0f} cm in total, now"
        f" {100 * simulated.slide_after:.0f} cm. Joints moved by"
        f" {100 * simulated.distance:.1f} cm on average."
    )


SIMULATE = VerbWork(add_simulate_options, perform_simulate)
