"""Train the pixel forest that is shipped, from captures and bodies that anyone may use.

    make forest ARGUMENTS="[--pictures N] [--trees N] [--jobs N] [--out FILE]"

CMU (mocap.cs.cmu.edu, created with funding from NSF EIA-0196217), UI-PRMD (Vakanski, Jun, Paul,
Baker 2018, published as ODC-PDDL) and bodies in the public domain (CC0). The trees are those of
`train_pixel_forest`; here they grow side by side.
"""

from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial

from solvers.depth_tracking.forest.grow_tree import Tree
from solvers.depth_tracking.forest.pixel_forest import SHIPPED, PixelForest
from solvers.depth_tracking.forest_training.train_forest import (
    PixelForestSettings,
    train_pixel_forest,
)

from ..benchmarks.depth.forest_sources import WORDS, all_bodies, taught_motions
from .arguments import output_parser, print_progress

SETTINGS = PixelForestSettings(
    n_trees=4, n_images=12_000, n_pixels=120, levels=18, n_candidates=100, min_pixels=50
)


def grown(settings: PixelForestSettings, number: int) -> tuple[Tree, ...]:
    """Grow one tree from pictures of its own."""
    alone = replace(settings, n_trees=1, seed=settings.seed + number)
    return train_pixel_forest(
        taught_motions(), all_bodies(), alone, progress=print_progress
    ).trees


def main() -> None:
    """Grow the trees and save them where they are shipped."""
    parser = output_parser(__doc__, SHIPPED)
    parser.add_argument("--pictures", type=int, default=SETTINGS.n_images)
    parser.add_argument("--trees", type=int, default=SETTINGS.n_trees)
    parser.add_argument("--jobs", type=int, default=2)
    given = parser.parse_args()
    settings = replace(SETTINGS, n_images=given.pictures)
    with ProcessPoolExecutor(given.jobs) as pool:
        trees = pool.map(partial(grown, settings), range(given.trees))
    forest = PixelForest(tuple(tree for each in trees for tree in each), WORDS)
    forest.save(given.out)
    n_leaves = sum(len(tree.shares) for tree in forest.trees)
    print(f"{n_leaves} leaves, {given.out.stat().st_size} bytes: {given.out}")


if __name__ == "__main__":
    main()
