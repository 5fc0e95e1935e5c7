"""Learn how the joints of a body move together, which Clean ships for limbs that are missing.

    make body-relation ARGUMENTS="[--out FILE]"

The recordings are those of the motion mixture (`train_motion_mixture.py`): CMU only, no scored
person and no development take.
"""

import argparse
from pathlib import Path

from solvers.denoising.limb_gaps import SHIPPED, learn_body_relation

from .train_motion_mixture import WORDS, motions


def main() -> None:
    """Learn, and save where it is shipped."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--out", type=Path, default=SHIPPED)
    given = parser.parse_args()
    learn_body_relation(motions(), trained_on=WORDS).save(given.out)


if __name__ == "__main__":
    main()
