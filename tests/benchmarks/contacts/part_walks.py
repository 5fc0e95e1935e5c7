"""Planted feet of walks against pinned ones and untouched ones, from four kinds of input.

Every method gets the same contacts, detected on what it is given; what is measured in contact
uses those of the untouched capture. Slide: mean horizontal speed of the slower of ankle and
toe joint in contact. Knee: mean and largest change of the knee's angular velocity. Moved: how
far the ankles and, at most, the hips are from where they were given. Error: how far the ankles
are from the untouched capture while they stand. A pin holds the ankle, planting the sole, about
whose heel the ankle may turn: some of its slide is that.
"""

import sys
from collections.abc import Callable, Sequence

import numpy as np

from solvers.arrays import Array, Flags
from solvers.denoising import denoise, learn_filter_bases, plant_feet
from solvers.feet.legs import LegJoints, find_legs
from solvers.motion import Motion, ReachSettings, detect_contacts, forward_kinematics, reach
from solvers.motion.humanoid import SIDES
from solvers.rotations.representations import IDENTITY, angle_between
from solvers.samples import CorruptionSettings, corrupt
from solvers.signals.spikes import find_runs

from ..shared import clips
from ..shared.tables import Scores
from .part_takes import Planter

TRAVEL_RATIO = 1.15
"""The body travels this much farther than the feet carry it, as after a careless retarget."""
LINEAR_EASE = 0.15


def walk_tables(names: Sequence[str]) -> list[str]:
    """Return one table for each kind of input."""
    tables = []
    for title, spoil, step, comparable in INPUTS:
        scores = Scores(f"{title}, {len(names)} CMU walks", "units in the header", "planted")
        for name in names:
            capture = clips.read_cmu(clips.WALKS / f"{name}.bvh", step)
            measure(scores, name, capture, spoil(name, capture), comparable)
        tables.append(scores.markdown())
        print(f"Done: {title}", file=sys.stderr, flush=True)
    return tables


def measure(
    scores: Scores, clip: str, capture: Motion, given: Motion, comparable: bool
) -> None:
    """Plant the feet of one clip in all ways and note the figures."""
    truly, contacts = detect_contacts(capture), detect_contacts(given)
    legs = find_legs(given.skeleton)
    before, wanted = feet_joints(given, legs), feet_joints(capture, legs)
    for method, plant in PLANTERS.items():
        planted = plant(given, contacts)
        after = feet_joints(planted, legs)
        knees = np.stack([_bends(planted, leg) for leg in legs], axis=1)
        change = np.abs(np.diff(knees, n=2, axis=0)) * given.frame_rate**2 / 1000.0
        figures = {
            "slide cm/s": 100.0 * joint_slide(after, truly, given.frame_rate),
            "knee mean 1000 deg/s2": change.mean(),
            "knee worst": change.max(),
            "ankle moved cm": 100.0 * _away(after, before).mean(),
            "at most": 100.0 * _away(after, before).max(),
            "hips moved cm": 100.0 * _hips_moved(planted, given),
        }
        if comparable:
            figures["error in contact cm"] = 100.0 * _away(after, wanted)[truly].mean()
        for column, figure in figures.items():
            scores.add(method, column, clip, float(figure))


def locked(motion: Motion, contacts: Flags) -> Motion:
    """Keep each ankle where its contact begins: what a pin without easing does."""
    return _reaching(motion, locked_ankles(motion, contacts))


def locked_ankles(motion: Motion, contacts: Flags) -> Array:
    """Return the ankles of a pin without easing, (n_frames, n_legs, 3)."""
    return _ankles(motion, contacts, lambda ankle, start, stop: ankle[start] - ankle, 0.0)


def pinned_with_fades(motion: Motion, contacts: Flags) -> Motion:
    """Keep each ankle at its mean in contact; fade linearly before and after."""
    return _reaching(motion, eased_ankles(motion, contacts))


def eased_ankles(motion: Motion, contacts: Flags) -> Array:
    """Return the ankles of a pin with linear easing, (n_frames, n_legs, 3)."""
    return _ankles(
        motion,
        contacts,
        lambda ankle, start, stop: ankle[start:stop].mean(axis=0) - ankle,
        LINEAR_EASE,
    )


