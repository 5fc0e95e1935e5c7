"""Constants that are not varied, and why: `*` in a key stands for any text."""

from fnmatch import fnmatchcase

REASONS: dict[str, tuple[str, ...]] = {
    "definition or conversion of units": (
        "signals/noise.MAD_TO_SIGMA",
        "signals/noise.DIFFERENCE_*",
        "signals/spikes.TUKEY_SIGMAS",
        "denoising/channels/channels.CENTIMETERS",
        "denoising/marker_gaps/gap_boundaries.MEDIAN_NORM",
        "denoising/denoise.HALF_CONFIDENCE_DEVIATION",
        "denoising/feet/foot_trajectory.ADULT_LEG_M",
        "denoising/quality/bone_drift.*_PERCENTILE",
        "denoising/quality/worst_issues.SEVERE_EXCESS",
        "signals/smooth_correction.FADE_TIME_CONSTANTS",
        "*.GRAVITY*",
    ),
    "bounds memory, not the result": (
        "denoising/channels/examples.BLOCK_S",
        "denoising/posterior/filter_pass.MAX_BLOCK_WINDOWS",
        "denoising/posterior/gap_patterns.MAX_MATRIX_ENTRIES",
        "denoising/window_priors/lag_covariance.MAX_CLIP_ENDS",
        "*.BLOCK_FRAMES",
        "*.MAX_BLOCK_*",
    ),
    "guards a division or a logarithm": (
        "denoising/posterior/channel_groups.MAX_CONSTANT_RANGE",
        "denoising/posterior/smoothness.MIN_POWER",
        "denoising/window_priors/filter_bases.MIN_ANY_DEVIATION",
        "variation/mixtures.JITTER",
        "denoising/marker_gaps/*.MIN_SQUARED_ERROR",
        "denoising/marker_gaps/gap_boundaries.MIN_NOISE_M",
    ),
    "printed by the paper whose method it is": ("denoising/published.*", "*/published/*"),
    "order or weight of a list that is read by people": (
        "denoising/quality/worst_issues.CUT_SEVERITY",
        "denoising/quality/worst_issues.LONG_GAP_S",
    ),
    "guards against damaged files": ("variation/variation_model.*_FRAME_RATE_HZ",),
    "shape of an array": (
        "physics/*.N_BANDS",
        "denoising/window_priors/filter_bases.N_REFERENCE",
        "variation/motion_curves.*_COLUMN*",
        "variation/motion_curves.N_*",
        "variation/contact_state.N_*",
    ),
    "name of a version of a file": ("*.VERSION", "*.FORMAT*"),
}


def reason(key: str) -> str:
    """Why a constant is no tuning; empty if it is."""
    for why, patterns in REASONS.items():
        if any(fnmatchcase(key, pattern) for pattern in patterns):
            return why
    return ""
