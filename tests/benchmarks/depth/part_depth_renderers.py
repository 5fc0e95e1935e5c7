"""Our pictures of skinned bodies against Blender's own, of some frames of each sequence."""

from dataclasses import replace

import numpy as np

from ..shared.tables import table
from .blender_depth import blender_depth, difference, our_depth
from .depth_extra_sequences import KINECT, TAKES, before_camera, body_of, view_center

FRAMES = 3
"""Of each sequence."""


def renderers() -> list[str]:
    """Let Blender skin and render the bodies of `depth_more`; compare with our pictures."""
    rows, differences, uncovered = {}, [], []
    for name, take in TAKES.items():
        body = body_of(name)
        motion, rotations = before_camera(body, take)
        some = np.linspace(0, motion.n_frames - 1, FRAMES + 2)[1:-1].round().astype(int)
        motion = replace(
            motion,
            rotations=motion.rotations[some],
            root_positions=motion.root_positions[some],
        )
        given = body, motion, rotations[some], view_center(take), KINECT
        found = difference(our_depth(*given), blender_depth(*given))
        rows[name] = _row(found.millimeters, found.covered)
        differences.append(found.millimeters)
        uncovered.append(found.covered)
    rows["all"] = _row(np.concatenate(differences), float(np.mean(uncovered)))
    header = ["sequence", "pixels", "mean mm", "95 % mm", "largest mm", "% in one image only"]
    title = f"**Our pictures against Blender's Cycles, without noise** ({FRAMES} frames each)"
    return [f"{title}\n\n{table(header, rows)}\n"]


def _row(millimeters: np.ndarray, uncovered: float) -> list[str]:
    worst = f"{millimeters.max():.2f}"
    quantile = f"{np.quantile(millimeters, 0.95):.3f}"
    return [
        str(len(millimeters)),
        f"{millimeters.mean():.3f}",
        quantile,
        worst,
        f"{100.0 * uncovered:.3f}",
    ]
