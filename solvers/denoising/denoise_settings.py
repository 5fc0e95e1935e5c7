"""Settings of Clean: the method, and how strongly it changes each part of the body."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Array
from ..motion import BODY_PARTS, Skeleton, joint_parts
from ..settings import Choice, Settings, setting


class DenoiseMethod(Choice):
    """Methods of denoising."""

    DEFAULT = "default", "Estimate the noise of the take and weight all patterns"
    PUBLISHED = "published", "Filter as printed by Lou and Chai (2010)", "Lou and Chai 2010"


@dataclass(frozen=True, kw_only=True)
class DenoiseSettings(Settings):
    """Settings of `denoise`."""

    method: DenoiseMethod = setting(
        DenoiseMethod.DEFAULT,
        "Denoising method; the default performed best in tests",
        advanced=True,
        research=True,
    )
    strength: float = setting(
        1.0, "Blend from recorded to cleaned motion; gaps are filled at any strength",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip
    strength_trunk: float = setting(
        1.0, "Fraction of Strength for hips, spine and the path of the body",
        minimum=0.0, maximum=1.0, label="Trunk",
    )  # fmt: skip
    strength_arms: float = setting(
        1.0, "Fraction of Strength for shoulders and arms", minimum=0.0, maximum=1.0,
        label="Arms",
    )  # fmt: skip
    strength_legs: float = setting(
        1.0, "Fraction of Strength for legs, feet and toes", minimum=0.0, maximum=1.0,
        label="Legs",
    )  # fmt: skip
    strength_head: float = setting(
        1.0, "Fraction of Strength for neck, head and face", minimum=0.0, maximum=1.0,
        label="Head",
    )  # fmt: skip
    strength_hands: float = setting(
        1.0, "Fraction of Strength for hands and fingers", minimum=0.0, maximum=1.0,
        label="Hands",
    )  # fmt: skip

    def part_strengths(self) -> dict[str, float]:
        """Return the factor of each part of the body, which multiplies the strength."""
        return {part: getattr(self, name) for part, name in PART_STRENGTHS.items()}

    def at_full_strength(self) -> "DenoiseSettings":
        """Return the settings without any blend."""
        return DenoiseSettings(method=self.method)


DEFAULT_SETTINGS = DenoiseSettings()
MIN_RATE_HZ = 5.0
"""Frames per second below which they are poses, not samples of a recording. Measured: a clean
walk of CMU was changed by up to 28 degrees at 2 Hz and 21 at 4, since people move between the
frames, and by 4 at 10; the slowest sensors have 5."""
PART_STRENGTHS = {part: f"strength_{part}" for part in BODY_PARTS}
"""Name of the setting of each part of the body."""


def joint_factors(skeleton: Skeleton, part_strengths: Mapping[str, float]) -> Array:
    """Return the factor of each joint by its part of the body, shape (n_joints,)."""
    if all(factor == 1.0 for factor in part_strengths.values()):
        return np.ones(skeleton.n_joints)
    return np.array([part_strengths[part] for part in joint_parts(skeleton)])


def settings_at_rate(
    settings: DenoiseSettings, frame_rate: float
) -> tuple[DenoiseSettings, str]:
    """Return the settings for a take and a sentence, which is empty at usual rates.

    Frames that are far apart are poses, of which only gaps change.
    """
    if frame_rate >= MIN_RATE_HZ:
        return settings, ""
    return replace(settings, strength=0.0), (
        f"At {frame_rate:.1f} frames a second, keys are poses: they stay, and gaps are filled."
    )
