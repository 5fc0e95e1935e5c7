"""The depth tracker against true joints: terms, peers, wrong bodies, noise, resolution.

make bench-depth                    # some five minutes
make bench-depth ARGUMENTS=--docs   # into docs/benchmarks/depth.md
"""

import argparse
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from time import perf_counter, process_time

import numpy as np

from solvers.depth_tracking.body.model import BodyModel
from solvers.depth_tracking.body.tables import JOINTS
from solvers.depth_tracking.capturing.refine_body import refine_body
from solvers.depth_tracking.published.edge_tracker import track_pose_by_edges
from solvers.depth_tracking.published.registration_tracker import REGISTRATION_TRACKER
from solvers.depth_tracking.terms.tracker_settings import DEFAULT_TRACKER, TrackerSettings
from solvers.depth_tracking.tracking.track_pose import track_pose

from ..peers.icp_trackers import articulated_icp, ray_constrained_icp
from ..shared.report import BENCHMARK_PICTURES, DOCS, Report, show
from ..shared.tables import Scores
from .cameras.part_cameras import cameras
from .colored_sequences import colored, others_motions
from .depth_extra_sequences import more_sequence
from .depth_sequences import (
    SCORED,
    TRUTH,
    Errors,
    Sequence,
    errors,
    length_error,
    noisier,
    sequence,
)
from .depth_takes import SUBJECTS
from .depth_tuning import TAKES as TUNED_ON
from .depth_tuning import tuning_sequence
from .part_depth_capture import FPS, capture_modes, captures, more, more_capture_modes
from .part_depth_kinect import kinect
from .part_depth_memory import LENGTHS, memory
from .part_depth_recorded import recorded
from .part_depth_renderers import renderers
from .part_detector import detector
from .part_failures import failures
from .part_retracking import retracking
from .people.part_people import people
from .plot_bars import draw_bars
from .published.part_edges import components, real_takes
from .published.part_registration import ablation, calibration, robustness

Track = Callable[[Sequence, BodyModel], np.ndarray]
UNIT = "each sequence counts as one clip"
HARD = ("walk_side", "walk_diagonal")
"""Sequences with occlusions, on which parts are left out."""
HARDER = (
    "run in a circle", "kick, side", "throw", "crossed arms, side", "seated, side",
)  # fmt: skip
"""Of `depth_more`, the same, without the walk that rotates: every tracker fails on it."""
MIN_BAR_PERCENT = 50.0
"""Per cent at which the bars of a picture begin."""
WITHOUT = {
    "all terms (default)": {},
    "no depth image": {"depth_weight": 0.0},
    "no extra depth": {"extra_weight": 0.0},
    "no silhouette": {"silhouette_weight": 0.0},
    "no closest surface": {"closest_weight": 0.0},
    "no free space (off actor, too near)": {"off_actor_weight": 0.0, "too_near_weight": 0.0},
    "no prediction": {"prediction": 0.0},
    "no smoothness": {"rotation_weight": 0.0, "shift_weight": 0.0},
    "no natural stance": {"natural_weight": 0.0},
    "no joint limits": {"limit_weight": 0.0},
    "no occlusion handling": {"limit": 1.0},
    "not robust": {"robust_scale": 10.0},
    "every step accepted": {"accept_only_better": False},
    "no coarse steps": {"coarse_iterations": 0, "iterations": 4},
}


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--docs", action="store_true", help="write docs/benchmarks/depth.md")
    parser.add_argument("--only", help="parts, with commas between")
    parser.add_argument(
        "--subjects", type=int, nargs="+", default=SUBJECTS, help="of the Kinect"
    )
    parser.add_argument("--frames", type=int, nargs="+", default=LENGTHS, help="of long takes")
    chosen = parser.parse_args()
    if not TRUTH.exists():
        raise SystemExit(f"There are no recordings in {TRUTH}.")
    report = Report(chosen.docs, DOCS / "benchmarks" / "depth.md")
    parts = {
        "trackers": trackers, "captures": captures, "more": more, "modes": capture_modes,
        "more-modes": more_capture_modes,
        "terms": terms, "bodies": bodies, "noise": noise, "resolution": resolution,
        "kinect": partial(kinect, chosen.subjects), "renderers": renderers,
        "memory": partial(memory, chosen.frames), "detector": detector,
        "failures": failures, "recorded": recorded, "retracking": retracking,
        "tuning": tuning, "robustness": robustness, "calibration": calibration,
        "ablation": lambda: ablation(_hard_sequences()),
        "components": components, "cameras": cameras, "people": people,
        "real-edges": real_takes,
    }  # fmt: skip
    for name, part in parts.items():
        if chosen.only and name not in chosen.only.split(","):
            continue
        started = perf_counter()
        texts = part()
        report.part(name, texts, perf_counter() - started)


