"""Build the posture library that is shipped, from captures that anyone may use.

    make postures ARGUMENTS="[--out FILE]"

CMU (mocap.cs.cmu.edu, created with funding from NSF EIA-0196217), and the true postures of
UI-PRMD (Vakanski, Jun, Paul, Baker 2018, published as ODC-PDDL).
"""

import argparse
from pathlib import Path

from solvers.reconstruction.pose_library.posture_library import SHIPPED_LIBRARY

from ..benchmarks.reconstruction.kinect_pairs import read_pairs
from ..benchmarks.reconstruction.posture_sources import (
    cmu_library,
    exercise_library,
    joined,
)


def main() -> None:
    """Read the clips, thin out their postures and save them."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--out", type=Path, default=SHIPPED_LIBRARY)
    given = parser.parse_args()
    library = joined(cmu_library(), exercise_library(read_pairs()))
    given.out.parent.mkdir(exist_ok=True)
    library.save(given.out)
    size = given.out.stat().st_size
    print(f"{library.n_postures} of {library.n_seen} postures, {size} bytes: {given.out}")


if __name__ == "__main__":
    main()
