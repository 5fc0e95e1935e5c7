"""Pictures of a body over the depth that it was found in.

Depth gray, our body orange, its bones green (red where confidence is low), the joints of the
Kinect's SDK blue.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from solvers.depth_scene.recording import DepthRecording
from solvers.depth_tracking.body.motion import JOINT_PARENTS
from solvers.depth_tracking.capturing.capture import Capture
from solvers.depth_tracking.terms.hypothesis import render_hypothesis

CONFIDENT, LOW_CONFIDENCE, OTHERS = (40, 220, 60), (230, 30, 30), (80, 160, 255)
ENLARGEMENT = 2.0
HALF_WIDTH_PX = 120
"""Half of a panel's width, pixels."""


def overlay(
    depth: DepthRecording, found: Capture, frame: int, others: np.ndarray | None = None
) -> Image.Image:
    """Draw one frame, and joints (n, 3) from another source, 240 pixels about the actor."""
    depth_image, camera = depth.frame(frame), depth.camera
    drawn = render_hypothesis(found.body, found.poses[frame], camera).image.depth_image()
    image = Image.fromarray(_tinted(depth_image, drawn))
    image = image.resize((int(ENLARGEMENT * camera.width), int(ENLARGEMENT * camera.height)))
    pen = ImageDraw.Draw(image)
    pixels = ENLARGEMENT * camera.project(found.joints.positions[frame])
    for joint, parent in enumerate(JOINT_PARENTS):
        if parent >= 0:
            color = LOW_CONFIDENCE if found.low_confidence[frame, joint] else CONFIDENT
            pen.line([*pixels[parent], *pixels[joint]], fill=color, width=3)
    for x, y in [] if others is None else ENLARGEMENT * camera.project(others):
        if np.isfinite(x + y):
            pen.ellipse([x - 3, y - 3, x + 3, y + 3], fill=OTHERS)
    columns = np.nonzero(depth_image)[1]
    middle = int(ENLARGEMENT * np.median(columns)) if len(columns) else image.width // 2
    return image.crop((middle - HALF_WIDTH_PX, 0, middle + HALF_WIDTH_PX, image.height))


def strip(panels: Sequence[Image.Image], title: str) -> Image.Image:
    """Put panels of one size in a row, with a title."""
    width, height = panels[0].size
    row = Image.new("RGB", (width * len(panels), height))
    for index, panel in enumerate(panels):
        row.paste(panel, (width * index, 0))
    ImageDraw.Draw(row).text((6, 4), title, fill=(255, 255, 255), font_size=24)
    return row


def save_sheet(rows: Sequence[Image.Image], across: int, scale: float, path: Path) -> None:
    """Write rows of panels to a JPEG file, several per row, scaled down."""
    width, height = (int(scale * size) for size in rows[0].size)
    down = -(-len(rows) // across)
    sheet = Image.new("RGB", (width * across, height * down))
    for index, row in enumerate(rows):
        corner = (width * (index % across), height * (index // across))
        sheet.paste(row.resize((width, height), Image.Resampling.LANCZOS), corner)
    path.parent.mkdir(parents=True, exist_ok=True)
    sheet.save(path, quality=70, optimize=True)


def _tinted(depth_image: np.ndarray, drawn: np.ndarray) -> np.ndarray:
    near = depth_image[depth_image > 0.0]
    nearest, depth_range = (
        (near.min(), max(float(np.ptp(near)), 0.1)) if len(near) else (0.0, 1.0)
    )
    gray = np.where(
        depth_image > 0.0, 250.0 - 180.0 * (depth_image - nearest) / depth_range, 0.0
    )
    picture = np.repeat(gray[..., np.newaxis], 3, axis=2)
    picture[drawn > 0.0] = 0.6 * picture[drawn > 0.0] + [90.0, 40.0, 0.0]
    return picture.clip(0.0, 255.0).astype(np.uint8)
