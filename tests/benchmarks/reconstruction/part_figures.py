"""Figures 8 and 9 of [SHJT13], and table 5.2 and figure 5.7 of [ZH14], on UI-PRMD."""

from dataclasses import replace
from functools import cache
from pathlib import Path
from time import process_time
from unittest.mock import patch

import numpy as np
from PIL import Image

from solvers.arrays import Array
from solvers.motion.humanoid.body_size import estimate_bone_lengths
from solvers.motion.humanoid.bone_directions import rates_from_directions
from solvers.motion.humanoid.posture_heading import normalize_postures
from solvers.motion.humanoid.posture_joints import POSTURE_JOINTS, posture_positions
from solvers.pictures.canvas import FAINT, INK, Canvas, Color
from solvers.reconstruction import (
    PostureLibrary,
    ReliabilityMethod,
    ReliabilitySettings,
    ResidualMethod,
    ResidualPrior,
    learn_residual_prior,
    measure_reliability,
)
from solvers.reconstruction.joint_rotations.library_body import build_body_postures
from solvers.reconstruction.pose_library.neighbors import (
    PostureQuery,
    index_postures,
    nearest_postures,
)
from solvers.reconstruction.pose_space.posture_energy import EnergyTargets
from solvers.reconstruction.pose_space.posture_space import local_pca
from solvers.reconstruction.published import posture_search
from solvers.reconstruction.published.residual_reconstruction import (
    ThreeTermSettings,
    reconstruct_published_residuals,
)
from solvers.reconstruction.reliability import posture_reliability

from ..peers.posture_regression import Predict, random_forest
from ..shared.report import BENCHMARK_PICTURES, DOCS, show
from ..shared.tables import number, table
from .kinect_errors import compared
from .kinect_folds import PRIORS, SUBJECTS, observed_postures, pairs, truth_of
from .kinect_methods import learn_offsets, with_predicted_offsets
from .kinect_pairs import Pair
from .part_kinect import EXERCISES
from .part_postures import KINECT_EXERCISES, optical_clips

PUBLISHED = ReliabilitySettings(method=ReliabilityMethod.PUBLISHED, causal=True)
SEARCH = {"postures": 4000, "neighbors": 30, "dimensions": 20, "steps": 20, "samples": 100}
"""The settings of [SHJT13], table V; its database had 2,574 postures."""
SWEEPS = {
    "postures": (125, 250, 500, 1000, 2000, 4000),
    "neighbors": (5, 10, 20, 30, 60, 120),
    "dimensions": (5, 10, 15, 20, 29),
    "steps": (1, 5, 10, 20, 40),
    "samples": (10, 30, 100, 300),
}
"""Figures 8 a to e."""
STAGES = ("reliability", "neighbors", "posture space", "search")
N_LEARNED = 5
"""Takes of a motion by the same actor from which [ZH14] learns; the others are scored."""
CENTIMETERS = ThreeTermSettings()
METERS = ThreeTermSettings(temporal=0.2e-4, reliable=0.2e-4)
"""The weights of [ZH14], which gives no unit, per square centimeter and per square meter."""
SHOWN = {"m01_s02_e10": "leftHand", "m06_s04_e10": "rightFoot"}
"""Takes and joints of the picture: a deep squat, and a leg that is raised."""
COLORS: dict[str, Color] = {
    "Kinect": (40, 150, 60), "random forest (as Shen 2012)": (200, 60, 40),
    "[ZH14], in centimeters": (150, 150, 150), "[ZH14], in meters": (30, 80, 200),
}  # fmt: skip
"""Kinect green, Shen et al. red and the thesis blue, as there."""


