"""Similar clips of damaged queries of twelve classes."""

import numpy as np

from solvers.motion import Motion
from solvers.retrieval import Clip, build_clip_library, find_similar
from solvers.samples import CorruptionSettings, corrupt

from ..takes import hdm05, joint_tracks, walk

CLASSES = {
    "depositFloorR": 5, "elbowToKnee1RepsLelbowStart": 5, "grabHighR": 3,
    "hopBothLegs1hops": 11, "jogLeftCircle4StepsRstart": 1, "kickLFront1Reps": 5,
    "lieDownFloor": 3, "rotateArmsBothBackward1Reps": 3, "sneak2StepsLStart": 2,
    "squat1Reps": 11, "throwBasketball": 2,
}  # fmt: skip
"""Clips of each class in the library; the next one of it is the query."""


def prepare() -> dict[str, object]:
    """Fill a library with clips of each class, and damage one more of each as query."""
    clips, queries = [], []
    for label, n_clips in CLASSES.items():
        clips += [
            (f"{label} {number}", hdm05(label, number)) for number in range(1, n_clips + 1)
        ]
        query = hdm05(label, n_clips + 1)
        noisy = corrupt(query, CorruptionSettings(jitter=3.0))
        queries.append((label, noisy))
        queries.append((label, joint_tracks(query.slice(2, max(query.n_frames - 6, 12)))))
    for name in ("10_04", "07_03", "32_01"):
        clips.append((f"walk {name}", walk(name)))
    queries.append(("walk", walk("26_01").slice(0, 90)))
    return {"clips": clips, "queries": queries}


def measure(
    clips: list[tuple[str, Motion]],
    queries: list[tuple[str, Motion]],
) -> dict[str, float]:
    """Mean rank and score of the clips of the query's class."""
    library = build_clip_library([Clip(name, motion) for name, motion in clips])
    ranks, margins, best, frames = [], [], [], []
    for label, query in queries:
        matches = find_similar(query, library)
        order = [match.clip.startswith(label) for match in matches]
        right = [rank for rank, hit in enumerate(order) if hit]
        ranks.append(float(np.mean(right or [len(clips)])))
        scores = np.array([match.score for match in matches])
        hits = np.array(order)
        margins.append(1.0 + scores[~hits].mean() - scores[hits].mean() if hits.any() else 2.0)
        best.append(0.0 if order and order[0] else 1.0)
        frames.append(len(matches[0].frames))
    return {
        "mean rank": float(np.mean(ranks)),
        "margin of scores": float(np.mean(margins)),
        "first is wrong": 1.0 + sum(best),
        "frames of the best": float(np.mean(frames)),
    }