def _ankles(
    motion: Motion,
    contacts: Flags,
    shift_to: Callable[[Array, int, int], Array],
    ease: float,
) -> Array:
    poses, frames, targets = forward_kinematics(motion), np.arange(motion.n_frames), []
    for leg in find_legs(motion.skeleton):
        ankle = poses.positions[:, leg.ankle]
        shift = np.zeros_like(ankle)
        for start, stop in find_runs(contacts[:, SIDES.index(leg.side)]):
            outside = (
                np.maximum(start - frames, frames - stop + 1).clip(min=0) / motion.frame_rate
            )
            fade = np.where(
                outside > 0, np.maximum(1.0 - outside / ease, 0.0) if ease else 0.0, 1.0
            )
            held = shift_to(ankle, start, stop)
            held[outside > 0] = np.where(
                (frames < start)[:, None], held[start], held[stop - 1]
            )[outside > 0]
            shift += fade[:, None] * held
        targets.append(ankle + shift)
    return np.stack(targets, axis=1)


def _reaching(motion: Motion, ankles: Array) -> Motion:
    for number, leg in enumerate(find_legs(motion.skeleton)):
        motion = reach(motion, leg.chain, ankles[:, number], ReachSettings(softness=0.0))
    return motion


PLANTERS: dict[str, Planter] = {
    "planted": lambda motion, contacts: plant_feet(motion, contacts).motion,
    "as given": lambda motion, contacts: motion,
    "locked, no easing": locked,
    "locked, linear easing": pinned_with_fades,
}


def _as_it_is(name: str, motion: Motion) -> Motion:
    return motion


def _denoised(name: str, motion: Motion) -> Motion:
    """Noise added and taken out again, with the walks of other people as examples."""
    noisy = corrupt(motion, CorruptionSettings(jitter=3.0, root_jitter=0.005))
    subject = name.split("_")[0]
    walks = clips.walks().items()
    return denoise(
        noisy, learn_filter_bases([walk for key, walk in walks if key.split("_")[0] != subject])
    ).recording


def _swaying(name: str, motion: Motion) -> Motion:
    return corrupt(motion, CorruptionSettings(jitter=0.0, root_sway=0.03))


def _skating(name: str, motion: Motion) -> Motion:
    path = motion.root_positions.copy()
    path[:, :2] += (TRAVEL_RATIO - 1.0) * (path[:, :2] - path[0, :2])
    return motion.with_poses(root_positions=path)


INPUTS: tuple[tuple[str, Callable[[str, Motion], Motion], int, bool], ...] = (
    ("Captures as they are, 120 Hz", _as_it_is, 1, True),
    ("Noise of 3 degrees and 5 mm at 30 Hz, denoised", _denoised, 4, True),
    ("A root that sways by 3 cm, 60 Hz", _swaying, 2, True),
    ("Travel 15 % too long, 60 Hz", _skating, 2, False),
)


def feet_joints(motion: Motion, legs: Sequence[LegJoints]) -> Array:
    """Return ankle and toe joints, (n_frames, 2 feet, 2, 3)."""
    joints = np.array([[leg.ankle, leg.toe or leg.ankle] for leg in legs])
    return forward_kinematics(motion).positions[:, joints]


def joint_slide(feet: Array, contacts: Flags, rate: float) -> float:
    """Return the mean speed of the slower of both joints in contact, m/s."""
    speed = np.linalg.norm(np.diff(feet[..., :2], axis=0), axis=-1).min(axis=-1) * rate
    return float(speed[contacts[1:] & contacts[:-1]].mean())


def _away(a: Array, b: Array) -> Array:
    """Distance of ankles, (n_frames, 2)."""
    return np.asarray(np.linalg.norm(a[:, :, 0] - b[:, :, 0], axis=-1))


def _hips_moved(a: Motion, b: Motion) -> float:
    return float(np.linalg.norm(a.root_positions - b.root_positions, axis=-1).max())


def _bends(motion: Motion, leg: LegJoints) -> Array:
    """Angle of the knee's rotation, degrees."""
    return np.asarray(np.degrees(angle_between(motion.rotations[:, leg.knee], IDENTITY)))
