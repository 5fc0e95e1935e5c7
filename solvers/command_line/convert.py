"""`convert`: write a recording in another format, here and in Blender."""

from dataclasses import asdict
from pathlib import Path

from ..motion import Motion, Tracks
from ..progress import Progress
from ..recordings.conventions import conventions_of
from .files import write
from .verb import Outcome


def convert(recording: Motion | Tracks, target: Path | None, progress: Progress) -> Outcome:
    """Write a recording in the format of the target's extension; return its outcome."""
    write(recording, target, progress)
    names = recording.skeleton.names if isinstance(recording, Motion) else recording.names
    kind = "joints" if isinstance(recording, Motion) else "points"
    conventions = conventions_of(recording)
    figures = {
        "n_frames": recording.n_frames,
        "frame_rate_hz": recording.frame_rate,
        kind: list(names),
        "conventions": asdict(conventions),
    }
    text = (
        f"{recording.n_frames} frames at {recording.frame_rate:g} Hz, {len(names)} {kind};"
        f" {conventions.sentence()}."
    )
    return Outcome(text, figures)
