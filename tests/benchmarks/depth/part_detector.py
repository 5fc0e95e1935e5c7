"""The detector: parts classified per pixel, and poses detected in single frames.

    python -m tests.benchmarks.depth.part_detector [--forest FILE] [--every N] [--peer]

The peer is scikit-learn's random forest on the same features: 400 of our random differences of
depth of the same training pixels. It cannot draw new features at each node, nor would it fit
into what we ship.
"""

import argparse
from collections.abc import Iterable, Sequence
from pathlib import Path
from time import process_time

import numpy as np

from solvers.arrays import Array
from solvers.depth_tracking.body.model import BodyModel, default_body
from solvers.depth_tracking.body.pose_from_joints import body_from_joints
from solvers.depth_tracking.detection.detect_pose import DetectorSettings, detect_pose
from solvers.depth_tracking.forest.depth_differences import (
    depth_differences,
    pad_depth_image,
    pixel_features,
)
from solvers.depth_tracking.forest.grow_tree import grow_tree, random_offsets
from solvers.depth_tracking.forest.parts import MIRRORED_PARTS, N_PARTS, PARTS
from solvers.depth_tracking.forest.pixel_forest import (
    SHIPPED,
    PixelForest,
    classify_pixels,
    load_pixel_forest,
)
from solvers.depth_tracking.forest_training.render_mesh import NO_PART
from solvers.depth_tracking.forest_training.train_forest import (
    PixelForestSettings,
    draw_images,
    draw_pixels,
    train_pixel_forest,
)
from solvers.depth_tracking.forest_training.training_images import IMAGES_PER_BODY, image_source

from .depth_labels import LabeledFrame, held_out_frames, truth_frames
from .forest_sources import TRUTH, all_bodies, taught_motions
from .part_detector_kinect import kinect_rows

MAX_FOUND_ERROR_M = 0.1
"""Meters: a joint found within counts as found."""
STEP_FRAMES = 15
"""Frames from one that is evaluated to the next."""
PEER_PICTURES, PEER_PIXELS, PEER_FEATURES = 1500, 60, 400


def detector() -> list[str]:
    """Return all tables of the detector that is shipped, for `bench_depth`."""
    forest = load_pixel_forest()
    settings = DetectorSettings()
    default, true = (
        pose_rows(forest, STEP_FRAMES, settings, calibrated) for calibrated in (False, True)
    )
    tables = {
        f"Parts classified per pixel, at 160 x 120; {forest.trained_on}": accuracy_rows(
            forest, STEP_FRAMES
        ),
        "Poses in single frames, default adult body": default,
        "Poses in single frames, limbs of true length": true,
        "Against scikit-learn's forest on the same features": peer_rows(STEP_FRAMES),
        "Held-out bodies": body_rows(STEP_FRAMES),
        "Single frames of a real Kinect, against its SDK": kinect_rows(forest),
    }
    return [f"**{title}**\n\n" + "\n".join(rows) for title, rows in tables.items()]


def confusion(frames: Iterable[LabeledFrame], forest: PixelForest) -> tuple[Array, float]:
    """Count pixels by true and classified part, and measure milliseconds per frame."""
    counts, times = np.zeros((N_PARTS, N_PARTS)), []
    for frame in frames:
        start = process_time()
        found = classify_pixels(frame.depth, frame.camera, forest)
        times.append(process_time() - start)
        true = frame.labels[found.rows, found.columns]
        labeled = true != NO_PART
        np.add.at(counts, (true[labeled], found.labels[labeled]), 1)
    return counts, 1e3 * float(np.median(times))


def accuracy_rows(forest: PixelForest, every: int) -> list[str]:
    """Return a table of correctly classified pixels by source."""
    sources = {take: truth_frames(take, every) for take in TRUTH} | {"HDM05": held_out_frames()}
    total = np.zeros((N_PARTS, N_PARTS))
    rows = ["| source | pixels right | mean of parts | other side | ms |", "|" + "---|" * 5]
    for name, frames in sources.items():
        counts, milliseconds = confusion(frames, forest)
        rows.append(_accuracy_row(name, counts, milliseconds))
        total += counts if name in TRUTH else 0.0
    rows.append(_accuracy_row("depth/truth", total, float("nan")))
    parts = np.diag(total) / np.maximum(total.sum(axis=1), 1.0)
    by_part = ", ".join(
        f"{part} {accuracy:.2f}" for part, accuracy in zip(PARTS, parts, strict=True)
    )
    return [*rows, "", f"By part on depth/truth: {by_part}."]


def _accuracy_row(name: str, counts: Array, milliseconds: float) -> str:
    present = counts.sum(axis=1) > 0
    right = np.diag(counts)
    sides = np.arange(N_PARTS) != MIRRORED_PARTS
    mirrored = counts[np.arange(N_PARTS), MIRRORED_PARTS][sides].sum()
    parts = right[present] / counts.sum(axis=1)[present]
    figures = right.sum() / counts.sum(), parts.mean(), mirrored / counts.sum()
    return f"| {name} | " + " | ".join(f"{x:.3f}" for x in figures) + f" | {milliseconds:.1f} |"


def pose_rows(
    forest: PixelForest, every: int, settings: DetectorSettings, calibrated: bool
) -> list[str]:
    """Return a table of joints found in single frames.

    The body is the default adult, or has the limb lengths of the true joints.
    """
    rows = [
        "| take | mean cm | within 10 cm | less offsets, cm | within 10 cm | ms |",
        "|" + "---|" * 6,
    ]
    errors = []
    for take in TRUTH:
        frames = list(truth_frames(take, every))
        true = np.stack([frame.joints for frame in frames])
        body = body_from_joints(default_body(), true) if calibrated else default_body()
        found, milliseconds = found_joints(frames, body, forest, settings)
        offsets = (found - true)[:, np.isfinite(true).all(axis=(0, 2))]
        errors.append((offsets, offsets - np.median(offsets, axis=0)))
        rows.append(_pose_row(take, [errors[-1]], milliseconds))
    return [*rows, _pose_row("all", errors, float("nan"))]


