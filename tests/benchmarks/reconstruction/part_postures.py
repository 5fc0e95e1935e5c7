"""Postures completed from a library: parts used, energies, and missing joints."""

from collections.abc import Callable, Iterator
from functools import cache, partial
from time import perf_counter
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator

from solvers.arrays import Array, Flags
from solvers.motion import SENSOR_JOINTS, JointRecording, Motion, Sensor, Tracks
from solvers.motion.humanoid.body_size import estimate_bone_lengths, segment_lengths
from solvers.motion.humanoid.bone_directions import PARENT_INDICES, rates_from_directions
from solvers.motion.humanoid.posture_heading import normalize_postures
from solvers.motion.humanoid.posture_joints import (
    N_JOINTS,
    posture_positions,
    postures_from_motion,
)
from solvers.reconstruction.joint_rotations.library_body import build_body_postures
from solvers.reconstruction.pose_completion.reconstruct_postures import reconstruct_postures
from solvers.reconstruction.pose_completion.settings import DEFAULT_SETTINGS, PostureSettings
from solvers.reconstruction.pose_library.neighbors import (
    PostureQuery,
    index_postures,
    nearest_postures,
)
from solvers.reconstruction.pose_library.posture_library import (
    PostureLibrary,
    build_posture_library,
)
from solvers.reconstruction.pose_space.posture_energy import EnergyTargets
from solvers.reconstruction.pose_space.posture_space import local_pca
from solvers.reconstruction.published.posture_search import search_sequentially
from solvers.reconstruction.reliability.scores import Reliability
from solvers.recordings import read_recording
from tests.benchmarks.reconstruction.posture_synthesis import solve_sequentially

from ..shared import clips
from ..shared.tables import Scores

Method = Callable[[Array, Flags, PostureLibrary], Array]
"""Estimates from true postures, the mask of missing joints, and a library."""

RATE = clips.FRAME_RATE
KINECT_EXERCISES = ("m01", "m03", "m06", "m08")
ARM, LEG, OTHER_LEG = (4, 5, 6, 7), (12, 13, 14, 15), (16, 17, 18, 19)
MISSING_JOINTS: dict[str, int | tuple[int, ...]] = {
    "1": 1, "2": 2, "4": 4, "8": 8, "arm": ARM, "leg": LEG, "legs": LEG + OTHER_LEG,
}  # fmt: skip
SECONDS = (0.25, 0.5, 1.0, 2.0)
MIN_OBSERVED_FRAMES = 4
"""Frames before and after a loss."""
PARTS = {
    "left hand, left foot": (6, 14),
    "hands": (6, 10),
    "hands, feet": (6, 10, 14, 18),
    "hands, feet, elbows, knees": (6, 10, 14, 18, 5, 9, 13, 17),
    "all": tuple(range(N_JOINTS)),
}
"""Of [SHJT13], table III; the hips are always used: poses are relative to them."""


class Clip(NamedTuple):
    """Postures in the world, and a library without that person."""

    name: str
    postures: Array
    library: PostureLibrary


@cache
def optical_clips(dev: bool) -> tuple[Clip, ...]:
    """Walks and HDM05 clips, with libraries of other persons."""
    walks = {
        name: walk
        for name, walk in clips.walks().items()
        if name.split("_")[0] in clips.DEV_SUBJECTS
    }
    teachers = ("bk",) if dev else tuple(clips.DEV_ACTORS)
    acted = [(name, clips.hdm05(name)) for name in clips.hdm05_classes()]
    examples = [clip for _, found in acted for clip in _of(found, teachers)]
    chosen = clips.development(False) if dev else clips.scored(False)
    result = []
    for name in chosen:
        others = [walk for key, walk in walks.items() if key[:2] != name[:2]]
        library = _library(tuple(others + examples))
        result.append(Clip(name, postures_from_motion(clips.walks()[name]), library))
    library = _library((*walks.values(), *examples))
    for motion_class, found in acted:
        for actor in ("bd",) if dev else ("bk", "dg"):
            motion = _of(found, (actor,))[0]
            result.append(
                Clip(f"{motion_class} {actor}", postures_from_motion(motion), library)
            )
    return tuple(result)


@cache
def _library(motions: tuple[Motion, ...]) -> PostureLibrary:
    return build_posture_library(motions)


