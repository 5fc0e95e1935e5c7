"""Convert recordings of either kind to channels, and back."""

from collections.abc import Mapping

from ...arrays import Array
from ...motion import Motion, Tracks
from .channels import Channels
from .motion_channels import decode_motion, encode_motion
from .track_channels import decode_tracks, encode_tracks


def encode(
    recording: Motion | Tracks, references: Mapping[str, Array] | None = None
) -> Channels:
    """Convert a recording to channels about these references, or about its own means.

    References are those of `encode_motion` or `encode_tracks`: arrays by key, in their units.
    """
    if isinstance(recording, Motion):
        return encode_motion(recording, references)
    return encode_tracks(recording, references)


def decode(recording: Motion | Tracks, channels: Channels, values: Array) -> Motion | Tracks:
    """Return the recording with these channel values, shape (n_frames, n_parts, 3)."""
    if isinstance(recording, Motion):
        return decode_motion(recording, channels, values)
    return decode_tracks(recording, channels, values)
