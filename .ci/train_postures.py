"""Build the posture library that is shipped, from captures that anyone may use.

    python .ci/train_postures.py [--out FILE]

CMU (mocap.cs.cmu.edu, created with funding from NSF EIA-0196217), and the true postures of
UI-PRMD (Vakanski, Jun, Paul, Baker 2018, published as ODC-PDDL).
"""

import argparse
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from solvers.reconstruction.posture_library import SHIPPED  # noqa: E402
from tests.benchmarks.kinect_pairs import read_pairs  # noqa: E402
from tests.benchmarks.posture_sources import (  # noqa: E402
    cmu_library,
    exercise_library,
    joined,
)


def main() -> None:
    """Read the clips, thin out their postures and save them."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--out", type=Path, default=SHIPPED)
    given = parser.parse_args()
    library = joined(cmu_library(), exercise_library(read_pairs()))
    given.out.parent.mkdir(exist_ok=True)
    library.save(given.out)
    size = given.out.stat().st_size
    print(f"{library.n_postures} of {library.n_seen} postures, {size} bytes: {given.out}")


if __name__ == "__main__":
    main()