def _of(found: dict[str, Motion], actors: tuple[str, ...]) -> list[Motion]:
    return [motion for key, motion in found.items() if key.split("_")[0] in actors]


@cache
def kinect_clips(dev: bool) -> tuple[Clip, ...]:
    """Takes of UI-PRMD, of one subject for development and of another for scoring."""
    folder = clips.DATA / "kinect" / "ui_prmd"
    subject = "s01" if dev else "s03"
    return tuple(
        Clip(path.stem, posture_positions(read_recording(path)), optical_clips(dev)[-1].library)
        for exercise in KINECT_EXERCISES
        for path in sorted(folder.glob(f"{exercise}_{subject}_e0[24].npz"))
    )


def ours(
    postures: Array,
    missing: Flags,
    library: PostureLibrary,
    settings: PostureSettings = DEFAULT_SETTINGS,
) -> Array:
    """Reconstruct as the verb does, with full reliability of all observed joints."""
    observed = np.where(missing[..., None], np.nan, postures)
    reliability = np.isfinite(observed).all(axis=-1).astype(float)
    recording = JointRecording(
        Tracks(SENSOR_JOINTS[Sensor.KINECT_V1], observed, RATE), None, Sensor.KINECT_V1
    )
    return reconstruct_postures(
        recording,
        library,
        settings=settings,
        reliability=Reliability(reliability, reliability, reliability, reliability),
    ).tracks.positions


def interpolated(
    kind: str, in_body: bool, postures: Array, missing: Flags, library: PostureLibrary
) -> Array:
    """Bridge each loss by a curve, in the world or relative to hips and heading."""
    if in_body:
        observed = np.where(missing[..., None], np.nan, postures)
        plain = normalize_postures(observed, RATE, 1.0 - missing)
        return plain.to_world(interpolated(kind, False, plain.postures, missing, library))
    result, frames = postures.copy(), np.arange(len(postures))
    for joint in np.flatnonzero(missing.any(axis=0)):
        gone = missing[:, joint]
        x, y = frames[~gone], postures[~gone, joint]
        if kind == "hold":
            result[gone, joint] = y[np.searchsorted(x, frames[gone]) - 1]
        elif kind == "linear":
            for axis in range(3):
                result[gone, joint, axis] = np.interp(frames[gone], x, y[:, axis])
        else:
            curve = {"PCHIP": PchipInterpolator, "cubic": CubicSpline}[kind]
            result[gone, joint] = curve(x, y)(frames[gone])
    return result


