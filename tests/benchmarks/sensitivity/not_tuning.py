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
        "*.MAD_TO_SIGMA",
        "*.CM_PER_M",
        "*.MM_PER_M",
        "markers/rigid_clusters.SPREAD_PERCENTILES",
        "markers/rigid_clusters.PERCENTILES_TO_SIGMA",
        "markers/joint_centers.ADULT_LEG_M",
        "reconstruction/reliability/error_model.ONE_CENTIMETER",
        "reconstruction/residual_correction/learn_residual_prior.MEDIAN_SQUARED_LENGTH",
        "reconstruction/reliability/settings.SENSOR_RATE_HZ",
        "motion/humanoid/contacts.HUMAN_LEG_LENGTH_M",
        "motion/humanoid/body_size.ADULT_STATURE_M",
        "retrieval/index/segments.HISTOGRAM_SCALE",
        "depth_tracking/detection/robust_parts.MEAN_SURFACE_DEPTH",
        "depth_tracking/*.REFERENCE_*",
    ),
    "lengths of bodies, from a table": (
        "motion/humanoid/limb_division.*_FRACTION*",
        "motion/humanoid/structure.*_FRACTION",
        "retargeting/placement.ANKLE_HEIGHT_FRACTION",
    ),
    "finds roles in a skeleton: chosen on rigs, not on takes": (
        "motion/humanoid/names.*",
        "motion/humanoid/roles.*",
        "motion/humanoid/structure.*",
        "motion/humanoid/tree_agreement.*",
        "motion/humanoid/mirrored_limbs.*",
        "motion/humanoid/canonical.*",
        "retargeting/map_checks.*",
    ),
    "used to train what ships, not to solve": (
        "depth_tracking/forest_training/*",
        "depth_tracking/forest/grow_tree.*",
        "depth_tracking/body/learn_motion_prior.*",
        "reconstruction/residual_correction/learn_*",
    ),
    "rounds numbers in a file": ("reconstruction/pose_library/posture_library.*_STEP",),
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
        "markers/determined_joints.REGULARIZATION",
        "markers/rigid_clusters.UNLINKED_M",
        "markers/pair_swaps.FORBIDDEN_COST",
        "motion/skeletons/motion.*",
        "motion/skeletons/shot_boundaries.MIN_MOTION",
        "retargeting/planting.MIN_STEP_M",
        "retargeting/key_thinning.ROUNDING",
        "retrieval/find_similar.ROUNDING_FRAMES",
        "retrieval/index/vocabulary.JITTER_M",
        "retrieval/index/vocabulary.MIN_SPREAD_M2",
        "retrieval/postures/part_reliability.MIN_VARIANCE_M2",
        "reconstruction/*.MIN_VARIANCE_M2",
        "reconstruction/joint_rotations/limb_angles.MIN_LENGTH",
        "reconstruction/residual_correction/sparse_process.JITTER",
        "depth_tracking/*_EPSILON",
        "depth_tracking/body/kinematics._SMALL_ANGLE",
        "depth_tracking/terms/closest_surface._NO_SURFACE",
    ),
    "of a published method, which stays as it is": ("denoising/published.*", "*/published/*"),
    "order or weight of a list that is read by people": (
        "denoising/quality/worst_issues.CUT_SEVERITY",
        "denoising/quality/worst_issues.LONG_GAP_S",
    ),
    "decides what is drawn only": ("markers/stick_sets.MIN_LABELS",),
    "guards against damaged files": (
        "variation/variation_model.*_FRAME_RATE_HZ",
        "motion/skeletons/frame_rate.*",
        "motion/skeletons/skeleton.MAX_DISTANCE_M",
        "depth_tracking/body/model.MAX_LENGTH_M",
        "retrieval/index/vocabulary.MAX_VALUE",
        "retrieval/library/library_file.LOCK_TIMEOUT_S",
    ),
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
