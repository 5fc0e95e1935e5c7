"""Learn the mixtures of windows that Clean ships, from captures that anyone may use.

    make motion-mixture ARGUMENTS="[--pairs] [--out FILE]"

With `--pairs` that of joints and their parents, otherwise that of joints.

CMU (mocap.cs.cmu.edu, created with funding from NSF EIA-0196217): playground, jumps, punches,
sword, lifting, salsa, walks. No actor or take of `tests/benchmarks/first_press/takes.py` that
is scored, and no development take.
"""

from collections.abc import Iterator

from solvers.denoising.motion_model import SHIPPED, SHIPPED_PAIRS, learn_motion_mixture
from solvers.denoising.motion_model.learn_mixture import FRAME_RATE
from solvers.motion import Motion

from ..benchmarks.first_press.takes import DEVELOPMENT, read_variety, variety_names
from ..benchmarks.shared import clips
from ..benchmarks.shared.clips import every
from .arguments import output_parser, print_progress

ACTORS = ("01_", "02_", "salsa_")
"""Of `cmu_variety`. Subject 03, martial arts and Indian dance are scored."""
WALKERS = ("07", "10", "26", "27", "32")
PHASES = 2
"""Frames between the starts of the clips that a recording at 60 or 120 Hz is split into."""
WORDS = (
    "CMU mocap: playground, jumps, punches, sword, lifting (subjects 01, 02), salsa, walks"
    " (07, 10, 26, 27, 32), 30 Hz"
)


def motions() -> Iterator[Motion]:
    """Return the clips to learn from, at FRAME_RATE."""
    kept_aside = {take.name for take in DEVELOPMENT}
    names = [name for name in variety_names() if name.startswith(ACTORS)]
    takes = [read_variety(name) for name in names if name not in kept_aside]
    takes += [
        clips.read_cmu(path, 1)
        for path in sorted(clips.WALKS.glob("*.bvh"))
        if path.stem[:2] in WALKERS and path.stem not in kept_aside
    ]
    for take in takes:
        step = round(take.frame_rate / FRAME_RATE)
        for phase in range(0, step, PHASES):
            yield every(take.slice(phase, take.n_frames), step)


def main() -> None:
    """Learn, and save where it is shipped."""
    parser = output_parser(__doc__, None)
    parser.add_argument("--pairs", action="store_true")
    chosen = parser.parse_args()
    n_joints, shipped = (2, SHIPPED_PAIRS) if chosen.pairs else (1, SHIPPED)
    mixture = learn_motion_mixture(
        list(motions()), n_joints, trained_on=WORDS, progress=print_progress
    )
    mixture.save(chosen.out or shipped)


if __name__ == "__main__":
    main()