def ours(settings: TrackerSettings, one: Sequence, body: BodyModel) -> np.ndarray:
    """Return joints as our tracker finds them."""
    tracked = track_pose(one.depth, body, one.first_pose(body), settings=settings)
    return tracked.joints.positions


def peer(track: Callable[..., np.ndarray], one: Sequence, body: BodyModel) -> np.ndarray:
    """Return joints as a peer finds them."""
    return track(one.depth, body, one.first_pose(body))


def edge_tracked(one: Sequence, body: BodyModel) -> np.ndarray:
    """Return joints as [LOU12] finds them, with painted bodies and motions of other actors."""
    painted = colored(one.name)
    tracked = track_pose_by_edges(painted.depth, body, one.first_pose(body), others_motions())
    return tracked.joints.positions


def edge_tracked_from_depth(one: Sequence, body: BodyModel) -> np.ndarray:
    """Return joints as [LOU12] finds them from depth alone."""
    return track_pose_by_edges(one.depth, body, one.first_pose(body)).joints.positions


def measured(track: Track, one: Sequence, body: BodyModel) -> tuple[Errors, float]:
    """Return errors, and frames per second of this process's time."""
    started = process_time()
    with np.errstate(all="ignore"):
        joints = track(one, body)
    return errors(joints, one.joints), one.depth.n_frames / (process_time() - started)


def trackers() -> list[str]:
    """Compare trackers, started from the true first pose, bodies of the true lengths."""
    methods: dict[str, Track] = {
        "ours (default)": partial(ours, DEFAULT_TRACKER),
        "WZC12 preset": partial(ours, REGISTRATION_TRACKER),
        "WZC12 terms, damped, with limits": partial(ours, DAMPED_REGISTRATION),
        "LOU12 preset, color and clips": edge_tracked,
        "LOU12 preset, no color, no clips": edge_tracked_from_depth,
        "articulated ICP": partial(peer, articulated_icp),
        "ray-constrained ICP": partial(peer, ray_constrained_icp),
    }
    scores = Scores("Trackers from the true first pose", UNIT, "")
    by_sequence = Scores("Ours, by sequence", "one each", "")
    by_joint = Scores("Ours, by joint, cm after offset", UNIT, "")
    for name in SCORED:
        one = sequence(name)
        colored(name), others_motions()
        for method, track in methods.items():
            found, speed = measured(track, one, one.body)
            for column, figure in (found.figures() | {FPS: speed}).items():
                scores.add(method, column, name, figure)
                if method == "ours (default)":
                    by_sequence.add(name, column, name, figure)
            if method == "ours (default)":
                for joint, figure in zip(JOINTS, found.offset_taken.mean(axis=0), strict=True):
                    by_joint.add(joint, "cm", name, 100.0 * figure)
                    near = found.offset_taken[:, JOINTS.index(joint)] < 0.1
                    by_joint.add(joint, "% < 10 cm", name, 100.0 * near.mean())
    return [scores.markdown(), _single(by_sequence), by_joint.markdown()]


