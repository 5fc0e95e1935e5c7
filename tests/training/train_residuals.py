"""Learn the residual prior that is shipped, from UI-PRMD (published as ODC-PDDL).

    make residuals ARGUMENTS="[--out FILE]"
    make residuals ARGUMENTS=--confidence   # only how far the shipped one is believed

Vakanski, Jun, Paul, Baker (2018). A data set of human body movements for physical
rehabilitation exercises. Data 3(1). doi:10.3390/data3010002
"""

from dataclasses import replace

import numpy as np

from solvers.reconstruction import (
    ResidualPrior,
    ResidualPriorSettings,
    learn_residual_prior,
    load_residual_prior,
)
from solvers.reconstruction.reconstruct import SHIPPED_PRIOR
from solvers.reconstruction.residual_correction.learn_confidence import calibrate_confidence

from ..benchmarks.reconstruction.kinect_pairs import read_pairs
from .arguments import output_parser, print_progress

SETTINGS = ResidualPriorSettings(local_points=30, pose_points=60)
WORDS = "UI-PRMD: ten exercises by five actors, Kinect v2 against markers"


def main() -> None:
    """Learn from all takes and save, by default where it is shipped, in single precision.

    Its confidence is learned by leaving out one actor after another.
    """
    parser = output_parser(__doc__, SHIPPED_PRIOR)
    parser.add_argument("--confidence", action="store_true")
    given = parser.parse_args()
    taken = [pair for pair in read_pairs() if pair.matched]
    pairs = [(pair.kinect, pair.truth) for pair in taken]
    actors = [pair.subject for pair in taken]
    if given.confidence:
        prior = load_residual_prior(SHIPPED_PRIOR)
    else:
        prior = learn_residual_prior(
            pairs, actors=actors, settings=SETTINGS, progress=print_progress
        )
    prior = calibrate_confidence(prior, pairs, actors, progress=print_progress)
    small(prior).save(given.out)
    print(f"{len(prior.joints)} joints, {given.out.stat().st_size} bytes: {given.out}")
    print(f"shift, slope and spread: {prior.calibration.tolist()}")


def small(prior: ResidualPrior) -> ResidualPrior:
    """Return the same in single precision, and the many points in half of it."""
    names = ("mean_pose", "components", "local_points", "pose_points", "means", "covariances")
    return replace(
        prior,
        source=np.array(WORDS),
        movement=prior.movement
        and replace(prior.movement, points=prior.movement.points.astype(np.float16)),
        **{name: getattr(prior, name).astype(np.float32) for name in names},
    )


if __name__ == "__main__":
    main()
