"""Takes of a real Kinect (UTD-MHAD), and pictures of a body drawn over them."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw
from scipy.io import loadmat

from solvers.depth_tracking.body_motion import JOINT_PARENTS
from solvers.depth_tracking.body_tables import JOINTS
from solvers.depth_tracking.capture import Capture
from solvers.depth_tracking.hypothesis import imagine
from solvers.motion.camera import Camera
from solvers.motion.depth_recording import DepthRecording

TAKES = Path(__file__).resolve().parents[3] / "shared" / "data" / "depth" / "utd_mhad"
KINECT_TAKES = tuple(f"{take}_t1" for take in ("a1_s1", "a6_s3", "a7_s3", "a24_s5", "a26_s7"))
"""Swipe, crossed arms, basketball, standing up, lunge."""
LATE = 2
"""depth[t] fits skeleton[t - 2] (data/README.md)."""
SDK_JOINTS = (
    "head", "neck", "spine", "hips",
    "rightUpperArm", "rightLowerArm", "rightHand", None,
    "leftUpperArm", "leftLowerArm", "leftHand", None,
    "rightUpperLeg", "rightLowerLeg", "rightFoot", None,
    "leftUpperLeg", "leftLowerLeg", "leftFoot", None,
)  # fmt: skip
"""Ours for each of theirs: the pictures are mirrored, so that their left is our right."""
STABLE = tuple(
    place for place, name in enumerate(SDK_JOINTS)
    if name in {"head", "neck", "spine", "hips", "leftUpperArm", "rightUpperArm",
                "leftUpperLeg", "rightUpperLeg", "leftLowerLeg", "rightLowerLeg"}
)  # fmt: skip
HANDS = (SDK_JOINTS.index("leftHand"), SDK_JOINTS.index("rightHand"))
SHOWN = 6


@dataclass(frozen=True, eq=False)
class KinectTake:
    """A depth recording and the joints that the Kinect SDK told."""

    name: str
    depth: DepthRecording
    joints: np.ndarray
    """Shape (n_frames, 20, 3), metres, camera frame (y down)."""

    def distances(self, found: np.ndarray) -> np.ndarray:
        """Return how far each SDK joint is from ours after its median offset, metres, (20,)."""
        n_frames = min(self.depth.n_frames - LATE, len(self.joints))
        distances = np.full(len(SDK_JOINTS), np.nan)
        for place, name in enumerate(SDK_JOINTS):
            if name is None:
                continue
            ours = found[LATE : LATE + n_frames, JOINTS.index(name)]
            off = ours - self.joints[:n_frames, place]
            off -= np.median(off, axis=0)
            distances[place] = np.linalg.norm(off, axis=1).mean()
        return distances


def kinect_take(name: str) -> KinectTake:
    """Read one take."""
    depth = np.moveaxis(loadmat(TAKES / f"{name}_depth.mat")["d_depth"], 2, 0)
    joints = np.moveaxis(loadmat(TAKES / f"{name}_skeleton.mat")["d_skel"], 2, 0)
    camera = Camera(285.63, 285.63, 160.0, 120.0, 320, 240)
    recording = DepthRecording(
        camera, len(depth), 30.0, lambda i: depth[i].astype(np.float32) / np.float32(1000.0)
    )
    return KinectTake(name, recording, joints * [1.0, -1.0, 1.0])


def draw_overlays(take: KinectTake, found: Capture, path: Path) -> None:
    """Draw some frames: depth grey, our body orange, bones green (red: flagged), SDK blue."""
    frames = np.linspace(LATE, take.depth.n_frames - LATE - 1, SHOWN).round().astype(int)
    strip = Image.new("RGB", (SHOWN * 240, 480))
    for place, frame in enumerate(frames):
        strip.paste(_panel(take, found, int(frame)), (240 * place, 0))
    path.parent.mkdir(parents=True, exist_ok=True)
    strip.save(path, optimize=True)


def _panel(take: KinectTake, found: Capture, frame: int) -> Image.Image:
    depth, camera = take.depth.frame(frame), take.depth.camera
    drawn = imagine(found.body, found.poses[frame], camera).picture.depth_picture()
    seen = depth[depth > 0.0]
    grey = np.where(depth > 0.0, 250.0 - 180.0 * (depth - seen.min()) / np.ptp(seen), 0.0)
    picture = np.repeat(grey[..., np.newaxis], 3, axis=2)
    picture[drawn > 0.0] = 0.6 * picture[drawn > 0.0] + [90.0, 40.0, 0.0]
    image = Image.fromarray(picture.clip(0.0, 255.0).astype(np.uint8)).resize((640, 480))
    pen = ImageDraw.Draw(image)
    places = 2.0 * camera.project(found.joints.positions[frame])
    for joint, parent in enumerate(JOINT_PARENTS):
        if parent >= 0:
            color = (230, 30, 30) if found.doubtful[frame, joint] else (40, 220, 60)
            pen.line([*places[parent], *places[joint]], fill=color, width=3)
    for x, y in 2.0 * camera.project(take.joints[min(frame - LATE, len(take.joints) - 1)]):
        pen.ellipse([x - 3, y - 3, x + 3, y + 3], fill=(80, 160, 255))
    middle = int(places[0, 0])
    return image.crop((middle - 120, 0, middle + 120, 480))
