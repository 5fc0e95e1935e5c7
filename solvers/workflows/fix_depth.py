"""Step of `fix_take` for depth images: track the actor, then clean as any skeleton."""

from ..denoising import PlantSettings
from ..depth_scene import DepthRecording
from ..depth_tracking.tracking import PoseCallback
from ..progress import Progress, within
from .depth_capture import CapturedMotion, capture_recording
from .fix_chains import ChainResult, clean_motion

TRACKED_FRACTION = 0.9
"""Fraction of the time until the actor is tracked. Measured on 6 images; it only moves the
progress bar."""


def track_depth(
    recording: DepthRecording,
    planting: PlantSettings | None,
    on_pose: PoseCallback,
    progress: Progress,
) -> ChainResult:
    """Fit a body to the depth images, track it, clean its motion and plant visible feet."""
    captured = capture_recording(
        recording,
        planting=None,
        on_pose=on_pose,
        progress=within(progress, 0.0, TRACKED_FRACTION),
    )
    planting = planting if captured.actor.feet_visible else None
    cleaned = clean_motion(
        captured.motion, planting, None, within(progress, TRACKED_FRACTION, 1.0)
    )
    return ChainResult(
        recording=cleaned.recording,
        steps=(
            "These are depth images: Track found the actor, fitted a body and followed it.",
            *_describe_restarts(captured),
            *captured.remarks,
            *cleaned.steps[1:],
        ),
        notices=(*captured.remarks, *cleaned.notices),
        planted=cleaned.planted,
        denoised=cleaned.denoised,
        captured=captured,
    )


def _describe_restarts(captured: CapturedMotion) -> list[str]:
    n_restarts = len(captured.captured.restarts)
    if n_restarts == 1:
        return ["Track lost the actor and found it again once."]
    many = f"Track lost the actor and found it again {n_restarts} times."
    return [many] if n_restarts else []
