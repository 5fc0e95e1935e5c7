"""Solve of the button Clean: denoise each part of a take, then plant feet.

The slow part, `solve`, depends neither on how strongly the result is applied nor on the feet:
what it returns is kept, so that the redo panel has only `finish` to repeat.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ...solvers.arrays import Array
from ...solvers.denoising import (
    PART_STRENGTHS,
    Denoised,
    DenoiseSettings,
    Planted,
    PlantSettings,
    Quality,
    clamp_to_limits,
    denoise,
    measure_quality,
    plant_feet,
)
from ...solvers.feet import find_legs, find_supports
from ...solvers.markers import Swap, unswap_markers
from ...solvers.motion import (
    JointLimits,
    Motion,
    Tracks,
    describe_low_confidence,
    explain_roles,
    find_humanoid_map,
    joint_parts,
)
from ...solvers.progress import Progress, unwatched, within
from ...solvers.rotations import angle_between, slerp
from .example_source import ExampleSource

Recordings = tuple[Motion | Tracks, ...]

MIN_CHANGE = 1e-6
"""Radians or meters that are only rounding: planting has not changed such joints."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Problem:
    """All that the slow part depends on."""

    recordings: Recordings
    """The body first."""
    settings: DenoiseSettings
    examples: ExampleSource = ExampleSource()
    learn_limits: bool = False
    """Whether joint limits are learned from the examples too."""
    unswap: bool = False
    """Whether labels of markers are corrected first."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Finish:
    """Settings that apply a solution to the take."""

    strengths: Mapping[str, Array]
    """Fraction of the estimate at each frame, shape (n_frames,), 0 to 1: of all joints and
    points (`strength`), and the factor of each part of the body, by the names of the settings.
    Gaps are filled at any strength."""
    keyed: tuple[str, ...]
    """Names of those strengths that keys in the scene set."""
    ease: Array
    """Blend weights, shape (n_frames,): below 1 only next to frames outside the range."""
    chosen: frozenset[str]
    """Names of joints and points to change."""
    present: Recordings | None = None
    """Earlier result for the other joints; None keeps them as recorded."""
    limits: JointLimits | None = None
    """Of the rig."""
    planting: PlantSettings | None = None
    """None leaves the feet alone."""
    contacts: Array | None = None
    """Contacts that the animator keyed, shape (n_frames, 7); NaN where they are detected."""


@dataclass(frozen=True, eq=False)
class Solution:
    """Each recording of the problem, denoised at full strength."""

    denoised: tuple[Denoised, ...]
    limits: JointLimits | None
    """Joint limits of the examples."""
    unswapped: Tracks | None = None
    """The markers, if labels were corrected."""
    swaps: tuple[Swap, ...] = ()

    def recordings_of(self, problem: Problem) -> Recordings:
        """Return the recordings of the problem, except for corrected labels."""
        body, *other_trees = problem.recordings
        return (self.unswapped or body, *other_trees)


@dataclass(frozen=True, eq=False)
class Cleaned:
    """Recordings to write, and figures to report."""

    recordings: Recordings
    moved: frozenset[str]
    """Names of the joints that changed: those chosen, and those that planted the feet."""
    solution: Solution
    planted: Planted | None
    before: Quality
    """Of the recording, its feet measured at the contacts at which they were planted."""
    after: Quality
    low_confidence: str = ""
    """A sentence about roles that planted the feet, if any has low confidence."""
    keyed: tuple[str, ...] = ()
    """Names of the strengths that keys in the scene set."""


def names_of(recording: Motion | Tracks) -> tuple[str, ...]:
    """Return the names of the joints or points."""
    return recording.names if isinstance(recording, Tracks) else recording.skeleton.names


def solve(problem: Problem, *, progress: Progress = unwatched) -> Solution:
    """Denoise the body with the examples' patterns, and all else with the take's own."""
    body, *other_trees = problem.recordings
    unswapped = None
    if problem.unswap and isinstance(body, Tracks):
        unswapped = unswap_markers(body, progress=within(progress, 0.0, 0.2))
        body = unswapped.tracks
    learned = problem.examples.learned(body, problem.learn_limits, within(progress, 0.2, 0.3))
    settings = problem.settings.at_full_strength()
    result = denoise(
        body,
        learned.bases,
        limits=learned.limits,
        settings=settings,
        progress=within(progress, 0.3, 0.8),
    )
    results = [replace(result, prior_used=f"{learned.message} {result.prior_used}".strip())]
    for index, recording in enumerate(other_trees):
        weight = (
            0.8 + 0.2 * index / len(other_trees),
            0.8 + 0.2 * (index + 1) / len(other_trees),
        )
        results.append(
            denoise(recording, settings=settings, progress=within(progress, *weight))
        )
    swapped = (unswapped.tracks, unswapped.swaps) if unswapped and unswapped.swaps else ()
    return Solution(tuple(results), learned.limits, *swapped)


def clean(
    problem: Problem,
    finish: Finish,
    solution: Solution | None = None,
    *,
    progress: Progress = unwatched,
) -> Cleaned:
    """Solve the problem, unless its solution is given, and finish it.

    The estimate is mixed with the recording, held within the joints' limits, and its feet are
    planted. How far the feet slid, before and after, is in `planted`.
    """
    if solution is None:
        solution = solve(problem, progress=within(progress, 0.0, 0.8))
    estimates = [each.recording for each in solution.denoised]
    recordings = solution.recordings_of(problem)
    body, *other_trees = map(
        partial(_mixed, finish=finish, part_of=_bone_parts(recordings[0], finish)),
        recordings,
        finish.present or recordings,
        estimates,
    )
    moved, planted = finish.chosen, None
    if isinstance(body, Motion):
        for limits in (finish.limits, solution.limits):
            body = body if limits is None else clamp_to_limits(body, limits)
        planted = _planted(body, finish, within(progress, 0.8, 0.9))
        if planted is not None:
            eased = blend_motions(body, planted.motion, finish.ease[:, None])
            moved |= changed_joints(body, eased)
            body = eased
            planted = replace(planted, motion=body)
    contacts = None if planted is None else planted.contacts
    before, after = (
        measure_quality(each, contacts=contacts, progress=within(progress, start, start + 0.05))
        for each, start in ((problem.recordings[0], 0.9), (body, 0.95))
    )
    marked = _low_confidence_of_legs(body, finish)
    return Cleaned(
        (body, *other_trees), moved, solution, planted, before, after, marked, finish.keyed
    )


def _low_confidence_of_legs(body: Motion | Tracks, finish: Finish) -> str:
    """Return remarks on the low confidence of the legs whose feet are planted."""
    if isinstance(body, Tracks) or finish.planting is None:
        return ""
    if find_legs(body.skeleton) and not _chosen_legs(body, finish):
        return ""
    humanoid = find_humanoid_map(body.skeleton)
    evidence = explain_roles(body.skeleton, humanoid)
    legs = {r: each for r, each in evidence.items() if "Leg" in r or r.endswith("Foot")}
    return describe_low_confidence(humanoid, legs)


def _planted(body: Motion, finish: Finish, progress: Progress) -> Planted | None:
    """Plant the feet and hands of a body whose limbs were chosen."""
    planting = finish.planting
    if planting is None or not _chosen_legs(body, finish):
        return None
    if not _arms(body) <= finish.chosen:
        planting = replace(planting, hands_and_knees=False)
    return plant_feet(body, finish.contacts, settings=planting, progress=progress)


def _arms(body: Motion) -> set[str]:
    """Return the joints that rotate where hands are held in place."""
    found = find_supports(body.skeleton, find_humanoid_map(body.skeleton))
    arms = [joint for each in found if each.is_arm for joint in each.chain]
    return {body.skeleton.names[joint] for joint in arms}


def _chosen_legs(body: Motion, finish: Finish) -> set[str]:
    """Return the chosen joints of the legs."""
    legs = find_legs(body.skeleton)
    joints = {body.skeleton.names[joint] for leg in legs for joint in (leg.hip, leg.knee)}
    return joints & finish.chosen


def _bone_parts(body: Motion | Tracks, finish: Finish) -> dict[str, str]:
    """Return the part of the body of each bone, if any part has a strength of its own.

    Bones outside the body, such as props, have none.
    """
    if isinstance(body, Tracks) or all(
        (finish.strengths[name] == 1.0).all() for name in PART_STRENGTHS.values()
    ):
        return {}
    return dict(zip(body.skeleton.names, joint_parts(body.skeleton), strict=True))


def _strengths(names: Sequence[str], finish: Finish, part_of: Mapping[str, str]) -> Array:
    """Return the strength of each joint or point at each frame, shape (n_frames, n_joints)."""
    strengths = np.tile(finish.strengths["strength"][:, None], len(names))
    for index, name in enumerate(names):
        if name in part_of:
            strengths[:, index] *= finish.strengths[PART_STRENGTHS[part_of[name]]]
    return strengths


def _mixed(
    raw: Motion | Tracks,
    present: Motion | Tracks,
    clean: Motion | Tracks,
    *,
    finish: Finish,
    part_of: Mapping[str, str],
) -> Motion | Tracks:
    """Blend from the recording to the estimate; gaps take the estimate alone."""
    names = names_of(raw)
    chosen = np.array([name in finish.chosen for name in names])
    weight = _strengths(names, finish, part_of) * finish.ease[:, None] * chosen
    match raw, present, clean:
        case Tracks(), Tracks(), Tracks():
            start = np.where(chosen[:, None], raw.positions, present.positions)
            start = _fill_missing(start, clean.positions)
            return clean.with_positions(start + weight[..., None] * (clean.positions - start))
        case Motion(), Motion(), Motion():
            rotations = np.where(chosen[:, None], raw.rotations, present.rotations)
            root_positions = raw.root_positions if chosen[0] else present.root_positions
            poses = clean.with_poses(
                _fill_missing(rotations, clean.rotations),
                _fill_missing(root_positions, clean.root_positions),
            )
            return blend_motions(poses, clean, weight)
    raise TypeError(f"{type(raw)}, {type(present)} and {type(clean)} cannot be blended")


def blend_motions(start: Motion, stop: Motion, weight: Array) -> Motion:
    """Blend two motions by a weight, shape (n_frames, n_joints or 1)."""
    moved = start.root_positions + weight[:, :1] * (stop.root_positions - start.root_positions)
    return start.with_poses(slerp(start.rotations, stop.rotations, weight), moved)


def _fill_missing(values: Array, otherwise: Array) -> Array:
    return np.where(np.isfinite(values).all(axis=-1, keepdims=True), values, otherwise)


def changed_joints(before: Motion, after: Motion) -> frozenset[str]:
    """Return the names of the joints that rotated, or of the root if it moved."""
    changed = np.abs(angle_between(before.rotations, after.rotations)).max(axis=0) > MIN_CHANGE
    changed[0] |= np.abs(before.root_positions - after.root_positions).max() > MIN_CHANGE
    names = before.skeleton.names
    return frozenset(
        name for name, is_changed in zip(names, changed, strict=True) if is_changed
    )
