"""The detector on real Kinect frames (UTD-MHAD), against the skeleton of the sensor's own SDK.

    python -m tests.benchmarks.depth.part_detector_kinect [--forest FILE] [--pictures FOLDER]

That skeleton is a reference, not truth. A depth frame fits the skeleton two frames before it.
The sensor's pictures are mirrored, and so is its x axis; `read_depth` mirrors the images back.
"""

import argparse
from colorsys import hsv_to_rgb
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from scipy.io import loadmat

from solvers.arrays import Array
from solvers.depth_scene.recording import DepthRecording
from solvers.depth_tracking.body.model import BodyModel
from solvers.depth_tracking.body.tables import CAPSULES, JOINTS
from solvers.depth_tracking.capturing.calibrate_body import calibrate_body
from solvers.depth_tracking.detection.detect_pose import DetectedPose, detect_pose
from solvers.depth_tracking.forest.parts import N_PARTS, PARTS
from solvers.depth_tracking.forest.pixel_forest import SHIPPED, PixelForest, load_pixel_forest
from solvers.depth_tracking.terms.hypothesis import render_hypothesis
from solvers.recordings import read_depth

from .forest_sources import DATA

FOLDER = DATA / "depth" / "utd_mhad"
SUBJECTS = (1, 3, 5, 7)
N_ACTIONS = 27
DEPTH_DELAY_FRAMES = 2
"""Frames that the depth is behind the skeleton."""
FRAMES_PER_TAKE = 2
MAX_FOUND_ERROR_M = 0.1
SDK = {
    "hips": 3, "leftUpperArm": 4, "leftLowerArm": 5, "leftHand": 6, "rightUpperArm": 8,
    "rightLowerArm": 9, "rightHand": 10, "leftLowerLeg": 13, "leftFoot": 14,
    "rightLowerLeg": 17, "rightFoot": 18,
}  # fmt: skip
"""Joints of the body model and their indices in the SDK's skeleton."""
OURS = [JOINTS.index(joint) for joint in SDK]


class KinectTake(NamedTuple):
    """Some frames of one take and what was found in them."""

    action: int
    subject: int
    camera_frames: list[int]
    depth: DepthRecording
    found: list[DetectedPose]
    reference: Array
    """(n_frames, n_joints, 3) of the SDK, camera frame."""


def kinect_body(subject: int, forest: PixelForest) -> BodyModel:
    """Return the body of a subject, measured in the first frame of a wave."""
    return calibrate_body(_recording(1, subject), 0, forest)


def kinect_take(action: int, subject: int, body: BodyModel, forest: PixelForest) -> KinectTake:
    """Detect the body in a few frames of a take, spread over it."""
    depth = _recording(action, subject)
    skeleton = loadmat(FOLDER / f"a{action}_s{subject}_t1_skeleton.mat")["d_skel"]
    last = min(depth.n_frames, skeleton.shape[2] + DEPTH_DELAY_FRAMES) - 1
    frames = (
        np.linspace(DEPTH_DELAY_FRAMES, last, FRAMES_PER_TAKE + 2)[1:-1].astype(int).tolist()
    )
    found = [detect_pose(depth.frame(frame), depth.camera, body, forest) for frame in frames]
    sdk_joints = skeleton[list(SDK.values())][
        :, :, [frame - DEPTH_DELAY_FRAMES for frame in frames]
    ]
    reference = np.moveaxis(sdk_joints, 2, 0) * [-1.0, -1.0, 1.0]
    return KinectTake(action, subject, frames, depth, found, reference)


def kinect_rows(forest: PixelForest) -> list[str]:
    """Detect the body in frames of all actions, and return how far its joints are."""
    bodies = {subject: kinect_body(subject, forest) for subject in SUBJECTS}
    return distance_rows(all_takes(bodies, forest, N_ACTIONS))


def all_takes(
    bodies: dict[int, BodyModel], forest: PixelForest, n_actions: int
) -> list[KinectTake]:
    """Detect each subject in each of the first actions."""
    return [
        kinect_take(action, subject, bodies[subject], forest)
        for action in range(1, n_actions + 1)
        for subject in SUBJECTS
        if (FOLDER / f"a{action}_s{subject}_t1_depth.mat").exists()
    ]


