"""Clean recordings: learn how bodies move, then remove jitter, spikes and gaps.

>>> from solvers.denoising import find_worst_issues, measure_quality, plant_feet
>>> from solvers.samples import CorruptionSettings, GaitSettings, corrupt, walking_gait
>>> walk = walking_gait(GaitSettings(duration=2.0, frame_rate=60.0))
>>> planted = plant_feet(walk)
>>> planted.slide_after < planted.slide_before
True
>>> jitter = CorruptionSettings(jitter=1.0)
>>> corrupted = corrupt(walk, jitter, missing={"RightArm": range(20, 80)})
>>> issues = find_worst_issues(corrupted, measure_quality(corrupted))
>>> next(issue.sentence for issue in issues if issue.kind == "gap")
'RightArm and 2 more are missing for 1.00 s.'
"""

from typing import TYPE_CHECKING

from ..import_on_demand import import_on_demand

if TYPE_CHECKING:
    from ..feet import Planted, PlantSettings, plant_feet
    from .denoise import denoise
    from .denoise_settings import PART_STRENGTHS, DenoiseMethod, DenoiseSettings
    from .denoised import Denoised
    from .limits import JointLimitsSettings, clamp_to_limits, learn_joint_limits, limit_excess
    from .quality import (
        Issue,
        IssueSettings,
        Quality,
        QualitySettings,
        compare_quality,
        find_worst_issues,
        measure_at_contacts,
        measure_quality,
    )
    from .window_priors import (
        FilterBases,
        FilterBasesSettings,
        learn_filter_bases,
        load_filter_bases,
    )

__all__ = [
    "PART_STRENGTHS",
    "DenoiseMethod",
    "DenoiseSettings",
    "Denoised",
    "FilterBases",
    "FilterBasesSettings",
    "Issue",
    "IssueSettings",
    "JointLimitsSettings",
    "PlantSettings",
    "Planted",
    "Quality",
    "QualitySettings",
    "clamp_to_limits",
    "compare_quality",
    "denoise",
    "find_worst_issues",
    "learn_filter_bases",
    "learn_joint_limits",
    "limit_excess",
    "load_filter_bases",
    "measure_at_contacts",
    "measure_quality",
    "plant_feet",
]

import_on_demand(__name__)