def search_figures(n_repetitions: int) -> list[str]:
    """Return figure 8, the search by its settings, and figure 9, the time by its stages."""
    del n_repetitions
    rows, stages = {}, np.zeros(len(STAGES))
    for swept, values in SWEEPS.items():
        for value in values:
            energy, error, times = _searched(**(SEARCH | {swept: value}))
            label = f"{swept}: {value}" + (", as published" if value == SEARCH[swept] else "")
            rows[label] = [number(energy), f"{error:.2f}", number(float(times.sum()))]
            if value == SEARCH[swept]:
                stages += times / len(SWEEPS)
    head = "**Published search by its settings** ([SHJT13], figure 8)\n\n"
    header = ["setting", "energy, cm²", "vector from the parent, cm", "ms per frame"]
    sweep = table(header, rows)
    shares = {
        stage: [number(float(each)), f"{100.0 * each / stages.sum():.0f}"]
        for stage, each in zip(STAGES, stages, strict=True)
    }
    title = "\n**Time of the published method by stage** ([SHJT13], figure 9)\n\n"
    return [f"{head}{sweep}\n{title}{table(['stage', 'ms per frame', '%'], shares)}\n"]


def _searched(
    postures: int, neighbors: int, dimensions: int, steps: int, samples: int
) -> tuple[float, float, Array]:
    """Return the mean energy, cm², the error of eq. 18, cm, and ms per frame of each stage."""
    library, energies, times = _library(postures), [], np.zeros(len(STAGES))
    errors: list[Array] = []
    for pair in _search_takes():
        clock = _Clock(times)
        reliability = measure_reliability(pair.kinect, settings=PUBLISHED)
        weights = posture_reliability(pair.kinect, reliability.combined)
        clock.stage(0)
        plain = normalize_postures(posture_positions(pair.kinect), 30.0, weights)
        lengths = estimate_bone_lengths(plain.postures, weights)
        body = build_body_postures(library.directions, library.changes, lengths)
        index = index_postures(body, 0 * library.groups)
        clock.restart()
        speeds = rates_from_directions(plain.postures, 30.0)
        query = PostureQuery(plain.postures, speeds, weights, 0.0)
        indices, _ = nearest_postures(index, query, n_neighbors=neighbors)
        clock.stage(1)
        spaces = local_pca(body.positions[indices].astype(np.float64), dimensions)
        clock.stage(2)
        targets = EnergyTargets(plain.postures, weights, spaces.neighbors, lengths)
        with (
            patch.object(posture_search, "N_STEPS", steps),
            patch.object(posture_search, "N_SAMPLES", samples),
        ):
            made, found = posture_search.search_sequentially(spaces, targets)
        clock.stage(3)
        energies.append(found)
        errors.append(compared(plain.to_world(made), truth_of(pair))[1].ravel())
    energy, error = np.concatenate(energies), np.concatenate(errors)
    return 1e4 * float(energy.mean()), 100.0 * float(np.nanmean(error)), times / len(energy)


class _Clock:
    """Adds processor time to stages, in milliseconds."""

    def __init__(self, times: Array) -> None:
        self._times = times
        self.restart()

    def restart(self) -> None:
        self._began = process_time()

    def stage(self, index: int) -> None:
        self._times[index] += 1e3 * (process_time() - self._began)
        self.restart()


@cache
def _search_takes() -> list[Pair]:
    """Return half a minute of a Kinect, as in the paper."""
    names = tuple(
        f"{exercise}_s03_e0{take}" for exercise in KINECT_EXERCISES for take in (2, 4)
    )
    return [pair for pair in pairs() if pair.name in names]


@cache
def _library(size: int) -> PostureLibrary:
    """Return evenly chosen postures of other people."""
    library = optical_clips(False)[-1].library
    chosen = np.linspace(0, library.n_postures - 1, min(size, library.n_postures)).astype(int)
    twists = None if library.twists is None else library.twists[chosen]
    return replace(
        library, directions=library.directions[chosen], changes=library.changes[chosen],
        groups=library.groups[chosen], twists=twists,
    )  # fmt: skip


