"""Fix a take of any origin with the steps that suit it, and measure what they gained."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..arrays import Array, Flags
from ..denoising import PlantSettings, measure_at_contacts
from ..depth_scene import DepthRecording
from ..depth_tracking.tracking import PoseCallback, ignore_pose
from ..errors import InvalidMotionError
from ..motion import JointLimits, JointRecording, Motion, Tracks
from ..motion.humanoid import SIDES
from ..physics import NoPhysicsError, simulate
from ..progress import Progress, unwatched, within
from ..recordings.conventions import question_of_size
from ..settings import Settings, setting
from .fix_chains import (
    ChainResult,
    clean_motion,
    clean_points,
    reconstruct_joints,
    reconstruct_tracked,
    solve_markers,
    take_before,
)
from .fix_depth import track_depth
from .fix_report import (
    MotionFromJoints,
    Take,
    TakeFigures,
    TakeOrigin,
    describe_empty_frames,
    describe_missing_points,
    drop_missing_points,
    find_origin,
    measure_take,
)

FIXED, COMPARED, MEASURED = 0.7, 0.8, 0.9
"""Fractions of the time until the take is fixed, until there is what to compare it with, and
until the result is measured. Measured on a walk of 8 s; they only move the progress bar."""


NO_BODY = "Physics was skipped: points without a skeleton have no body."


@dataclass(frozen=True, kw_only=True)
class FixSettings(Settings):
    """Choices of an animator who wants none of the others."""

    plant_feet: bool = setting(
        True, "Keep planted feet from sliding by moving legs and hips slightly"
    )
    physics: bool = setting(
        False, "Finish with a simulated body with weight and muscles; takes longer"
    )


@dataclass(frozen=True, eq=False)
class FixedTake:
    """A fixed take, what was done, and how it was before and after.

    Attributes
    ----------
    origin : TakeOrigin
    chain : ChainResult
        The fixed recording, and the result of each step.
    before, after : TakeFigures
        Of the take as it came and of the result: the slide of the feet at the same contacts,
        and the issues that Check lists of either.
    missing : tuple of str
        Sentences on markers and frames without any data, and what was done about them.
    size_question : str
        Asks whether an actor of an odd size is right; otherwise empty.
    """

    origin: TakeOrigin
    chain: ChainResult
    before: TakeFigures
    after: TakeFigures
    missing: tuple[str, ...] = ()
    size_question: str = ""

    @property
    def recording(self) -> Motion | Tracks:
        """The fixed take: a motion, or points where no skeleton is known; without gaps."""
        return self.chain.recording

    @property
    def steps(self) -> tuple[str, ...]:
        """Sentences for the animator: what was done, why, and what to look at."""
        return self.describe_steps()

    def describe_steps(self, frames: Sequence[float] | None = None) -> tuple[str, ...]:
        """Return `steps` with the numbers of frames of a timeline; by default from 1."""
        size = [self.size_question] if self.size_question else []
        denoised = self.chain.denoised
        poses = denoised.describe_separate_poses(frames) if denoised else ""
        kept = [poses] if poses else []
        steps = (*self.chain.steps, *self._spikes_and_gaps, *kept)
        return (*size, *steps, *self.missing, *self._spikes_left)

    @property
    def headline(self) -> str:
        """The most important sentence of `steps` for the animator to act on, or nothing."""
        size = [self.size_question] if self.size_question else []
        notices = (*size, *self.chain.notices, *self.missing, *self._spikes_left)
        return notices[0] if notices else ""

    @property
    def _spikes_and_gaps(self) -> list[str]:
        """Counts of Check, as in the figures: Clean takes other samples for errors."""
        if self.chain.denoised is None:
            return []
        n_spikes, n_gaps = (
            f"{getattr(self.before, name)} → {getattr(self.after, name)}"
            for name in ("n_spikes", "n_gaps")
        )
        return [f"Spikes {n_spikes}, gaps {n_gaps}."]

    @property
    def _spikes_left(self) -> list[str]:
        n_left = self.after.n_spikes
        if self.chain.denoised is None or not n_left:
            return []
        if n_left == 1:
            return ["1 spike is left, classified as fast movement; Check lists it."]
        return [f"{n_left} spikes are left, classified as fast movement; Check lists them."]

    def figures(self, frames: Sequence[float] | None = None) -> dict[str, Any]:
        """Return the report as JSON-ready values; `frames` as in `describe_steps`."""
        return {
            "origin": self.origin.value,
            "headline": self.headline,
            "steps": list(self.describe_steps(frames)),
            "before": self.before.figures(),
            "after": self.after.figures(),
        }


def fix_take(
    recording: Take,
    *,
    settings: FixSettings = FixSettings(),
    contacts: Flags | Array | None = None,
    limits: JointLimits | None = None,
    on_pose: PoseCallback = ignore_pose,
    progress: Progress = unwatched,
) -> FixedTake:
    """Fix a take with the steps that suit its origin, all with their default settings.

    A skeleton is cleaned, and its feet are planted. Joints of a depth camera are reconstructed:
    on 53 takes of UI-PRMD a clean on top leaves the error at 1.6 cm and doubles the jerk, so
    there is none. Optical markers get correct labels, filled gaps, a skeleton and planted feet;
    points of no known marker set are only cleaned. Points that are never observed are left out.
    In depth images a body is tracked, cleaned and planted. On request, a simulated body makes
    the motion at the end.

    Parameters
    ----------
    recording : Motion, Tracks, JointRecording, MotionFromJoints or DepthRecording
        NaN where nothing was observed.
    settings : FixSettings
    contacts : bool or float, shape (n_frames, 2) or (n_frames, 7)
        Contacts as keyed by an animator, for motions; detected by default, and where NaN.
    limits : JointLimits
        Joints beyond them count as issues; nothing is clamped.
    on_pose : OnPose
        Called with each pose as soon as it is tracked in depth images.
    progress : Progress

    Returns
    -------
    FixedTake
        `recording` is not modified.

    Raises
    ------
    InvalidMotionError
        Nothing is observed, or no body is recognized in the joints or images of a camera.
    SolveCancelled
        Raised by `progress`.
    """
    planting = PlantSettings() if settings.plant_feet else None
    recording, never_observed = drop_missing_points(recording)
    n_steps = 2 if settings.physics else 1
    step = within(progress, 0.0, FIXED / n_steps)
    chain = _fix(recording, planting, contacts, on_pose, step)
    if settings.physics:
        chain = _simulate(chain, within(progress, FIXED / n_steps, FIXED))
    start = take_before(recording, chain, within(progress, FIXED, COMPARED))
    given = _complete_contacts(contacts)
    compared = given if chain.planted is None else chain.planted.contacts
    step = within(progress, COMPARED, MEASURED)
    after = measure_take(chain.recording, contacts=compared, limits=limits, progress=step)
    if compared is None and after.quality.feet:
        compared = np.stack([foot.contact for foot in after.quality.feet], axis=1)
    step = within(progress, MEASURED, 1.0)
    before = measure_take(start, contacts=given, limits=limits, progress=step)
    if compared is not None:
        before = replace(before, quality=measure_at_contacts(before.quality, start, compared))
    missing = (describe_missing_points(never_observed), describe_empty_frames(recording))
    return FixedTake(
        find_origin(recording), chain, before, after, tuple(filter(None, missing)), _size(start)
    )


def _simulate(chain: ChainResult, progress: Progress) -> ChainResult:
    """Let a simulated body make the motion, where there is a body that it can be."""
    motion, sentence = chain.recording, NO_BODY
    if isinstance(motion, Motion):
        try:
            simulated = simulate(motion, progress=progress)
        except (InvalidMotionError, NoPhysicsError) as error:
            sentence = f"Physics was skipped. {error}"
        else:
            steps = (*chain.steps, f"Physics was applied. {simulated.message}")
            return replace(chain, recording=simulated.motion, steps=steps)
    steps, notices = (*chain.steps, sentence), (*chain.notices, sentence)
    return replace(chain, steps=steps, notices=notices)


def _size(start: Motion | Tracks) -> str:
    question = question_of_size(start)
    return f"{question}." if question else ""


def _complete_contacts(contacts: Flags | Array | None) -> Flags | None:
    """Return the contacts of both feet, (n_frames, 2), if they are given in all frames."""
    if contacts is None or np.isnan(contacts[:, : len(SIDES)]).any():
        return None
    return np.asarray(contacts[:, : len(SIDES)] != 0.0)


def _fix(
    recording: Take,
    planting: PlantSettings | None,
    contacts: Flags | Array | None,
    on_pose: PoseCallback,
    progress: Progress,
) -> ChainResult:
    match recording:
        case Motion():
            return clean_motion(recording, planting, contacts, progress)
        case MotionFromJoints():
            return reconstruct_tracked(recording, planting, contacts, progress)
        case JointRecording():
            return reconstruct_joints(recording, planting, progress)
        case DepthRecording():
            return track_depth(recording, planting, on_pose, progress)
        case Tracks() if find_origin(recording) is TakeOrigin.MARKERS:
            return solve_markers(recording, planting, progress)
        case Tracks():
            return clean_points(recording, progress)