def from_neighbors(
    project: bool, postures: Array, missing: Flags, library: PostureLibrary
) -> Array:
    """Take missing joints from the mean of 30 neighbors, or from 20 components of all."""
    observed = np.where(missing[..., None], np.nan, postures)
    plain = normalize_postures(observed, RATE, 1.0 - missing)
    body = build_body_postures(
        library.directions, library.changes, estimate_bone_lengths(observed)
    )
    if project:
        candidates = np.broadcast_to(body.positions, (1, *body.positions.shape))
        space = local_pca(candidates[:, :: max(library.n_postures // 800, 1)])
        made = _projected(space.means[0], space.axes[0], plain.postures)
    else:
        query = PostureQuery(plain.postures, 0.0 * plain.postures, 1.0 - missing, 0.0)
        indices, _ = nearest_postures(index_postures(body, 0 * library.groups), query)
        made = body.positions[indices].mean(axis=1).astype(np.float64)
    return np.where(missing[..., None], plain.to_world(made), postures)


def _projected(mean: Array, axes: Array, postures: Array) -> Array:
    """Least squares on the observed joints."""
    result = np.empty_like(postures)
    for frame, flat in enumerate(postures.reshape(len(postures), -1)):
        observed = np.isfinite(flat)
        z = np.linalg.lstsq(axes[observed], (flat - mean)[observed], rcond=1e-3)[0]
        result[frame] = (mean + axes @ z).reshape(N_JOINTS, 3)
    return result


METHODS: dict[str, Method] = {
    "ours": ours,
    "ours, causal": partial(ours, settings=PostureSettings(causal=True)),
    "linear": partial(interpolated, "linear", False),
    "PCHIP": partial(interpolated, "PCHIP", False),
    "cubic": partial(interpolated, "cubic", False),
    "PCHIP in the body's frame": partial(interpolated, "PCHIP", True),
    "cubic in the body's frame": partial(interpolated, "cubic", True),
    "hold": partial(interpolated, "hold", False),
    "PCA projection": partial(from_neighbors, True),
    "kNN mean": partial(from_neighbors, False),
}


def missing_joints(title: str, found: tuple[Clip, ...]) -> tuple[Scores, Scores]:
    """Error of missing joints by number and duration."""
    by_joints, by_seconds = (
        Scores(f"Missing joints, {title}, by {by}", "mm on the missing joints")
        for by in ("joints", "seconds")
    )
    for number, clip in enumerate(found):
        for what, seconds, missing in _losses(clip.postures, np.random.default_rng(number)):
            for name, method in METHODS.items():
                made = method(clip.postures, missing, clip.library)
                error = 1e3 * np.linalg.norm(made - clip.postures, axis=-1)[missing].mean()
                case = f"{clip.name} {what} {seconds}"
                by_joints.add(name, what, case, float(error))
                by_seconds.add(name, f"{seconds} s", case, float(error))
    for scores in (by_joints, by_seconds):
        scores.add_overall()
    return by_joints, by_seconds


def _losses(postures: Array, random: np.random.Generator) -> Iterator[tuple[str, float, Flags]]:
    observed = np.flatnonzero(np.isfinite(postures).all(axis=(0, 2)))
    for seconds in SECONDS:
        n = round(seconds * RATE)
        if n + 2 * MIN_OBSERVED_FRAMES >= len(postures):
            continue
        for what, which in MISSING_JOINTS.items():
            start = random.integers(
                MIN_OBSERVED_FRAMES, len(postures) - n - MIN_OBSERVED_FRAMES
            )
            joints = (
                random.choice(observed, which, replace=False)
                if isinstance(which, int)
                else which
            )
            missing = np.zeros(postures.shape[:2], bool)
            missing[start : start + n, np.intersect1d(joints, observed)] = True
            yield what, seconds, missing


def parts_used(title: str, found: tuple[Clip, ...]) -> Scores:
    """Table III of [SHJT13]: all joints from some, by the difference of eq. 18.

    Only the first frame shows all, and so the lengths of bones.
    """
    scores = Scores(f"Parts used, {title}", "cm, eq. 18")
    for clip in found:
        for column, parts in PARTS.items():
            missing = np.ones(clip.postures.shape[:2], bool)
            missing[:, [0, *parts]] = False
            missing[0] = False
            methods = {"ours": ours, "kNN mean": partial(from_neighbors, False)}
            for name, method in methods.items():
                made = method(clip.postures, missing, clip.library)
                off = (made - made[:, PARENT_INDICES]) - (
                    clip.postures - clip.postures[:, PARENT_INDICES]
                )
                figure = 100.0 * np.nanmean(np.linalg.norm(off, axis=-1)[:, 1:])
                scores.add(name, column, clip.name, float(figure))
    return scores


def energies(found: tuple[Clip, ...]) -> Scores:
    """Energy and time of the published search and of Gauss-Newton, in the same spaces."""
    scores = Scores(
        "Least energy, frame after frame", "energy in cm², time in ms", "Gauss-Newton"
    )
    solvers = {"Gauss-Newton": solve_sequentially, "published search": search_sequentially}
    for number, clip in enumerate(found):
        missing = np.zeros(clip.postures.shape[:2], bool)
        limb = (ARM, LEG, OTHER_LEG)[number % 3]
        missing[len(missing) // 3 : 2 * len(missing) // 3, limb] = True
        plain = normalize_postures(clip.postures, RATE, 1.0 - missing)
        lengths = np.nanmedian(segment_lengths(plain.postures), axis=0)
        library = clip.library
        body = build_body_postures(library.directions, library.changes, lengths)
        query = PostureQuery(
            plain.postures, rates_from_directions(plain.postures, RATE), 1.0 - missing, 0.0
        )
        indices, _ = nearest_postures(index_postures(body, library.groups), query)
        spaces = local_pca(body.positions[indices].astype(np.float64))
        targets = EnergyTargets(plain.postures, 1.0 - missing, spaces.neighbors, lengths)
        for name, solve in solvers.items():
            started = perf_counter()
            _, solve_energies = solve(spaces, targets)
            taken = 1e3 * (perf_counter() - started) / len(missing)
            scores.add(name, "energy", clip.name, 1e4 * float(solve_energies.mean()))
            scores.add(name, "ms per frame", clip.name, taken, follows=False)
    return scores
