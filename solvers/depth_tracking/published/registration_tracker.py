"""Settings of the tracker that are those of [WZC12]."""

import numpy as np

from ..terms import TrackerSettings

PER_DEGREE = (180.0 / np.pi) ** 2
"""Squared degrees in a squared radian. By definition."""

NO_ANKLES = 1e6
"""`ankle_weight` that locks the ankles. By definition of a constraint, any value as large gives
the same."""
N_STEPS = 5
"""Number of steps in which the solver of [WZC12] section 3.1 usually converges."""

REGISTRATION_TRACKER = TrackerSettings(
    iterations=1 + N_STEPS, coarse_iterations=0, limit=0.08,
    closest_weight=0.0, off_actor_weight=0.0, too_near_weight=0.0,
    depth_weight=4.0, extra_weight=4.0 / 0.29**2, silhouette_weight=4.0 / 100.0**2,
    shift_weight=1.0 / 14.3**2, rotation_weight=PER_DEGREE / 14.3**2,
    similar_weight=0.0, prediction=1.0, start_ahead=False,
    limit_weight=0.0, natural_weight=0.0, ankle_weight=NO_ANKLES, damping=1e-6,
    max_step=10.0, accept_only_better=False,
)  # fmt: skip
"""Terms and standard deviations of [WZC12] appendix A. Each pixel here counts as four of their
pixels (320 columns), and by the surface that it covers: as much as theirs at 2.9 m.

The paper gives no units. Lengths are interpreted in meters, where depth and silhouette have
weights of the same order, and angles in degrees: per square radian, the prior has no effect."""