DAMPED_REGISTRATION = replace(
    DEFAULT_TRACKER, closest_weight=0.0, off_actor_weight=0.0, too_near_weight=0.0,
    depth_weight=1000.0, extra_weight=10000.0, silhouette_weight=0.1,
)  # fmt: skip


def terms() -> list[str]:
    """Leave each term or safeguard out, from the true first pose."""
    scores = _without(_hard_sequences(), "Without each part")
    picture = BENCHMARK_PICTURES / "depth" / "terms.png"
    draw_bars(scores, {"cm": 0.0, "% < 10 cm": MIN_BAR_PERCENT}, picture)
    return [scores.markdown(), f"{show(picture, 'What each part is worth')}\n"]


def _hard_sequences() -> list[Sequence]:
    return [sequence(name) for name in HARD] + [more_sequence(name) for name in HARDER]


def tuning() -> list[str]:
    """Leave each term or safeguard out, on the sequences by which defaults are chosen."""
    sequences = [tuning_sequence(name) for name in TUNED_ON]
    return [_without(sequences, "Without each part, sequences for tuning").markdown()]


def _without(sequences: list[Sequence], title: str) -> Scores:
    scores = Scores(title, f"{len(sequences)} sequences as clips", "")
    for label, changes in WITHOUT.items():
        settings = replace(DEFAULT_TRACKER, **changes)
        for one in sequences:
            found, speed = measured(partial(ours, settings), one, one.body)
            for column, figure in (found.figures() | {FPS: speed}).items():
                scores.add(label, column, one.name, figure)
    return scores


def bodies() -> list[str]:
    """Track with wrong radii, with the mean body, and with bodies refined from tracking."""
    scores = Scores("Bodies", UNIT, "")
    for name in HARD:
        one = sequence(name)
        true = one.body
        cases = {
            "true lengths, mean radii": true,
            "radii 15 % thinner": BodyModel(true.lengths, 0.85 * true.radii),
            "radii 15 % thicker": BodyModel(true.lengths, 1.15 * true.radii),
            "mean body": one.typical_body,
            "mean body 5 % too tall": one.typical_body.scaled(1.05),
        }
        for label in ("mean body", "mean body 5 % too tall"):
            cases[f"{label}, refined"] = _refined(one, cases[label])
        for label, body in cases.items():
            found, _ = measured(partial(ours, DEFAULT_TRACKER), one, body)
            figures = found.figures() | {"% off in length": length_error(body, true)}
            for column, figure in figures.items():
                scores.add(label, column, name, figure)
    return [scores.markdown()]


def _refined(one: Sequence, body: BodyModel) -> BodyModel:
    for _ in range(2):
        tracked = track_pose(one.depth, body, one.first_pose(body))
        body = refine_body(one.depth, body, tracked.poses)
    return body


def noise() -> list[str]:
    """Add noise to the walk that has none."""
    scores = Scores("Noise on walk_front_clean, at 3 m", "one walk", "")
    cases = [sequence("walk_front_clean"), sequence("walk_front")]
    cases += [noisier(cases[0], sigma) for sigma in (0.01, 0.02, 0.04, 0.08)]
    for one in cases:
        found, _ = measured(partial(ours, DEFAULT_TRACKER), one, one.body)
        for column, figure in found.figures().items():
            scores.add(one.name, column, one.name, figure)
    return [_single(scores)]


def resolution() -> list[str]:
    """Look at fewer or more columns."""
    scores = Scores("Selected columns", UNIT, "")
    for width in (80, 160, 320):
        settings = replace(DEFAULT_TRACKER, image_width=width)
        for name in HARD:
            one = sequence(name)
            found, speed = measured(partial(ours, settings), one, one.body)
            for column, figure in (found.figures() | {FPS: speed}).items():
                scores.add(f"{width} columns", column, name, figure)
    return [scores.markdown()]


def _single(scores: Scores) -> str:
    return scores.markdown()


if __name__ == "__main__":
    main()
