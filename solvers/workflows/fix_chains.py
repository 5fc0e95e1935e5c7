"""Steps of `fix_take` for each origin of a take, in the order in which they help."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Flags
from ..denoising import Denoised, Planted, PlantSettings, denoise
from ..depth_scene import DepthRecording
from ..markers import Unswapped, find_marker_set, solve_skeleton, unswap_markers
from ..motion import (
    JointRecording,
    Motion,
    Tracks,
    describe_low_confidence,
    explain_roles,
    find_humanoid_map,
    joint_parents,
    motion_from_points,
)
from ..progress import Progress, within
from .depth_capture import CapturedMotion
from .fix_report import MotionFromJoints, Take, TakeOrigin, find_origin
from .motion_from_markers import MarkerMotion, motion_from_markers
from .planting import PlantingResult, plant_feet_if_possible
from .reconstruct_motion import RebuiltMotion, reconstruct_motion
from .reconstruct_recording import ReconstructedMotion, reconstruct_recording
from .standard_joints import standardize_joint_names


@dataclass(frozen=True, eq=False, kw_only=True)
class ChainResult:
    """A fixed take, and the result of each step that ran.

    Attributes
    ----------
    recording : Motion or Tracks
        Without gaps.
    steps : tuple of str
        Sentences for the animator: what was done, and why.
    notices : tuple of str
        Those of the steps that the animator should act on, the most important first.
    """

    recording: Motion | Tracks
    steps: tuple[str, ...]
    notices: tuple[str, ...] = ()
    planted: Planted | None = None
    denoised: Denoised | None = None
    unswapped: Unswapped | None = None
    rebuilt: RebuiltMotion | ReconstructedMotion | None = None
    solved: MarkerMotion | None = None
    captured: CapturedMotion | None = None


def clean_motion(
    motion: Motion,
    planting: PlantSettings | None,
    contacts: Flags | Array | None,
    progress: Progress,
) -> ChainResult:
    """Clean a motion and plant its feet; contacts, if given, have the shape (n_frames, 2)."""
    denoised = denoise(motion, progress=within(progress, 0.0, 0.8))
    assert isinstance(denoised.recording, Motion)
    planting_result = plant_feet_if_possible(
        denoised.recording, planting, contacts, progress=within(progress, 0.8, 1.0)
    )
    is_video = find_origin(motion) is TakeOrigin.VIDEO
    reason = (
        "Such bodies come from video models: Clean removes their jitter."
        if is_video
        else "The take has a skeleton: Clean removes jitter and spikes and fills gaps."
    )
    low_confidence = _low_confidence_of_legs(motion) if planting else []
    return ChainResult(
        recording=planting_result.motion,
        steps=(
            reason,
            *_describe_cleaning(denoised),
            *_describe_planting(planting_result),
            *low_confidence,
        ),
        notices=(*planting_result.remarks, *low_confidence, *_describe_convergence(denoised)),
        planted=planting_result.planted,
        denoised=denoised,
    )


def clean_points(tracks: Tracks, progress: Progress) -> ChainResult:
    """Correct swapped labels of points, and clean them."""
    unswapped = unswap_markers(tracks, progress=within(progress, 0.0, 0.2))
    denoised = denoise(unswapped.tracks, progress=within(progress, 0.2, 1.0))
    missing = ", ".join(find_marker_set(tracks.names).missing_landmarks())
    reason = (
        "The points were cleaned, but a skeleton needs the Plug-in-Gait or CMU markers; missing"
        f" are {missing}."
    )
    swaps = _describe_swaps(len(unswapped.swaps))
    steps = (reason, *swaps, *_describe_cleaning(denoised))
    return ChainResult(
        recording=denoised.recording,
        steps=steps,
        notices=(reason, *_describe_convergence(denoised)),
        denoised=denoised,
        unswapped=unswapped,
    )


def solve_markers(
    tracks: Tracks, planting: PlantSettings | None, progress: Progress
) -> ChainResult:
    """Correct labels, fill gaps, solve the skeleton and plant its feet."""
    solved = motion_from_markers(tracks, progress=within(progress, 0.0, 0.9))
    planting_result = plant_feet_if_possible(
        solved.motion, planting, progress=within(progress, 0.9, 1.0)
    )
    error = 1000.0 * np.nanmean(solved.solved.error)
    n_joints = sum(not name.endswith("_end") for name in solved.motion.skeleton.names)
    n_filled = int(solved.filled.sum())
    steps = [
        f"These are markers of the set {solved.solved.marker_set.name}: a skeleton was solved"
        " from them.",
        *_describe_swaps(len(solved.swaps)),
        *[f"Filled {n_filled} samples of missing markers."] * bool(n_filled),
        f"The skeleton has {n_joints} joints, and the mean marker error is {error:.1f} mm.",
        *_describe_planting(planting_result),
    ]
    return ChainResult(
        recording=planting_result.motion,
        steps=tuple(steps),
        notices=tuple(planting_result.remarks),
        planted=planting_result.planted,
        solved=solved,
    )


def reconstruct_joints(
    recording: JointRecording, planting: PlantSettings | None, progress: Progress
) -> ChainResult:
    """Reconstruct the joints of a camera and plant the feet."""
    rebuilt = reconstruct_recording(recording, planting=planting, progress=progress)
    fraction = float(rebuilt.rebuilt.mean())
    planting_result = PlantingResult(rebuilt.motion, rebuilt.planted, [])
    return ChainResult(
        recording=rebuilt.motion,
        steps=_describe_rebuilding(fraction, rebuilt.remarks, planting_result),
        notices=(*planting_result.remarks, *rebuilt.remarks),
        planted=rebuilt.planted,
        rebuilt=rebuilt,
    )


def reconstruct_tracked(
    tracked: MotionFromJoints,
    planting: PlantSettings | None,
    contacts: Flags | Array | None,
    progress: Progress,
) -> ChainResult:
    """Reconstruct a motion that was solved from the joints of a camera, and plant the feet.

    Contacts, if given, have the shape (n_frames, 2).
    """
    rebuilt = reconstruct_motion(
        tracked.motion,
        source=tracked.source,
        tracking_state=tracked.tracking_state,
        sensor=tracked.sensor,
        resize=tracked.resize,
        progress=within(progress, 0.0, 0.9),
    )
    planting_result = plant_feet_if_possible(
        rebuilt.motion,
        planting,
        contacts,
        reliability=rebuilt.reliability,
        progress=within(progress, 0.9, 1.0),
    )
    return ChainResult(
        recording=planting_result.motion,
        steps=_describe_rebuilding(rebuilt.rebuilt_fraction, rebuilt.remarks, planting_result),
        notices=(*planting_result.remarks, *rebuilt.remarks),
        planted=planting_result.planted,
        rebuilt=rebuilt,
    )


def take_before(take: Take, chain: ChainResult, progress: Progress) -> Motion | Tracks:
    """Return the take as it came, in the form of the result.

    Markers become the skeleton that is solved without correct labels and filled gaps, joints
    of a camera the skeleton that Import makes of them, depth images the tracked body.
    """
    match take:
        case MotionFromJoints():
            return take.motion
        case JointRecording():
            standardized = standardize_joint_names(take)
            return motion_from_points(standardized.tracks, joint_parents(standardized.names))
        case DepthRecording():
            assert chain.captured is not None
            return chain.captured.motion
        case Tracks() if chain.solved is not None:
            if chain.solved.swaps or chain.solved.filled.any():
                return solve_skeleton(take, progress=progress).motion
            return chain.solved.solved.motion
        case _:
            return take


def _describe_cleaning(denoised: Denoised) -> list[str]:
    # The first sentence says that there are no examples. No take here has any.
    _, _, remarks = denoised.prior_used.partition(". ")
    return [*[remarks] * bool(remarks), *_describe_convergence(denoised)]


def _describe_convergence(denoised: Denoised) -> list[str]:
    unfinished = "Clean stopped before the result converged; press Clean on a shorter range."
    return [] if denoised.converged else [unfinished]


def _low_confidence_of_legs(motion: Motion) -> list[str]:
    """Return what is uncertain about legs whose feet are to be planted."""
    humanoid = find_humanoid_map(motion.skeleton)
    evidence = explain_roles(motion.skeleton, humanoid)
    legs = {r: each for r, each in evidence.items() if "Leg" in r or r.endswith("Foot")}
    return list(filter(None, [describe_low_confidence(humanoid, legs)]))


def _describe_rebuilding(
    fraction: float, remarks: Sequence[str], planting_result: PlantingResult
) -> tuple[str, ...]:
    return (
        "A depth camera measured the joints: Reconstruct rebuilds and smooths them, so Clean"
        " was not needed.",
        f"Rebuilt {100.0 * fraction:.1f} % of the joint samples.",
        *remarks,
        *_describe_planting(planting_result),
    )


def _describe_planting(planting_result: PlantingResult) -> list[str]:
    planted, remarks = planting_result.planted, planting_result.remarks
    if planted is None:
        return remarks
    feet, hands, knees, hips = np.split(planted.all_contacts.any(axis=0), (2, 4, 6))
    if hands.any():
        text = (
            "Plant Feet keeps feet, hands and knees on the floor in place by moving legs, arms"
            " and hips."
        )
    elif knees.any():
        text = "Plant Feet keeps feet and knees on the floor in place by moving legs and hips."
    elif hips.any():
        text = (
            "Plant Feet keeps feet and hips on the floor in place by moving legs and hips."
            if feet.any()
            else "Plant Feet keeps hips on the floor in place by moving the body."
        )
    elif feet.any():
        text = "Plant Feet keeps planted feet in place by moving legs and hips."
    else:
        text = "No foot stands in this take, so Plant Feet changed nothing."
    return [text, *remarks]


def _describe_swaps(n_swaps: int) -> list[str]:
    if n_swaps == 1:
        return ["Corrected 1 swapped label."]
    return [f"Corrected {n_swaps} swapped labels."] if n_swaps else []