def motion_figures(n_repetitions: int) -> list[str]:
    """Return table 5.2, trained by motion and actor, and the picture of figure 5.7."""
    del n_repetitions
    methods = dict(zip(COLORS, (_raw, _forest, _in_centimeters, _in_meters), strict=True))
    errors: dict[str, dict[str, list[Array]]] = {name: {} for name in methods}
    curves: dict[str, dict[str, Array]] = {}
    for subject in SUBJECTS:
        for exercise, title in EXERCISES.items():
            takes = [one for one in pairs() if one.name.startswith(f"{exercise}_{subject}")]
            if len(takes) <= N_LEARNED or not takes[0].matched:
                continue
            for pair in takes[-2:]:
                for name, method in methods.items():
                    off = np.linalg.norm(method(pair, takes) - truth_of(pair), axis=-1)
                    errors[name].setdefault(title, []).append(off.ravel())
                    if joint := SHOWN.get(pair.name):
                        course = off[:, POSTURE_JOINTS.index(joint)]
                        curves.setdefault(f"{title}, {joint}", {})[name] = course
    rows = {
        name: [
            f"{100.0 * np.nanmean(np.concatenate(found)):.2f}"
            for found in (*each.values(), [one for part in each.values() for one in part])
        ]
        for name, each in errors.items()
    }
    head = (
        "**Trained by motion** (table 5.2 of [ZH14]): absolute error in cm; from five takes of"
        " the motion by the same actor to two others\n\n"
    )
    path = BENCHMARK_PICTURES / "reconstruction" / "error_course.png"
    _draw_curves(curves, path)
    picture = show(path, "Error of a joint over time", DOCS / "benchmarks" / "x.md")
    header = ["method", *errors["Kinect"], "all"]
    return [f"{head}{table(header, rows)}\n\n{picture}\n"]


def _raw(pair: Pair, takes: list[Pair]) -> Array:
    return observed_postures(pair)


def _in_centimeters(
    pair: Pair, takes: list[Pair], settings: ThreeTermSettings = CENTIMETERS
) -> Array:
    prior = _prior(tuple(takes[:N_LEARNED]))
    found = reconstruct_published_residuals(pair.kinect, prior, settings=settings)
    return posture_positions(found.tracks)


def _in_meters(pair: Pair, takes: list[Pair]) -> Array:
    return _in_centimeters(pair, takes, METERS)


@cache
def _prior(taught: tuple[Pair, ...]) -> ResidualPrior:
    examples = [(pair.kinect, pair.truth) for pair in taught]
    return learn_residual_prior(examples, settings=PRIORS[ResidualMethod.PUBLISHED])


def _forest(pair: Pair, takes: list[Pair]) -> Array:
    return with_predicted_offsets(_learned_forest(tuple(takes[:N_LEARNED])), pair)


@cache
def _learned_forest(taught: tuple[Pair, ...]) -> Predict:
    return learn_offsets(random_forest, taught)


def _draw_curves(curves: dict[str, dict[str, Array]], path: Path) -> None:
    """Draw the error of one joint by frame, a panel for each take."""
    width, height, left, top, gap = 900.0, 180.0, 60.0, 40.0, 60.0
    canvas = Canvas(left + width + 300.0, top + len(curves) * (height + gap))
    for panel, (title, lines) in enumerate(curves.items()):
        up = top + panel * (height + gap)
        highest = 100.0 * max(float(np.nanmax(line)) for line in lines.values())
        canvas.text(left, up - 14.0, title)
        for mark in np.arange(0.0, highest, max(1.0, round(highest / 5.0))):
            y = up + height * (1.0 - mark / highest)
            canvas.line([(left, y), (left + width, y)], FAINT)
            canvas.text(left - 8.0, y, f"{mark:.0f} cm", INK, "rm")
        for row, (name, line) in enumerate(lines.items()):
            across = left + width * np.arange(len(line)) / (len(line) - 1)
            down = up + height * (1.0 - 100.0 * line / highest)
            canvas.line(list(zip(across.tolist(), down.tolist(), strict=True)), COLORS[name], 2)
            canvas.text(left + width + 20.0, up + 20.0 * row + 10.0, name, COLORS[name], "lm")
    Image.fromarray(canvas.picture().pixels).save(path, optimize=True)
