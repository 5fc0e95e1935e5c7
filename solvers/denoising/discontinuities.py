"""Find what interrupts a take: cuts, samples that were held, and jumps of the body."""

import numpy as np

from ..arrays import Array, Flags
from ..motion import Motion, Tracks
from ..motion.skeletons import (
    find_path_jumps,
    find_shot_boundaries,
    is_short_shot,
    move_root,
    path_offsets,
    shot_ranges,
)
from .denoise_settings import DenoiseMethod, DenoiseSettings
from .held_samples import find_held_samples, hide_held_samples
from .observed_samples import restore_observed


def find_held_and_cuts(
    recording: Motion | Tracks, settings: DenoiseSettings
) -> tuple[Flags, tuple[int, ...]]:
    """Return what a tracker held, except in segments that are kept, and the cuts.

    The first has the shape (n_frames, n_parts) of `find_held_samples`; cuts are frames.
    """
    held = find_held_samples(recording)
    if settings.method is DenoiseMethod.PUBLISHED:
        held[:] = False
    cuts = find_shot_boundaries(hide_held_samples(recording, held))
    for start, stop in shot_ranges(recording, cuts):
        if cuts and is_short_shot(stop - start, recording.frame_rate):
            held[start:stop] = False
    return held, cuts


def remove_path_jumps(
    take: Motion | Tracks, cuts: tuple[int, ...], settings: DenoiseSettings
) -> tuple[Motion | Tracks, Array]:
    """Return the take without jumps of its root, and what they add, shape (n_frames, 3)."""
    if isinstance(take, Tracks) or settings.method is DenoiseMethod.PUBLISHED:
        return take, np.zeros((take.n_frames, 3))
    offsets = path_offsets(find_path_jumps(take, cuts), take.n_frames)
    return move_root(take, -offsets) if offsets.any() else take, offsets


def restore_path_jumps(
    take: Motion | Tracks, cleaned: Motion | Tracks, offsets: Array, kept: Flags
) -> Motion | Tracks:
    """Return the cleaned take with the jumps of its root; kept joints are as in the take.

    Parameters
    ----------
    take, cleaned : Motion or Tracks
    offsets : shape (n_frames, 3), meters
        Of the root, from `path_offsets`.
    kept : shape (n_frames, n_joints)
    """
    if not (isinstance(cleaned, Motion) and offsets.any()):
        return cleaned
    return restore_observed(take, move_root(cleaned, offsets), kept)
