"""The verbs of `python -m solvers`."""

import argparse
from pathlib import Path

from ..denoising import (
    FilterBasesSettings,
    QualitySettings,
    learn_filter_bases,
    measure_quality,
)
from ..progress import Progress, within
from ..recordings import FloorPlacementSettings, depth_takes_in, takes_in
from .arguments import (
    Outcome,
    OutputKind,
    Task,
    Verb,
    add_reading_options,
    arguments_from,
    convert,
    read,
    read_all,
    settings_from_arguments,
)
from .batches import report_folder
from .capture_verb import add_capture_options, perform_capture, read_body
from .denoise_verb import add_denoise_options, learn_prior, perform_denoise
from .fix_verb import add_fix_options, perform_fix
from .library_verbs import add_find_options, add_index_options, perform_find, perform_index
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


def _learn_options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--output", type=Path, required=True, metavar="FILE",
        help="The .npz file to write, for denoise --bases and the button Clean",
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
    clips_text = "1 clip" if len(clips) == 1 else f"{len(clips)} clips"
    text = f"Learned {len(bases.values)} patterns from {clips_text} into {task.target}."
    return Outcome(text, figures)


def _quality_options(parser: argparse.ArgumentParser) -> None:
    add_reading_options(parser)
    arguments_from(parser, QualitySettings)


def _quality(task: Task, prepared: None, progress: Progress) -> Outcome:
    recording = read(task.source, task.arguments, within(progress, 0.0, 0.5))
    settings = settings_from_arguments(task.arguments, QualitySettings)
    quality = measure_quality(recording, settings=settings, progress=within(progress, 0.5, 1.0))
    return Outcome(quality.report(), quality.figures())


def _convert_options(parser: argparse.ArgumentParser) -> None:
    add_reading_options(parser)
    arguments_from(parser, FloorPlacementSettings)


def _convert(task: Task, prepared: None, progress: Progress) -> Outcome:
    reading = within(progress, 0.0, 0.7)
    floor = settings_from_arguments(task.arguments, FloorPlacementSettings).place_on_floor
    recording = read(task.source, task.arguments, reading, floor)
    return convert(recording, task.target, within(progress, 0.7, 1.0))


def _report_options(parser: argparse.ArgumentParser) -> None:
    """Add no options."""


VERBS = {
    "fix": Verb(
        "Fix takes of any origin by what suits them: track, clean, solve or reconstruct.",
        add_fix_options,
        perform_fix,
        writes_motions=True,
        list_recordings=takes_in,
    ),
    "denoise": Verb(
        "Remove jitter, spikes and gaps from recordings, and plant standing feet.",
        add_denoise_options,
        perform_denoise,
        prepare=learn_prior,
    ),
    "learn": Verb(
        "Learn filter bases from clean clips, once for many takes.",
        _learn_options,
        _learn,
        OutputKind.ONE_FILE,
    ),
    "quality": Verb(
        "Measure jitter, spikes, gaps and foot slide.",
        _quality_options,
        _quality,
        OutputKind.WORDS,
    ),
    "solve": Verb(
        "Solve the motion of a skeleton from the labeled markers of optical takes.",
        add_solve_options,
        perform_solve,
        writes_motions=True,
    ),
    "capture": Verb(
        "Track the actor of a depth recording: depth images become motion.",
        add_capture_options,
        perform_capture,
        writes_motions=True,
        writes_joints=True,
        list_recordings=depth_takes_in,
        prepare=read_body,
    ),
    "reconstruct": Verb(
        "Rebuild clean poses from the joints of a depth camera.",
        add_reconstruct_options,
        perform_reconstruct,
        writes_motions=True,
        writes_joints=True,
        prepare=read_guides,
    ),
    "learn-residuals": Verb(
        "Learn the errors of a depth camera from takes with a reference.",
        add_residuals_options,
        perform_residuals,
        OutputKind.ONE_FILE,
    ),
    "learn-postures": Verb(
        "Build a posture library from clean clips, for reconstruct.",
        add_postures_options,
        perform_postures,
        OutputKind.ONE_FILE,
    ),
    "simulate": Verb(
        "Track motions of a skeleton with a physical body on solid ground.",
        add_simulate_options,
        perform_simulate,
    ),
    "index": Verb(
        "Add recordings to a searchable library, and keep it up to date.",
        add_index_options,
        perform_index,
        OutputKind.LIBRARY,
    ),
    "find": Verb(
        "Find the segments of clips in a library that are similar to a recording.",
        add_find_options,
        perform_find,
        OutputKind.MATCHES,
    ),
    "vary": Verb(
        "Synthesize variants of a few clips of one behavior.",
        add_vary_options,
        perform_vary,
        OutputKind.MANY_FILES,
    ),
    "convert": Verb(
        "Write recordings of any known format as BVH, or points as C3D or TRC.",
        _convert_options,
        _convert,
    ),
    "retarget": Verb(
        "Retarget motions to another skeleton with other names, lengths and rest pose.",
        add_retarget_options,
        perform_retarget,
        prepare=read_target,
    ),
    "replay": Verb(
        "Send recordings to this machine as a live stream, like a depth camera's tracker.",
        add_replay_options,
        perform_replay,
        OutputKind.WORDS,
    ),
    "report": Verb(
        "Collect the records of a batch, from all machines, into one report.",
        _report_options,
        report_folder,
        OutputKind.REPORT,
    ),
    "unbake": Verb(
        "Replace a key on every frame with a few keys with handles.",
        add_unbake_options,
        perform_unbake,
    ),
}
"""A new verb is a new entry here."""
