"""Our pictures of skinned bodies against Blender's own, of some frames of each sequence."""

from dataclasses import replace

import numpy as np

from ..shared.tables import table
from .blender_depth import blender_depth, difference, our_depth
from .depth_more import KINECT, TAKES, before_camera, body_of, place

FRAMES = 3
"""Of each sequence."""


def renderers() -> list[str]:
    """Let Blender skin and render the bodies of `depth_more`; compare with our pictures."""
    rows, apart, lost = {}, [], []
    for name, take in TAKES.items():
        body = body_of(name)
        motion, turns = before_camera(body, take)
        some = np.linspace(0, motion.n_frames - 1, FRAMES + 2)[1:-1].round().astype(int)
        motion = replace(
            motion,
            rotations=motion.rotations[some],
            root_positions=motion.root_positions[some],
        )
        given = body, motion, turns[some], place(take), KINECT
        found = difference(our_depth(*given), blender_depth(*given))
        rows[name] = _row(found.millimetres, found.covered)
        apart.append(found.millimetres)
        lost.append(found.covered)
    rows["all"] = _row(np.concatenate(apart), float(np.mean(lost)))
    header = ["sequence", "pixels", "mean mm", "95 % mm", "largest mm", "% covered otherwise"]
    title = f"**Our pictures against Blender's Cycles, without noise** ({FRAMES} frames each)"
    return [f"{title}\n\n{table(header, rows)}\n"]


def _row(apart: np.ndarray, lost: float) -> list[str]:
    worst = f"{apart.max():.2f}"
    share = f"{np.quantile(apart, 0.95):.3f}"
    return [str(len(apart)), f"{apart.mean():.3f}", share, worst, f"{100.0 * lost:.3f}"]