def distance_rows(takes: list[KinectTake]) -> list[str]:
    """Return tables of distances to the SDK's joints, less a constant offset of each joint."""
    offsets = np.stack([pose.joints[OURS] for take in takes for pose in take.found])
    offsets = offsets - np.concatenate([take.reference for take in takes])
    subjects = np.array([take.subject for take in takes for _ in take.found])
    for subject in SUBJECTS:
        offsets[subjects == subject] -= np.median(offsets[subjects == subject], axis=0)
    distances = np.linalg.norm(offsets, axis=-1)
    overlap = np.array([pose.overlap for take in takes for pose in take.found])
    rows = ["| joint | mean cm | median cm | within 10 cm |", "|---|---|---|---|"]
    for index, joint in enumerate([*SDK, "all"]):
        one = distances if joint == "all" else distances[:, index]
        figures = 100 * one.mean(), 100 * np.median(one), (one < MAX_FOUND_ERROR_M).mean()
        rows.append(f"| {joint} | {figures[0]:.1f} | {figures[1]:.1f} | {figures[2]:.3f} |")
    actions = np.array([take.action for take in takes for _ in take.found])
    worst = sorted(set(actions), key=lambda action: -distances[actions == action].mean())[:5]
    report = ", ".join(
        f"a{action} {100 * distances[actions == action].mean():.1f} cm" for action in worst
    )
    return [
        *rows,
        "",
        f"{len(distances)} frames; overlap {overlap.mean():.2f}; worst actions: {report}.",
    ]


def draw(take: KinectTake, body: BodyModel, number: int) -> NDArray[np.uint8]:
    """Draw depth, classified parts and the detected body next to each other."""
    pose, frame = take.found[number], take.camera_frames[number]
    depth = take.depth.frame(frame)[:: pose.step, :: pose.step]
    gray = np.where(
        depth > 0, np.clip(255 - 130 * (depth - depth[depth > 0].min()), 60, 255), 0
    )
    pictures = [np.repeat(gray[..., None], 3, axis=2)]
    labels = pictures[0].copy()
    labels[pose.pixels.rows, pose.pixels.columns] = COLORS[pose.pixels.labels]
    picture = render_hypothesis(body, pose.pose, take.depth.camera.every(pose.step)).image
    fitted = pictures[0].copy()
    pixels = np.divmod(picture.pixels, picture.camera.width)
    fitted[pixels] = 0.5 * fitted[pixels] + 0.5 * COLORS[_capsule_parts()[picture.capsules]]
    middle = int(np.median(pose.pixels.columns))
    half = depth.shape[1] // 5
    left = int(np.clip(middle - half, 0, depth.shape[1] - 2 * half))
    cut = [one[:, left : left + 2 * half] for one in (*pictures, labels, fitted)]
    return np.concatenate(cut, axis=0).astype(np.uint8)


def _capsule_parts() -> NDArray[np.intp]:
    return np.array([PARTS.index(capsule) for capsule in CAPSULES])


COLORS = 255.0 * np.array(
    [hsv_to_rgb(7 * n % N_PARTS / N_PARTS, 0.6 + 0.4 * (n % 2), 1 - 0.35 * (n % 3) / 2)
     for n in range(N_PARTS)]
)  # fmt: skip


def _recording(action: int, subject: int) -> DepthRecording:
    return read_depth(FOLDER / f"a{action}_s{subject}_t1_depth.mat")


def main() -> None:
    """Detect in all actions, print the tables, and draw one frame of each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--forest", type=Path, default=SHIPPED)
    parser.add_argument("--pictures", type=Path)
    parser.add_argument("--actions", type=int, default=N_ACTIONS)
    given = parser.parse_args()
    forest = load_pixel_forest(given.forest)
    bodies = {subject: kinect_body(subject, forest) for subject in SUBJECTS}
    takes = all_takes(bodies, forest, given.actions)
    print("\n".join(distance_rows(takes)))
    if given.pictures:
        given.pictures.mkdir(parents=True, exist_ok=True)
        drawn = [draw(take, bodies[take.subject], 1) for take in takes]
        for start in range(0, len(drawn), 12):
            sheet = np.concatenate(drawn[start : start + 12], axis=1)
            Image.fromarray(sheet).save(given.pictures / f"detected_{start // 12:02d}.png")


if __name__ == "__main__":
    main()
