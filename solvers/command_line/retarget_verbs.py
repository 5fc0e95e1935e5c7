"""`retarget` and `unbake`: transfer motions to another rig, and reduce keys."""

import argparse
from pathlib import Path
from typing import NamedTuple

from ..errors import InvalidMotionError
from ..motion import (
    HumanoidMap,
    Motion,
    Skeleton,
    describe_low_confidence,
    evidence_figures,
    explain_roles,
    find_humanoid_map,
    read_humanoid_map,
    write_humanoid_map,
)
from ..progress import Progress, within
from ..recordings.conventions import CENTIMETER
from ..retargeting import RetargetSettings, UnbakeSettings, reduce_keys, retarget
from .arguments import (
    Outcome,
    Task,
    VerbWork,
    add_preset_option,
    add_reading_options,
    arguments_from,
    read,
    settings_from_arguments,
    with_body,
    write,
)


class RetargetTarget(NamedTuple):
    """The target of all motions of a run."""

    skeleton: Skeleton
    humanoid: HumanoidMap


def add_retarget_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `retarget`."""
    parser.add_argument(
        "--to", type=Path, required=True, metavar="FILE",
        help="A recording of the target skeleton, in its rest pose",
    )  # fmt: skip
    for rig in ("source", "target"):
        parser.add_argument(
            f"--{rig}-map", type=Path, metavar="FILE",
            help=f"JSON file with the humanoid role of each joint of the {rig}"
            " [default: detected by names and shape]",
        )  # fmt: skip
    parser.add_argument(
        "--write-target-map", type=Path, metavar="FILE",
        help="Write the map of the target as JSON, to edit it and pass it with --target-map",
    )  # fmt: skip
    add_reading_options(parser)
    add_preset_option(parser, "retarget")
    arguments_from(parser, RetargetSettings)


def read_target(arguments: argparse.Namespace, progress: Progress) -> RetargetTarget:
    """Read the target skeleton for all motions of a run.

    Raises
    ------
    InvalidFileError
        A file is missing or damaged, or the map does not fit.
    InvalidMotionError
        The file has no skeleton.
    """
    recording = read(arguments.to, with_body(arguments, ""), progress)
    if not isinstance(recording, Motion):
        raise InvalidMotionError(f"{arguments.to} holds points without a skeleton.")
    target = RetargetTarget(recording.skeleton, _map(recording.skeleton, arguments.target_map))
    if arguments.write_target_map is not None:
        write_humanoid_map(target.humanoid, arguments.write_target_map)
    return target


def perform_retarget(task: Task, target: RetargetTarget, progress: Progress) -> Outcome:
    """Retarget one motion and write it."""
    motion = _read_motion(task, "retargeted", within(progress, 0.0, 0.3))
    source_map = _map(motion.skeleton, task.arguments.source_map)
    settings = settings_from_arguments(task.arguments, RetargetSettings)
    result = retarget(
        motion,
        source_map,
        target.skeleton,
        target.humanoid,
        settings=settings,
        progress=within(progress, 0.3, 0.7),
    )
    write(result, task.target, within(progress, 0.7, 1.0))
    shared = [role for role in source_map.joints if role in target.humanoid.joints]
    text = (
        f"{len(shared)} shared roles; confidence of the map of the source"
        f" {source_map.score:.0%}, of the target {target.humanoid.score:.0%}."
    )
    maps = {
        "source": (source_map, motion.skeleton),
        "target": (target.humanoid, target.skeleton),
    }
    explained = {side: explain_roles(skeleton, each) for side, (each, skeleton) in maps.items()}
    low = [describe_low_confidence(maps[side][0], each) for side, each in explained.items()]
    text = " ".join([text, *filter(None, low)])
    figures = {
        "n_frames": result.n_frames,
        "roles": shared,
        "evidence": {side: evidence_figures(each) for side, each in explained.items()},
        "source_score": source_map.score,
        "target_score": target.humanoid.score,
    }
    return Outcome(text, figures)


def add_tolerance_option(parser: argparse.ArgumentParser, joints: str) -> None:
    """Add `--tolerance`; `joints` describes the joints that keep it."""
    parser.add_argument(
        "--tolerance", type=float, default=1.0, metavar="CM",
        help=f"Maximum error of {joints} at any frame, in centimeters [default 1]",
    )  # fmt: skip


def add_unbake_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `unbake`."""
    add_tolerance_option(parser, "any joint")
    parser.add_argument(
        "--keys", action="store_true",
        help="Also write the keys and their handles as .npz, next to the motion",
    )  # fmt: skip
    add_reading_options(parser)
    arguments_from(parser, UnbakeSettings)


def perform_unbake(task: Task, prepared: None, progress: Progress) -> Outcome:
    """Reduce the keys of one motion and write the result."""
    motion = _read_motion(task, "unbaked", within(progress, 0.0, 0.2))
    sparse = reduce_keys(
        motion,
        CENTIMETER * task.arguments.tolerance,
        settings=settings_from_arguments(task.arguments, UnbakeSettings),
        progress=within(progress, 0.2, 0.8),
    )
    write(sparse.dense(), task.target, within(progress, 0.8, 1.0))
    if task.arguments.keys and task.target is not None:
        sparse.save(task.target.with_suffix(".npz"))
    moving = sum(len(curve.frames) > 0 for curve in sparse.rotations)
    before = motion.n_frames * (4 * moving + 3)
    text = (
        f"{sparse.n_keys} keys instead of {before} ({sparse.n_keys / before:.0%});"
        f" the maximum joint error is {100 * sparse.error:.2f} cm."
    )
    return Outcome(
        text, {"n_keys": sparse.n_keys, "n_keys_before": before, "error_m": sparse.error}
    )


def _map(skeleton: Skeleton, path: Path | None) -> HumanoidMap:
    return read_humanoid_map(path, skeleton) if path else find_humanoid_map(skeleton)


def _read_motion(task: Task, action: str, progress: Progress) -> Motion:
    recording = read(task.source, task.arguments, progress)
    if not isinstance(recording, Motion):
        raise InvalidMotionError(f"Points without a skeleton cannot be {action}.")
    return recording


RETARGET = VerbWork(add_retarget_options, perform_retarget, prepare=read_target)


UNBAKE = VerbWork(add_unbake_options, perform_unbake)
