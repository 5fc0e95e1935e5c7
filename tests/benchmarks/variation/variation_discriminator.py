"""How well a classifier distinguishes variants from held-out captures."""

from collections.abc import Sequence

import numpy as np
from sklearn.ensemble import RandomForestClassifier
from sklearn.metrics import balanced_accuracy_score
from sklearn.model_selection import StratifiedGroupKFold

from solvers.motion import Motion
from solvers.variation.align_examples import positions_in_body_frame

WINDOW, RATE, N_AXES = 15, 30.0, 20


def classification_accuracy(captures: Sequence[Motion], others: Sequence[Motion]) -> float:
    """Return the balanced accuracy in percent on clips that were not trained on; 50 is chance.

    A random forest sees half a second at 30 Hz: the principal components of the body, and how
    fast and how jerkily each joint moves.
    """
    clips = [_windows(one) for one in (*captures, *others)]
    axes = _axes(np.concatenate([body for body, _ in clips]))
    features = np.concatenate([np.column_stack([body @ axes.T, pace]) for body, pace in clips])
    groups = np.repeat(np.arange(len(clips)), [len(body) for body, _ in clips])
    labels = groups >= len(captures)
    guessed = np.zeros_like(labels)
    folds = StratifiedGroupKFold(min(4, len(captures)), shuffle=True, random_state=0)
    for train, test in folds.split(features, labels, groups):
        forest = RandomForestClassifier(
            100, class_weight="balanced", min_samples_leaf=3, random_state=0
        )
        guessed[test] = forest.fit(features[train], labels[train]).predict(features[test])
    return 100.0 * float(balanced_accuracy_score(labels, guessed))


def _windows(motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    body = positions_in_body_frame(motion)[:: max(round(motion.frame_rate / RATE), 1)]
    rows, paces = [], []
    for start in range(0, max(len(body) - WINDOW, 0) + 1, 3):
        part = body[start : start + WINDOW]
        part = np.pad(part, ((0, WINDOW - len(part)), (0, 0), (0, 0)), mode="edge")
        rows.append(part.ravel())
        sizes = [np.linalg.norm(np.diff(part, n, axis=0), axis=-1).mean(axis=0) for n in (1, 3)]
        paces.append(np.log(np.concatenate(sizes) + 1e-5))
    return np.array(rows), np.array(paces)


def _axes(rows: np.ndarray) -> np.ndarray:
    return np.linalg.svd(rows - rows.mean(axis=0), full_matrices=False)[2][:N_AXES]
