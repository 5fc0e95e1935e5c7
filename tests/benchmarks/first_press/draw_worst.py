"""Draw the three worst takes of each condition, and of each measure, for eyes.

    make bench-first-press ARGUMENTS="--development --pictures"   # build/first_press/pictures
    make bench-first-press ARGUMENTS=--pictures                   # docs/pictures/benchmarks

A picture shows the body around the worst moment, and the joint that is worst there: the truth,
what was recorded, ours, and the peer that is nearest to the truth on this take.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np
from PIL import Image

from solvers.arrays import Array
from solvers.motion import Motion, Skeleton, find_humanoid_map
from solvers.pictures import (
    SERIES,
    Canvas,
    Picture,
    StickFigureSettings,
    ViewDirection,
    draw_stick_figures,
    stack_pictures,
)
from solvers.pictures.canvas import FAINT, GRID, INK, SHADE
from solvers.pictures.curves import ticks
from solvers.rotations import (
    inverse,
    mean_rotation,
    multiply,
    rotation_vector_from_quaternion,
    unwrap_rotation_vectors,
)

from ..shared.noise import angle_error
from .conditions import CONDITIONS, Case, Condition
from .filters import METHODS, OURS
from .measures import ENDS, Figures, positions_of_ends
from .takes import Take

N_WORST = 3
MEASURES = {"position": "distance", "speed_kept": "speed", "excursion_loss": "reach"}
"""The figures besides the angle error, and the names of their pictures."""
AROUND_S, FIGURES_S = 1.0, 0.2
"""Seconds before and after the worst moment that the curves and the figures show."""
FIGURES = StickFigureSettings(n_figures=7, height=110, view=ViewDirection.QUARTER)
WIDTH, HEIGHT, LEFT, TOP, BOTTOM, RIGHT = 780.0, 190.0, 60.0, 34.0, 30.0, 200.0
RECORDED = (205, 205, 205)
N_COLORS = 48
"""Colors of a picture: enough for thin lines, and a third of the size."""


class Ranked(Protocol):
    """The part of the scores that is needed: figures by method, condition and take."""

    figures: Mapping[str, Mapping[str, Mapping[str, Figures]]]

    def best_peer(self, condition: str, take: str) -> str | None:
        """Return the peer that is nearest to the truth."""


@dataclass(frozen=True)
class Moment:
    """Where a take is worst."""

    joint: int
    frame: int


def draw_worst(scores: Ranked, takes: Sequence[Take], folder: Path) -> list[Path]:
    """Write a picture for each condition and measure, and return their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    by_name = {str(take): take for take in takes}
    written = []
    for name, cases in _chosen(scores, by_name).items():
        pictures = [_draw(*each) for each in cases]
        if pictures:
            written.append(folder / f"worst_{name}.png")
            pixels = stack_pictures(pictures).pixels
            Image.fromarray(pixels).quantize(N_COLORS).save(written[-1], optimize=True)
    return written


def _chosen(
    scores: Ranked, takes: Mapping[str, Take]
) -> dict[str, list[tuple[Case, str, str]]]:
    """Return the worst cases by name of the picture, each with a measure and the best peer."""
    chosen = {}
    for condition in CONDITIONS:
        ranked = sorted(_excess(scores, condition), reverse=True)[:N_WORST]
        name = "".join(letter for letter in str(condition) if letter.isalnum() or letter == " ")
        chosen["_".join(name.split())] = [
            (Case(takes[take], condition), "angle", peer)
            for excess, take, peer in ranked
            if excess > 0.0
        ]
    for measure, name in MEASURES.items():
        sign = -1.0 if measure == "speed_kept" else 1.0
        ranked_cases = sorted(
            (sign * getattr(figures, measure), take, index)
            for index, condition in enumerate(CONDITIONS)
            for take, figures in scores.figures[OURS][str(condition)].items()
        )[::-1][:N_WORST]
        chosen[name] = [
            (Case(takes[take], CONDITIONS[index]), measure, peer)
            for _, take, index in ranked_cases
            if (peer := scores.best_peer(str(CONDITIONS[index]), take))
        ]
    return chosen


def _excess(scores: Ranked, condition: Condition) -> Iterator[tuple[float, str, str]]:
    """Yield by how many degrees ours is worse than the best peer, the take and the peer."""
    for take, ours in scores.figures[OURS][str(condition)].items():
        peer = scores.best_peer(str(condition), take)
        if peer is not None:
            best = scores.figures[peer][str(condition)][take]
            yield ours.angle - best.angle, take, peer


def _draw(case: Case, measure: str, peer: str) -> Picture:
    motions = {"truth": case.truth, peer: METHODS[peer](case).motion}
    motions[OURS] = METHODS[OURS](case).motion
    moment = find_moment(case, measure, motions[OURS], motions[peer])
    around = _frames_around(case.truth, moment.frame, FIGURES_S)
    figures = draw_stick_figures(motions, FIGURES, frames=around)
    return stack_pictures([_draw_curves(case, measure, motions, moment), figures])


def find_moment(case: Case, measure: str, ours: Motion, peer: Motion) -> Moment:
    """Return the joint and frame where ours is worst by this measure.

    By the angle it is where the peer is nearer to the truth by most. By the others it is
    at the hand or foot in question, and the joint above it that is off by most there.
    """
    joints = np.flatnonzero(case.channels.joints)
    error = angle_error(ours, case.truth, joints)
    if measure == "angle":
        excess = error - angle_error(peer, case.truth, joints)
        frame, column = np.unravel_index(int(excess.argmax()), excess.shape)
        return Moment(int(joints[column]), int(frame))
    end, frame = _worst_end(case, measure, ours)
    above = _ancestors(case.truth.skeleton, ENDS[end])
    errors = np.where(np.isin(joints, above), error[frame], -1.0)
    return Moment(int(joints[errors.argmax()]), frame)


