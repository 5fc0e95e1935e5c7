"""What motion itself tunes: contacts, shot boundaries, motions from points, resampling."""

from typing import Any

import numpy as np

from solvers.arrays import Flags
from solvers.motion import Motion, detect_contacts, motion_from_points, resample
from solvers.motion.skeletons import find_shot_boundaries
from solvers.rotations.representations import angle_between
from solvers.samples import CorruptionSettings, corrupt

from ...shared import clips
from ..takes import angle_error, joint_tracks, missed_or_false, variety, walk


def prepare() -> dict[str, Any]:
    """Choose takes with known contacts, join three walks, and take the points of one."""
    still = walk("10_04")
    parts = [walk("10_04"), walk("10_04").slice(70, 138), walk("10_04").slice(10, 60)]
    return {
        "contacts": _known_contacts(),
        "joined": _joined(parts),
        "points": (joint_tracks(still), still.skeleton.parents),
        "to_resample": walk("07_11", 1),
    }


def measure(
    contacts: dict[str, tuple[Motion, Flags]],
    joined: tuple[Motion, tuple[int, ...]],
    points: tuple[Any, Any],
    to_resample: Motion,
) -> dict[str, float]:
    """Contacts and boundaries missed or false, and errors of the rest."""
    figures: dict[str, float] = {}
    for name, (motion, truth) in contacts.items():
        figures[f"contacts, {name}: missed or false %"] = 1.0 + missed_or_false(
            detect_contacts(motion), truth
        )
    motion, cuts = joined
    found_cuts = set(find_shot_boundaries(motion))
    figures["cuts missed or false"] = 1.0 + len(found_cuts ^ set(cuts))
    tracks, parents = points
    rebuilt = motion_from_points(tracks, parents)
    angles = angle_between(rebuilt.rotations[1:], rebuilt.rotations[:-1])
    figures["points to motion: turning deg"] = float(np.degrees(angles).mean())
    there = resample(resample(to_resample, 30.0), to_resample.frame_rate)
    n = min(there.n_frames, to_resample.n_frames)
    figures["resampled: deg"] = angle_error(there.slice(0, n), to_resample.slice(0, n))
    return figures


def _known_contacts() -> dict[str, tuple[Motion, Flags]]:
    """Contacts of takes as they are, to be found again after noise and at other rates."""
    found = {}
    for name, motion in {"walk": walk("26_01", 1), "punch": variety("02_05")}.items():
        clean = motion.slice(0, 480)
        flags = detect_contacts(clean)
        slow = clips.every(clean, clips.STEP)
        noise = CorruptionSettings(jitter=0.5, root_jitter=0.002)
        found[f"{name} 30 Hz, noise"] = corrupt(slow, noise), flags[:: clips.STEP]
        found[f"{name} 120 Hz"] = clean, flags
    return found


def _joined(parts: list[Motion]) -> tuple[Motion, tuple[int, ...]]:
    rotations = np.concatenate([part.rotations for part in parts])
    root_positions = np.concatenate([part.root_positions for part in parts])
    cuts = tuple(int(each) for each in np.cumsum([part.n_frames for part in parts])[:-1])
    return Motion(parts[0].skeleton, rotations, root_positions, parts[0].frame_rate), cuts
