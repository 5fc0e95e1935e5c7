"""Learn the motion prior that is shipped, from captures that anyone may use.

    make motion-prior ARGUMENTS="[--out FILE]"

CMU (mocap.cs.cmu.edu, created with funding from NSF EIA-0196217) and UI-PRMD (Vakanski, Jun,
Paul, Baker 2018, published as ODC-PDDL).
"""

from solvers.depth_tracking.body.learn_motion_prior import learn_motion_prior
from solvers.depth_tracking.body.motion_prior import SHIPPED

from ..benchmarks.depth.forest_sources import cmu_motions, exercises
from .arguments import parse_output, print_progress

HOPPER = "49"
"""The actor of hops in depth/truth; the walkers there are held out as well."""
ONCE = ("s01_e01", "s03_e01", "s06_e01")
"""Actors and repetitions of the exercises of UI-PRMD."""
WORDS = (
    "CMU mocap (walks, exercises, dance) and UI-PRMD (exercises of rehabilitation); without"
    " the clips of depth/truth and their actors"
)


def main() -> None:
    """Learn, and save where it is shipped."""
    out = parse_output(__doc__, SHIPPED)
    motions = [*cmu_motions(but=(HOPPER,)), *exercises(which=ONCE)]
    learn_motion_prior(motions, trained_on=WORDS, progress=print_progress).save(out)


if __name__ == "__main__":
    main()