def _worst_end(case: Case, measure: str, ours: Motion) -> tuple[int, int]:
    """Return the index of a hand or foot, and a frame."""
    truth, cleaned = positions_of_ends(case.truth), positions_of_ends(ours)
    if measure == "speed_kept":
        true_speed, speed = (
            np.linalg.norm(np.diff(each, axis=0), axis=-1) for each in (truth, cleaned)
        )
        end = int((speed.max(axis=0) / np.maximum(true_speed.max(axis=0), 1e-9)).argmin())
        return end, int(true_speed[:, end].argmax())
    if measure == "excursion_loss":
        about_root = (cleaned - truth) - (ours.root_positions - case.truth.root_positions)[
            :, None
        ]
        distance = np.linalg.norm(about_root, axis=-1)
    else:
        distance = np.linalg.norm(cleaned - truth, axis=-1)
    frame, end = np.unravel_index(int(distance.argmax()), distance.shape)
    return int(end), int(frame)


def _ancestors(skeleton: Skeleton, role: str) -> list[int]:
    """Return the joints that move a hand or foot, itself left out."""
    joint = skeleton.parents[skeleton.index(find_humanoid_map(skeleton).joints[role])]
    found = []
    while joint >= 0:
        found.append(joint)
        joint = skeleton.parents[joint]
    return found


def _frames_around(motion: Motion, frame: int, seconds: float) -> range:
    half = max(round(seconds * motion.frame_rate), 3)
    return range(max(frame - half, 0), min(frame + half + 1, motion.n_frames))


def _draw_curves(
    case: Case, measure: str, motions: Mapping[str, Motion], moment: Moment
) -> Picture:
    """Draw the component of the joint's rotation vector that is off by most there."""
    frames = _frames_around(case.truth, moment.frame, AROUND_S)
    curves = _component({"recorded": case.recording, **motions}, moment)
    shown = {name: curve[frames.start : frames.stop] for name, curve in curves.items()}
    finite = np.concatenate([each[np.isfinite(each)] for each in shown.values()])
    low, high = float(finite.min()) - 1.0, float(finite.max()) + 1.0
    canvas = Canvas(WIDTH, HEIGHT)
    name = case.truth.skeleton.names[moment.joint]
    what = "angle" if measure == "angle" else MEASURES[measure]
    title = f"{case.take}, {case.condition}: {name} at frame {moment.frame} (worst {what})"
    canvas.text(12.0, 14.0, title)

    def x(frame: float) -> float:
        return LEFT + (WIDTH - LEFT - RIGHT) * (frame - frames.start) / max(len(frames) - 1, 1)

    def y(degrees: Array | float) -> Array:
        span = HEIGHT - TOP - BOTTOM
        return np.asarray(HEIGHT - BOTTOM - span * (degrees - low) / (high - low))

    for missing in np.flatnonzero(np.isnan(shown["recorded"])) + frames.start:
        canvas.box(
            x(max(missing - 0.5, frames.start)), TOP,
            x(min(missing + 0.5, frames.stop - 1)), HEIGHT - BOTTOM, SHADE,
        )  # fmt: skip
    for level in ticks(low, high, 4):
        canvas.line([(LEFT, y(level)), (WIDTH - RIGHT, y(level))], GRID)
        canvas.text(LEFT - 6.0, float(y(level)), f"{level:g}°", INK, "rm")
    canvas.line([(x(moment.frame), TOP), (x(moment.frame), HEIGHT - BOTTOM)], FAINT)
    for frame in ticks(frames.start, frames.stop - 1, 8):
        canvas.text(x(frame), HEIGHT - 14.0, f"{frame:g}", INK, "mm")
    colors = (RECORDED, *SERIES)
    for row, ((label, curve), color) in enumerate(zip(shown.items(), colors, strict=False)):
        points = [(x(frame), y(value)) for frame, value in zip(frames, curve, strict=True)]
        canvas.line(points, color, 1.8)
        canvas.text(WIDTH - RIGHT + 44.0, TOP + 10.0 + 20.0 * row, label)
        level = TOP + 10.0 + 20.0 * row
        canvas.line([(WIDTH - RIGHT + 14.0, level), (WIDTH - RIGHT + 36.0, level)], color, 3.0)
    return canvas.picture()


def _component(motions: Mapping[str, Motion], moment: Moment) -> dict[str, Array]:
    """Return the same component of the joint in all motions, degrees about the true mean."""
    truth = motions["truth"].rotations[:, moment.joint]
    from_mean = inverse(mean_rotation(truth))
    vectors = {
        name: rotation_vector_from_quaternion(
            multiply(from_mean, motion.rotations[:, moment.joint])
        )
        for name, motion in motions.items()
    }
    true_vectors = unwrap_rotation_vectors(vectors["truth"][:, None])[:, 0]
    vectors = {name: nearest_turn(each, true_vectors) for name, each in vectors.items()}
    off = np.abs(vectors[OURS] - true_vectors)[moment.frame]
    return {name: np.degrees(each[:, int(off.argmax())]) for name, each in vectors.items()}


def nearest_turn(vectors: Array, like: Array) -> Array:
    """Return rotation vectors, radians, with full turns added until they are near others."""
    angles = np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-12)
    axes = vectors / angles
    n_turns = np.round(((like * axes).sum(axis=1, keepdims=True) - angles) / (2.0 * np.pi))
    return np.asarray(vectors + 2.0 * np.pi * n_turns * axes)
