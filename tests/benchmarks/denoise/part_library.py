"""Examples that a library finds for a take, against those that a person picks for it.

The mixed library holds all clips there are, of HDM05 and of CMU (walks, hops, runs and jumps),
less those of the person who is cleaned. Picked by hand are the other persons' clips of the same
movement. Irrelevant is a library of other movements: on the floor and with the arms for those
who go, those who go for all others.
"""

from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass
from functools import cache, lru_cache

from solvers.arrays import Array
from solvers.denoising import FilterBases, denoise, learn_filter_bases
from solvers.motion import Motion
from solvers.retrieval import Clip, ClipEntry, ClipLibrary, build_clip_library
from solvers.workflows import clean_from_library

from ..shared import clips
from ..shared.noise import angle_error, learn_channels
from ..shared.tables import Scores
from .cases import Case, Level
from .part_classes import SHORT
from .part_gaps import Filler, Gap, cut, score

WALK = "walk"
GOING = (WALK, "jogLeftCircle4StepsRstart", "sneak2StepsLStart", "hopBothLegs1hops")
STAYING = ("lieDownFloor", "rotateArmsBothBackward1Reps", "throwBasketball", "squat1Reps")
LEVELS = (Level(3.0), Level(3.0, 0.10))
GAPS = Gap("left leg", ("LeftUpLeg",), 1.0), Gap("left leg", ("lfemur",), 1.0)
"""The same limb, as CMU's BVH and HDM05 name it."""
PICKED, MIXED, ALL = "picked by hand", "mixed library", "all of it, unsearched"
IRRELEVANT, NONE = "irrelevant library", "no examples"


@dataclass(frozen=True, eq=False)
class Take:
    """A clip to be cleaned."""

    kind: str
    name: str
    """In the library."""

    @property
    def person(self) -> str:
        """With what the names of all clips of the same person begin, after the kind."""
        return person(self.name)


def person(name: str) -> str:
    """Return who is seen in a clip, from "kind subject_number"."""
    return name.split(" ")[1].split("_")[0]


@cache
def everything() -> dict[str, Motion]:
    """Return all clips at 30 Hz, by "kind subject_number"."""
    found = {f"{WALK} {name}": motion for name, motion in clips.walks().items()}
    found |= {f"cmu {name}": motion for name, motion in clips.hops().items()}
    for kind in clips.hdm05_classes():
        found |= {f"{kind} {name}": motion for name, motion in clips.hdm05(kind).items()}
    return found


@cache
def library(kinds: tuple[str, ...] = ()) -> ClipLibrary:
    """Return a library of all clips, or of those of some kinds."""
    return build_clip_library(
        Clip(name, motion)
        for name, motion in everything().items()
        if not kinds or name.split(" ")[0] in kinds
    )


def fetch(entry: ClipEntry) -> Motion:
    """Return the motion of a clip."""
    return everything()[entry.name]


def takes(n_clips: int, dev: bool) -> Iterator[Take]:
    """Yield so many clips of each kind, of persons to develop on or of the others."""
    for kind in (WALK, *clips.hdm05_classes()):
        theirs = clips.DEV_SUBJECTS | clips.DEV_ACTORS
        found = [
            name for name in everything()
            if name.startswith(f"{kind} ") and (person(name) in theirs) == dev
        ]  # fmt: skip
        step = max(len(found) // n_clips, 1)
        for name in found[::step][:n_clips]:
            yield Take(kind, name)


def picked(take: Take) -> tuple[Motion, ...]:
    """Return the other persons' clips of the same movement."""
    return tuple(
        motion for name, motion in everything().items()
        if name.startswith(f"{take.kind} ") and person(name) != take.person
    )  # fmt: skip


def same_person(take: Take) -> tuple[str, ...]:
    """Return the names of all clips of the person."""
    return tuple(name for name in everything() if person(name) == take.person)


Cleaner = Callable[[Motion], Motion]


def cleaners(take: Take) -> dict[str, Cleaner]:
    """Return every way to come by examples."""
    away = same_person(take)
    others = STAYING if take.kind in GOING else GOING

    def from_library(shelf: ClipLibrary) -> Cleaner:
        return lambda noisy: _motion(
            clean_from_library(noisy, shelf, ignore=away, fetch=fetch).recording
        )

    return {
        PICKED: lambda noisy: _motion(denoise(noisy, _learned(picked(take))).recording),
        MIXED: from_library(library()),
        ALL: lambda noisy: _motion(denoise(noisy, _learned_of_all(away)).recording),
        IRRELEVANT: from_library(library(others)),
        NONE: lambda noisy: _motion(denoise(noisy).recording),
    }


def compare_libraries(n_clips: int, dev: bool, unsearched: bool) -> list[Scores]:
    """Return mean angles between cleaned and true rotations, for each way and corruption.

    To learn from all clips, `unsearched`, takes minutes for each person who is left out.
    """
    unit = "geodesic angle of local rotations, degrees"
    titles = [f"Examples from a library, {level}" for level in LEVELS]
    found = [Scores(title, unit, ours=MIXED) for title in titles]
    gone = Scores("Examples from a library, left leg lost for 1 s", unit, ours=MIXED)
    for take in takes(n_clips, dev):
        training, truth = picked(take), everything()[take.name]
        channels = learn_channels(training)
        column = SHORT.get(take.kind, take.kind)
        for name, clean in cleaners(take).items():
            if name == ALL and not unsearched:
                continue
            for scores, level in zip(found, LEVELS, strict=True):
                case = Case(take.name, level, truth, training, channels)
                error = angle_error(clean(case.noisy_motion), truth, channels.joints).mean()
                scores.add(name, column, take.name, float(error), follows=False)
            case = Case(take.name, Level(0.0), truth, training, channels)
            gap = GAPS[take.kind != WALK]
            if truth.n_frames > 1.5 * gap.seconds * truth.frame_rate:
                missing = cut(case, gap, 0)
                error = score(case, _filler(clean, *missing), *missing)
                gone.add(name, column, take.name, error, follows=False)
        print(f"  {take.name} from libraries", flush=True)
    for scores in (*found, gone):
        scores.add_overall()
    return [*found, gone]


def _filler(clean: Cleaner, joints: Collection[int], frames: slice) -> Filler:
    """Return what fills a gap, given to the cleaner as rotations that are not known."""

    def fill(case: Case, gapped: Array) -> Array:
        rotations = case.truth.rotations.copy()
        rotations[frames, list(joints)] = float("nan")
        return case.values(clean(case.truth.with_poses(rotations)))

    return fill


@lru_cache(maxsize=2)
def _learned(training: tuple[Motion, ...]) -> FilterBases:
    return learn_filter_bases(training)


@lru_cache(maxsize=8)
def _learned_of_all(away: tuple[str, ...]) -> FilterBases:
    return learn_filter_bases([
        motion for name, motion in everything().items() if name not in away
    ])  # fmt: skip


def _motion(recording: object) -> Motion:
    assert isinstance(recording, Motion)
    return recording
