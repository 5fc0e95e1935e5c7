"""Build the posture library that is shipped, from captures that anyone may use.

    make postures ARGUMENTS="[--out FILE]"

CMU (mocap.cs.cmu.edu, created with funding from NSF EIA-0196217), and the true postures of
UI-PRMD (Vakanski, Jun, Paul, Baker 2018, published as ODC-PDDL).
"""

from solvers.reconstruction.pose_library.posture_library import SHIPPED_LIBRARY

from ..benchmarks.reconstruction.kinect_pairs import read_pairs
from ..benchmarks.reconstruction.posture_sources import (
    cmu_library,
    exercise_library,
    joined,
)
from .arguments import parse_output


def main() -> None:
    """Read the clips, thin out their postures and save them."""
    out = parse_output(__doc__, SHIPPED_LIBRARY)
    library = joined(cmu_library(), exercise_library(read_pairs()))
    library.save(out)
    size = out.stat().st_size
    print(f"{library.n_postures} of {library.n_seen} postures, {size} bytes: {out}")


if __name__ == "__main__":
    main()