def found_joints(
    frames: Sequence[LabeledFrame],
    body: BodyModel,
    forest: PixelForest,
    settings: DetectorSettings,
) -> tuple[Array, float]:
    """Return the joints found in each frame, and milliseconds per frame."""
    found, times = [], []
    for frame in frames:
        start = process_time()
        pose = detect_pose(frame.depth, frame.camera, body, forest, settings)
        times.append(process_time() - start)
        found.append(pose.joints)
    return np.stack(found), 1e3 * float(np.median(times))


def _pose_row(name: str, errors: Sequence[tuple[Array, Array]], milliseconds: float) -> str:
    figures = []
    for kind in range(2):
        distances = np.concatenate([np.linalg.norm(one[kind], axis=-1) for one in errors])
        figures += [100.0 * distances.mean(), (distances < MAX_FOUND_ERROR_M).mean()]
    shown = " | ".join(
        f"{figure:.{1 if index % 2 == 0 else 3}f}" for index, figure in enumerate(figures)
    )
    return f"| {name} | {shown} | {milliseconds:.0f} |"


def peer_rows(every: int) -> list[str]:
    """Return how scikit-learn and a small forest of ours tell the same pixels."""
    from sklearn.ensemble import RandomForestClassifier

    settings = PixelForestSettings(n_images=PEER_PICTURES, n_pixels=PEER_PIXELS)
    source = image_source(taught_motions(), all_bodies(), settings, 0)
    images = draw_images(source, range(PEER_PICTURES // IMAGES_PER_BODY))
    views, parts = draw_pixels(images, PEER_PIXELS, np.random.default_rng(0))
    features = random_offsets(PEER_FEATURES, settings.reach, np.random.default_rng(1))
    offsets = features.astype(np.float32) / np.float32(100.0)
    table = np.stack(
        [depth_differences(views, one).clip(-1001, 1001) for one in offsets], axis=1
    )
    peer = RandomForestClassifier(
        3, max_depth=18, min_samples_split=40, max_features=100, criterion="entropy",
        random_state=0,
    ).fit(table.astype(np.float32), parts)  # fmt: skip
    same_settings = PixelForestSettings(levels=18, n_candidates=100, min_pixels=40)
    ours = PixelForest(
        tuple(
            grow_tree(views, parts, same_settings, np.random.default_rng(n)) for n in range(3)
        )
    )
    right = {"scikit-learn": 0, "ours": 0}
    total = 0
    for take in TRUTH:
        for frame in truth_frames(take, every):
            found = classify_pixels(frame.depth, frame.camera, ours)
            true = frame.labels[found.rows, found.columns]
            labeled = true != NO_PART
            here = pixel_features(
                pad_depth_image(frame.depth)[np.newaxis], np.zeros(len(true), dtype=np.intp),
                found.rows, found.columns, frame.camera,
            )  # fmt: skip
            values = np.stack(
                [depth_differences(here, one).clip(-1001, 1001) for one in offsets], 1
            )
            labels = peer.predict(values.astype(np.float32))
            right["ours"] += int((found.labels == true)[labeled].sum())
            right["scikit-learn"] += int((labels == true)[labeled].sum())
            total += int(labeled.sum())
    rows = ["| three trees of the same 90,000 pixels | pixels right |", "|---|---|"]
    return rows + [f"| {name} | {count / total:.3f} |" for name, count in right.items()]


def body_rows(every: int) -> list[str]:
    """Return the accuracy of small forests on bodies of new shapes and of trained ones.

    Every training body is resized and dressed at random, and mixed with another one.
    """
    held_out = ("male_heavy", "female_slim")
    small = PixelForestSettings(n_images=PEER_PICTURES, n_pixels=PEER_PIXELS, levels=15)
    few = [body for body in all_bodies() if body.name not in held_out]
    rows = ["| small forest of | pixels right on the two others |", "|---|---|"]
    for name, bodies in (("four bodies", all_bodies()), ("two bodies", few)):
        forest = train_pixel_forest(taught_motions(), bodies, small)
        counts = sum(
            confusion(truth_frames(take, every), forest)[0]
            for take, (_, _, body) in TRUTH.items()
            if body in held_out
        )
        rows.append(f"| {name} | {np.trace(counts) / np.sum(counts):.3f} |")
    return rows


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--forest", type=Path, default=SHIPPED)
    parser.add_argument("--every", type=int, default=10)
    parser.add_argument("--peer", action="store_true", help="also train scikit-learn's")
    parser.add_argument("--bodies", action="store_true", help="also train without some bodies")
    given = parser.parse_args()
    forest = load_pixel_forest(given.forest)
    print("\n".join(accuracy_rows(forest, given.every)), flush=True)
    for calibrated in (False, True):
        print(f"\n{'Limbs of true length' if calibrated else 'The default adult'}\n")
        print(
            "\n".join(pose_rows(forest, given.every, DetectorSettings(), calibrated)),
            flush=True,
        )
    if given.peer:
        print("\n" + "\n".join(peer_rows(given.every)), flush=True)
    if given.bodies:
        print("\n" + "\n".join(body_rows(given.every)))


if __name__ == "__main__":
    main()
