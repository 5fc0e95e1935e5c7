"""Build the posture library that is shipped, from captures that anyone may use (CMU).

    python .ci/train_postures.py ../shared/data/mocap

The data used in this project was obtained from mocap.cs.cmu.edu. The database was created with
funding from NSF EIA-0196217.
"""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from solvers.motion import Motion  # noqa: E402
from solvers.reconstruction.posture_library import (  # noqa: E402
    SHIPPED,
    PostureLibrarySettings,
    build_posture_library,
)
from solvers.recordings import read_acclaim, read_bvh  # noqa: E402

CMU_METRES = 0.0254 / 0.45
FOLDERS = ("cmu_walk", "cmu_hop")
EXERCISES = ("13_29", "13_30")
"""Jumping jacks, twists, bends and squats."""
WORDS = "CMU mocap: walks, hops, runs, jumps and exercises"
SETTINGS = PostureLibrarySettings(spacing=0.012, n_postures=2500)


def main(folder: Path) -> None:
    """Read the clips, thin out their postures and save them where they are shipped."""
    motions = [
        _without_t_pose(read_bvh(path, scale=CMU_METRES))
        for part in FOLDERS
        for path in sorted((folder / part).glob("*.bvh"))
    ]
    motions += [
        read_acclaim(folder / "cmu_jumping_jack" / f"{name}.amc", folder / "05.asf")
        for name in EXERCISES
    ]
    library = build_posture_library(motions, settings=SETTINGS, trained_on=WORDS)
    SHIPPED.parent.mkdir(exist_ok=True)
    library.save(SHIPPED)
    size = SHIPPED.stat().st_size
    print(f"{library.n_postures} of {library.n_seen} postures, {size} bytes: {SHIPPED}")


def _without_t_pose(motion: Motion) -> Motion:
    return motion.slice(1, motion.n_frames)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
