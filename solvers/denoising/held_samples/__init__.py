"""Samples that a tracker repeated while the body moved on."""

from .find_held import body_is_held, find_held_samples
from .hide_held import (
    describe_held_samples,
    held_joints,
    hide_held_samples,
    restore_held_samples,
)

__all__ = [
    "body_is_held",
    "describe_held_samples",
    "find_held_samples",
    "held_joints",
    "hide_held_samples",
    "restore_held_samples",
]
