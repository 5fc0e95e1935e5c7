"""The verbs of `python -m solvers`."""

import argparse
from dataclasses import replace
from pathlib import Path

from ..denoising import (
    FilterBasesSettings,
    QualitySettings,
    learn_filter_bases,
    measure_quality,
)
from ..progress import Progress, overheard, within
from ..recordings import depth_in
from .capture_verb import add_capture_options, perform_capture, read_body
from .convert import convert
from .denoise_verb import add_denoise_options, learn_once, perform_denoise
from .files import add_reading_options, read, read_all
from .library_verbs import add_find_options, add_index_options, perform_find, perform_index
from .options import arguments_from, settings_from_arguments
from .postures_verb import add_postures_options, perform_postures
from .reconstruct_verb import add_reconstruct_options, perform_reconstruct, read_guides
from .replay_verb import add_replay_options, perform_replay
from .residuals_verb import add_residuals_options, perform_residuals
from .retarget_verbs import (
    add_retarget_options,
    add_unbake_options,
    perform_retarget,
    perform_unbake,
    read_target,
)
from .simulate_verb import add_simulate_options, perform_simulate
from .solve_verb import add_solve_options, perform_solve
from .vary_verb import add_vary_options, perform_vary
from .verb import Makes, Outcome, Task, Verb


def _learn_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--output", type=Path, required=True, metavar="FILE",
        help="The .npz file to write; denoise --bases and the button Clean read it",
    )  # fmt: skip
    add_reading_options(parser)
    arguments_from(parser, FilterBasesSettings)


def _learn(task: Task, prepared: None, progress: Progress) -> Outcome:
    settings = settings_from_arguments(task.arguments, FilterBasesSettings)
    clips = read_all(task.sources, task.arguments, within(progress, 0.0, 0.5))
    bases = learn_filter_bases(clips, settings=settings, progress=within(progress, 0.5, 1.0))
    assert task.target is not None
    bases.save(task.target)
    figures = {
        "n_clips": int(bases.n_clips),
        "n_patterns": len(bases.values),
        "window_frames": bases.window,
        "frame_rate_hz": float(bases.frame_rate),
        "parts": [str(key) for key in bases.keys],
    }
    clips_said = "1 clip" if len(clips) == 1 else f"{len(clips)} clips"
    text = f"Learned {len(bases.values)} patterns from {clips_said} into {task.target}."
    return Outcome(text, figures)


def _quality_options(parser: argparse.ArgumentParser) -> None:
    add_reading_options(parser)
    arguments_from(parser, QualitySettings)


def _quality(task: Task, prepared: None, progress: Progress) -> Outcome:
    recording = read(task.source, task.arguments, within(progress, 0.0, 0.5))
    settings = settings_from_arguments(task.arguments, QualitySettings)
    quality = measure_quality(recording, settings=settings, progress=within(progress, 0.5, 1.0))
    return Outcome(quality.report(), quality.figures())


def _convert(task: Task, prepared: None, progress: Progress) -> Outcome:
    told: list[str] = []
    listening = overheard(within(progress, 0.0, 0.7), told)
    recording = read(task.source, task.arguments, listening)
    done = convert(recording, task.target, within(progress, 0.7, 1.0))
    return replace(done, text=" ".join([done.text, *(f"{one}." for one in told)]))


VERBS = {
    "denoise": Verb(
        "Take jitter, spikes and gaps out of recordings, and keep standing feet from sliding.",
        add_denoise_options,
        perform_denoise,
        prepare=learn_once,
    ),
    "learn": Verb(
        "Learn from clean clips how a kind of motion goes, once, for many takes.",
        _learn_options,
        _learn,
        Makes.ONE_FILE,
    ),
    "quality": Verb(
        "Measure jitter, spikes, gaps and sliding feet.",
        _quality_options,
        _quality,
        Makes.WORDS,
    ),
    "solve": Verb(
        "Solve the motion of a skeleton from the labelled markers of optical takes.",
        add_solve_options,
        perform_solve,
        writes_motions=True,
    ),
    "capture": Verb(
        "Track the actor whom a depth camera recorded: pictures of depth become motion.",
        add_capture_options,
        perform_capture,
        writes_motions=True,
        writes_joints=True,
        look=depth_in,
        prepare=read_body,
    ),
    "reconstruct": Verb(
        "Rebuild clean poses from the joints that a depth camera's tracker saw.",
        add_reconstruct_options,
        perform_reconstruct,
        writes_motions=True,
        writes_joints=True,
        prepare=read_guides,
    ),
    "learn-residuals": Verb(
        "Learn how a depth camera errs from takes that another system saw as well.",
        add_residuals_options,
        perform_residuals,
        Makes.ONE_FILE,
    ),
    "learn-postures": Verb(
        "Keep the postures of clean clips, for reconstruct to guess lost joints from.",
        add_postures_options,
        perform_postures,
        Makes.ONE_FILE,
    ),
    "simulate": Verb(
        "Let a body with mass and muscles, on solid ground, make motions of a skeleton.",
        add_simulate_options,
        perform_simulate,
    ),
    "index": Verb(
        "Put recordings into a library in which there can be searched, and keep it up to date.",
        add_index_options,
        perform_index,
        Makes.LIBRARY,
    ),
    "find": Verb(
        "Find what in a library is like a recording, and where in which clip it is.",
        add_find_options,
        perform_find,
        Makes.MATCHES,
    ),
    "vary": Verb(
        "Make new motions like a few clips of one behaviour, each different.",
        add_vary_options,
        perform_vary,
        Makes.MANY_FILES,
    ),
    "convert": Verb(
        "Write recordings of any known format as BVH, or as C3D or TRC where they are points.",
        add_reading_options,
        _convert,
    ),
    "retarget": Verb(
        "Give motions to another skeleton, whatever its names, lengths and rest pose.",
        add_retarget_options,
        perform_retarget,
        prepare=read_target,
    ),
    "replay": Verb(
        "Send recordings to this machine as a live stream, as a depth camera's tracker would.",
        add_replay_options,
        perform_replay,
        Makes.WORDS,
    ),
    "unbake": Verb(
        "Replace a key on every frame by few keys with handles.",
        add_unbake_options,
        perform_unbake,
    ),
}
"""A new verb is a new entry here."""
