"""What [LOU12] needs and depth/truth lacks: colors, and recorded motions of others."""

from dataclasses import replace
from functools import cache

import numpy as np
from scipy.ndimage import distance_transform_edt

from solvers.depth_tracking.body.learn_motion_prior import poses_from_motion
from solvers.depth_tracking.body.motion_prior import MotionPrior, motion_prior_from_poses

from .depth_labels import truth_bodies
from .depth_sequences import Sequence, sequence
from .depth_tuning import clip
from .forest_sources import DATA
from .painted_bodies import colored_picture, vertex_materials

WALKS = tuple(
    f"cmu_walk/{walk}.bvh"
    for walk in ("06_01", "10_04", "26_01", "27_01", "29_01", "32_01", "32_02")
)
"""By six actors, none of them one of depth/truth."""
HOPS = tuple(
    f"hdm05/{path.name}"
    for path in sorted((DATA / "mocap" / "hdm05").glob("HDM_bd_hopBothLegs1hops_*.amc"))
)
"""By an actor of HDM05."""


@cache
def colored(name: str) -> Sequence:
    """Return one of depth/truth with colors painted on the bodies that it was drawn from."""
    one = sequence(name)
    body, laid = truth_bodies(name)
    materials, rng = vertex_materials(body), np.random.default_rng(5)
    pictures = []
    for frame, vertices in laid:
        rendered = colored_picture(body, materials, vertices, one.depth.camera, rng)
        unknown = (rendered.depth == 0.0) & (one.depth.frame(frame) > 0.0)
        rows, columns = distance_transform_edt(
            rendered.depth == 0.0, return_distances=False, return_indices=True
        )
        rendered.color[unknown] = rendered.color[rows[unknown], columns[unknown]]
        pictures.append(rendered.color)
    depth = replace(one.depth, read_color=lambda frame: pictures[frame])
    return replace(one, depth=depth)


def others_motions() -> MotionPrior:
    """Return the prior of walks and hops by other actors than those of depth/truth."""
    return motions_of((*WALKS, *HOPS))


@cache
def motions_of(names: tuple[str, ...]) -> MotionPrior:
    """Return the prior of some clips."""
    motions = [clip(name) for name in names]
    return motion_prior_from_poses([
        poses_from_motion(motion.slice(1, motion.n_frames)) for motion in motions
    ])
