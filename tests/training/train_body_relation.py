"""Learn how the joints of a body move together, which Clean ships for limbs that are missing.

    make body-relation ARGUMENTS="[--out FILE]"

The recordings are those of the motion mixture (`train_motion_mixture.py`): CMU only, no scored
person and no development take.
"""

from solvers.denoising.limb_gaps import SHIPPED, learn_body_relation

from .arguments import parse_output
from .train_motion_mixture import WORDS, motions


def main() -> None:
    """Learn, and save where it is shipped."""
    out = parse_output(__doc__, SHIPPED)
    learn_body_relation(motions(), trained_on=WORDS).save(out)


if __name__ == "__main__":
    main()
