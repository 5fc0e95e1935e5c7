"""Takes of the first press: settings are chosen on some, the others are scored.

This is the only file that lists them. No actor of HDM05, no walker of CMU, no dance and no take
is in both lists; only martial arts are of one person in both. The takes of HDM05 and of the
corpus are of people whom no prior of Clean learns from.
"""

import tarfile
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from solvers.motion import Motion
from solvers.recordings import read_acclaim, read_bvh

from ..shared import clips

ARCHIVE = clips.DATA / "mocap" / "cmu_variety.tar.xz"
JACKS = clips.DATA / "mocap" / "cmu_jumping_jack"
CORPUS = clips.DATA / "corpus" / "bvh"
UNPACKED = Path(__file__).resolve().parents[3] / "build" / "first_press"
MAX_FRAMES = 240
"""Longer takes end here, so that no take takes most of the time."""


@dataclass(frozen=True)
class Take:
    """A clean recording at a frame rate, from a frame of this rate on."""

    name: str
    rate: int
    first: int = 0

    def __str__(self) -> str:
        return f"{self.name.split('/')[-1]} {self.rate} Hz"


# Settings are chosen on these only.
DEVELOPMENT = (
    Take("HDM_bd_kickLFront1Reps_001", 30),
    Take("02_05", 30, 100),
    Take("martial_03", 30, 10),
    Take("07_03", 30),
    Take("HDM_bd_hopBothLegs1hops_002", 30),
    Take("salsa_02", 30, 60),
    Take("HDM_bd_kickLFront1Reps_003", 60),
    Take("02_05", 60, 700),
    Take("HDM_bd_lieDownFloor_001", 30),
    Take("02_07", 60, 300),
    Take("26_01", 60),
    Take("HDM_bd_jogLeftCircle4StepsRstart_001", 30),
    Take("01_09", 30, 600),
    Take("HDM_bd_rotateArmsBothBackward1Reps_002", 120),
    Take("02_05", 120, 700),
    Take("27_01", 120),
    Take("HDM_bd_throwBasketball_001", 30),
    Take("HDM_bd_squat1Reps_003", 30),
    Take("02_04", 30),
    Take("13_29", 30),
    Take("bandai_namco/dataset-1_run_angry_001", 30),
    Take("bandai_namco/dataset-1_dance-short_normal_001", 30, 1200),
    Take("assimp_boxing_toes/Boxing_Toes", 50, 200),
    Take("HDM_bd_hopBothLegs1hops_005", 60),
    Take("HDM_bd_jogLeftCircle4StepsRstart_002", 60),
    Take("salsa_30", 60, 200),
    Take("01_01", 60, 300),
    Take("dme_xia/angry_13_000", 60),
    Take("HDM_bd_throwBasketball_001", 120),
    Take("HDM_bd_kickLFront1Reps_004", 120),
    Take("HDM_bd_hopBothLegs1hops_009", 120),
    Take("HDM_bd_lieDownFloor_004", 120, 60),
)
# These are scored: no setting may be chosen on them.
SCORED = (
    Take("HDM_bk_kickLFront1Reps_007", 30),
    Take("HDM_dg_kickLFront1Reps_013", 60),
    Take("HDM_bk_throwBasketball_005", 30),
    Take("HDM_bk_throwBasketball_004", 120),
    Take("HDM_bk_hopBothLegs1hops_013", 60),
    Take("HDM_dg_jogLeftCircle4StepsRstart_008", 30),
    Take("HDM_bk_lieDownFloor_005", 30),
    Take("HDM_bk_squat1Reps_013", 60),
    Take("martial_05", 30, 10),
    Take("martial_07", 60, 20),
    Take("martial_08", 30, 10),
    Take("indian_13", 30, 30),
    Take("indian_06", 60, 300),
    Take("35_01", 30),
    Take("29_01", 120),
    Take("05_01", 60),
    Take("49_02", 30, 240),
    Take("49_04", 60),
    Take("03_03", 120, 300),
    Take("03_01", 30),
)
QUICK = DEVELOPMENT[:6]
"""Development takes at 30 Hz, where fast motion has the lowest number of samples."""


@cache
def read(take: Take) -> Motion:
    """Return the take."""
    motion = _read(take.name)
    step = round(motion.frame_rate / take.rate)
    return clips.every(motion, step).slice(
        take.first, min(take.first + MAX_FRAMES, -(-motion.n_frames // step))
    )


@cache
def _read(name: str) -> Motion:
    if name.startswith("HDM"):
        return read_acclaim(clips.HDM05 / f"{name}_120.amc")
    for folder in (clips.WALKS, clips.HOPS):
        if (folder / f"{name}.bvh").exists():
            return _without_thumbs(clips.read_cmu(folder / f"{name}.bvh", 1))
    if "/" in name:
        return read_bvh(CORPUS / f"{name}.bvh")
    if (JACKS / f"{name}.amc").exists():
        return read_acclaim(JACKS / f"{name}.amc", _unpack("asfamc/02.asf"))
    return read_variety(name)


def read_variety(name: str) -> Motion:
    """Return a complete take of the archive: "02_05" (120 Hz) or "salsa_01" (60 Hz)."""
    if name[0].isdigit():
        _unpack(f"asfamc/{name[:2]}.asf")
        return read_acclaim(_unpack(f"asfamc/{name}.amc"))
    motion = read_bvh(_unpack(f"bvh/{name}.bvh"))
    return motion.slice(1, motion.n_frames)


def variety_names() -> list[str]:
    """Return the names of all takes of the archive."""
    with tarfile.open(ARCHIVE) as archive:
        paths = sorted(map(Path, archive.getnames()))
    return [
        path.stem for path in paths
        if path.suffix in (".amc", ".bvh") and path.stem != "standard"
    ]  # fmt: skip


def _without_thumbs(motion: Motion) -> Motion:
    """Hold the thumbs still: in the recordings themselves they jump by half a turn."""
    rotations = motion.rotations.copy()
    thumbs = [index for index, name in enumerate(motion.skeleton.names) if "Thumb" in name]
    rotations[:, thumbs] = rotations[0, thumbs]
    return motion.with_poses(rotations)


def _unpack(member: str) -> Path:
    path = UNPACKED / Path(member).name
    if not path.exists():
        UNPACKED.mkdir(parents=True, exist_ok=True)
        with tarfile.open(ARCHIVE) as archive:
            content = archive.extractfile(f"cmu_variety/{member}")
            assert content is not None
            path.write_bytes(content.read())
    return path
