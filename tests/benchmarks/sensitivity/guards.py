"""Constants whose exact value hardly matters: what shows that they are needed.

`WITHOUT` lists those that move no error by half or twice of them, but do where they have no
effect. `GUARDS` lists those for inputs that no take of the metrics holds: a test fails without
them, and `check_guards` runs it.
"""

from math import inf
from typing import Any, NamedTuple


class Guard(NamedTuple):
    """How to do without a constant, and what notices."""

    without: Any
    """Value with which it has no effect."""
    test: str
    """File below tests/solvers, and test."""


WITHOUT: dict[str, Any] = {
    "denoising/averaging/average_estimates.POOLED_JOINTS": 0.0,
    "denoising/outliers/likeliest_errors.BURST_PRIOR_PSEUDOCOUNT": 1.0,
    "denoising/outliers/likeliest_errors.RUN_PRIOR_PSEUDOCOUNT": 1e4,
    "denoising/outliers/likeliest_errors.SPIKE_PRIOR_PSEUDOCOUNT": 1e2,
    "denoising/window_estimates/estimate_channels.MAX_LEVERAGE": 1.0 - 1e-9,
    "denoising/window_estimates/prior_selection.N_TRIAL_ITERATIONS": 1,
    "denoising/window_estimates/smoothness.POOLED_WINDOWS": 0.0,
    "markers/pair_swaps.FRAME_WEIGHT": 0.0,
    "retargeting/key_curves.END_WEIGHT": 1.0,
    "markers/solve_skeleton.MAX_ERROR_FACTOR": inf,
}
"""Value without effect, by key; a tenth of the two numbers whose logarithm counts."""
DRAGS = "feet/test_dragged_feet.py::test_dragged_foot_is_found_at_all_frame_rates"
GUARDS: dict[str, Guard] = {
    "denoising/edge_poses.MIN_JUMP_RAD": Guard(
        0.0,
        "denoising/test_edge_poses.py::test_real_movement_is_not_classified_as_an_edge_pose",
    ),
    "denoising/edge_poses.ONE_SIDED_WEIGHT": Guard(
        1.0,
        "denoising/test_edge_poses.py::test_take_that_begins_as_a_quick_turn_ends_has_no_edge_pose",
    ),
    "denoising/channels/travel_path.MAX_ANGLE_RAD": Guard(
        inf,
        "denoising/test_turning_bodies.py::test_joint_that_turns_on_and_on_comes_back_through_its_channels",
    ),
    "denoising/channels/travel_path.UNWRAP_S": Guard(
        1e-6, "denoising/test_turning_bodies.py::test_spikes_do_not_add_up_to_turns"
    ),
    "denoising/channels/travel_path.GAP_WEIGHT": Guard(
        0.0, "denoising/test_channels.py::test_path_of_a_straight_walk_is_straight_across_a_gap"
    ),
    "denoising/limb_gaps/adapt_relation.MAX_TRIALS": Guard(
        10**9, "denoising/limb_gaps/test_limb_gaps.py::test_many_gaps_need_no_more_trials"
    ),
    "denoising/outliers/likeliest_errors.PRIOR_SPIKES": Guard(
        1e-20,
        "denoising/test_outlier_runs.py::test_suspected_kick_is_cleared_and_a_spike_is_not",
    ),
    "denoising/outliers/likeliest_errors.PRIOR_RUNS": Guard(
        1.0,
        "denoising/test_outlier_runs.py::test_second_error_of_a_take_need_not_be_as_likely_as_the_first",
    ),
    "feet/dragged_feet.STANDING_SPEED": Guard(0.25, DRAGS),
    "feet/dragged_feet.DRAGGED_SPEED": Guard(100.0, DRAGS),
    "feet/dragged_feet.MEMORY_S": Guard(10.0, DRAGS),
    "feet/dragged_feet.START_RATE": Guard(1e-12, DRAGS),
    "feet/dragged_feet.STOP_RATE": Guard(1e-9, DRAGS),
    "feet/plant_in_window.MAX_CHANGE_RAD": Guard(
        inf, "feet/test_feet_that_move.py::test_glitch_of_one_frame_does_not_twist_a_leg"
    ),
    "feet/plant_in_window.YIELD_S": Guard(
        0.0,
        "feet/test_feet_that_move.py::test_body_that_glides_is_not_pulled_back_and_its_feet_do_not_jump",
    ),
    "denoising/window_estimates/mean_pose.CLIP_VARIANCE_FRACTION": Guard(
        0.0, "denoising/test_mean_pose.py::test_copies_of_examples_change_nothing"
    ),
    "denoising/window_estimates/prior_selection.MAX_OWN_WEIGHT": Guard(
        1.0,
        "denoising/test_prior_selection.py::test_own_covariance_of_a_long_take_does_not_outweigh_its_smoothness",
    ),
    "denoising/window_priors/filter_bases.MIN_CHANNEL_DEVIATION": Guard(
        0.0, "denoising/test_denoise.py::test_examples_of_another_movement_are_rejected"
    ),
    "denoising/quality/bone_drift.MIN_NAMED_BONES": Guard(
        1,
        "denoising/quality/test_quality.py::test_markers_are_connected_by_their_distances_though_two_have_names_of_a_body",
    ),
    "denoising/marker_gaps/fill_markers.MIN_TRAINING_FRAMES": Guard(
        1,
        "denoising/test_fill_markers.py::test_rarely_observed_marker_is_not_filled_with_high_confidence",
    ),
    "retrieval/find_similar.MARGIN_FRACTION": Guard(
        0.0,
        "retrieval/test_find_similar.py::test_action_longer_than_the_segment_that_is_found_has_its_end",
    ),
    "retrieval/index/clip_segments.MAX_SEGMENT_FRACTION": Guard(
        100.0,
        "retrieval/test_index.py::test_long_clips_have_segments_and_short_ones_a_single_one",
    ),
    "retrieval/index/vocabulary.RELEARNING_RATIO": Guard(
        10**9, "retrieval/test_clip_library.py::test_grown_library_learns_a_new_vocabulary"
    ),
    "retrieval/postures/clip_postures.MAX_BRIDGED_GAP_S": Guard(
        inf, "retrieval/test_missing_joints.py::test_long_gaps_remain"
    ),
    "retrieval/postures/mean_postures.POSITION_NOISE_M": Guard(
        0.0,
        "retrieval/test_missing_joints.py::test_filled_joints_follow_the_actors_proportions",
    ),
    "retrieval/postures/mean_postures.MIN_OBSERVED_FRACTION": Guard(
        0.0,
        "retrieval/test_missing_joints.py::test_reliability_falls_with_missing_joints_of_an_arm",
    ),
    "retrieval/postures/mean_postures.HEADING_ERROR_RAD": Guard(
        inf,
        "retrieval/test_missing_joints.py::test_trunk_that_leans_aside_keeps_its_heading_while_limbs_are_missing",
    ),
    "retrieval/search/find_settings.RELIABILITY_POWER": Guard(
        0.0, "retrieval/test_rank_clips.py::test_parts_that_were_hardly_tracked_hardly_count"
    ),
    "retrieval/search/find_settings.SENSOR_MEAN_POSTURE_WEIGHT": Guard(
        1.0,
        "retrieval/test_find_similar.py::test_offset_joints_of_a_sensor_cost_less_than_of_a_motion",
    ),
    "retrieval/search/find_settings.MIN_ACTIVITY": Guard(
        0.0, "retrieval/test_rank_clips.py::test_all_parts_of_a_pose_have_equal_weight"
    ),
    "retrieval/search/find_settings.REST_WEIGHT": Guard(
        0.0, "retrieval/test_rank_clips.py::test_parts_at_rest_still_count"
    ),
    "markers/body_tables.FREE_STD_M": Guard(
        0.03,
        "markers/test_rare_takes.py::test_knee_markers_on_the_shanks_cost_the_hip_joints_millimeters",
    ),
    "markers/determined_joints.MAX_POSITION_STD_M": Guard(
        inf,
        "markers/test_rare_takes.py::test_legs_determine_missing_hips_and_shanks_alone_do_not",
    ),
    "markers/fit_body.MIN_COST_GAIN": Guard(
        0.0, "markers/test_fit.py::test_fit_of_a_body_ends_where_its_cost_hardly_falls"
    ),
    "markers/fit_poses.MIN_COST_GAIN": Guard(
        0.0, "markers/test_fit.py::test_fit_of_poses_ends_where_its_cost_hardly_falls"
    ),
    "markers/initial_poses.MIN_FOOT_M": Guard(
        0.0,
        "markers/test_rare_takes.py::test_level_of_a_foot_on_tiptoe_or_with_coinciding_markers_is_limited",
    ),
    "markers/initial_poses.MAX_SLOPE_SINE": Guard(
        inf,
        "markers/test_rare_takes.py::test_level_of_a_foot_on_tiptoe_or_with_coinciding_markers_is_limited",
    ),
    "markers/distances.RIGID_SPREAD_M": Guard(
        inf, "markers/test_rare_takes.py::test_marker_that_moves_freely_identifies_no_other"
    ),
    "retrieval/index/reranking.RECIPROCAL_WEIGHT": Guard(
        0.0,
        "retrieval/test_rank_clips.py::test_reciprocal_neighbor_counts_more_than_another_one",
    ),
    "retrieval/postures/part_reliability.MIN_PART_RELIABILITY": Guard(
        0.0,
        "retrieval/test_missing_joints.py::test_parts_never_observed_have_a_low_reliability_above_zero",
    ),
    "markers/mistaken_labels.MAX_GOOD_MISFIT": Guard(
        inf,
        "markers/test_rare_takes.py::test_reflection_does_not_get_the_label_of_a_missing_marker",
    ),
    "markers/mistaken_labels.MIN_JUMP_M": Guard(
        inf, "markers/test_unswap.py::test_marker_with_the_label_of_a_missing_one_is_renamed"
    ),
    "markers/pair_swaps.STEP_FACTOR": Guard(
        0.01, "markers/test_rare_takes.py::test_fast_pass_of_two_markers_and_back_is_no_swap"
    ),
    "markers/pair_swaps.MIN_BAD_MISFIT": Guard(
        inf, "markers/test_unswap.py::test_swap_between_gaps_is_corrected"
    ),
    "markers/pair_swaps.MIN_BAD_FRAMES": Guard(
        10**9, "markers/test_unswap.py::test_swap_between_gaps_is_corrected"
    ),
    "markers/distances.MIN_OBSERVED_FRACTION": Guard(
        0.0,
        "markers/test_rare_takes.py::test_marker_observed_in_two_frames_with_others_joins_no_cluster",
    ),
    "markers/rigid_clusters.MIN_TAKE_SPREAD_M": Guard(
        0.0,
        "markers/test_rare_takes.py::test_actor_who_sways_by_millimeters_is_no_rigid_cluster",
    ),
    "markers/rigid_transform.N_REWEIGHTINGS": Guard(
        1, "markers/test_rigid.py::test_outlier_marker_is_corrected_and_hardly_moves_others"
    ),
    "markers/rigid_transform.MARKER_NOISE_M": Guard(
        1e-9,
        "markers/test_rare_takes.py::test_skin_that_moves_by_millimeters_is_no_wrong_label",
    ),
    "markers/rigid_transform.CAUCHY_FACTOR": Guard(
        1e30, "markers/test_rigid.py::test_outlier_marker_is_corrected_and_hardly_moves_others"
    ),
    "variation/borrow_variation.MAX_SCALE": Guard(
        inf,
        "variation/test_learn_variation.py::test_variation_of_hardly_moving_clips_is_not_scaled_up_to_that_of_a_walk",
    ),
    "variation/contact_state.MAX_CONTACT_TIME_S": Guard(
        inf,
        "variation/test_contact_state.py::test_foot_that_always_stands_has_a_finite_contact_state",
    ),
    "variation/curves/curve_sampling.N_PADDING": Guard(
        1, "variation/test_curve_sampling.py::test_sampling_keeps_straight_lines_up_to_the_ends"
    ),
    "variation/curves/motion_curves.MAX_FRAME_ROTATION_RAD": Guard(
        inf, "variation/test_moving_references.py::test_flipping_joint_gets_no_moving_reference"
    ),
    "variation/loops.MIN_LOOP_FRAMES": Guard(
        1, "variation/test_learn_variation.py::test_clips_of_a_few_frames"
    ),
    "variation/loops.MAX_SPEED_CHANGE": Guard(
        inf,
        "variation/test_loops.py::test_detect_loop_rejects_a_swing_that_comes_back_the_other_way",
    ),
    "variation/loops.MAX_SEAM_RAD": Guard(
        0.0, "variation/test_loops.py::test_variants_of_a_looping_walk_loop"
    ),
    "feet/body_supports.MIN_SEAT_HEIGHT": Guard(
        0.0, "feet/test_hands_and_knees.py::test_hands_of_a_body_that_lies_are_free"
    ),
    "feet/live_planting.MAX_GAP_S": Guard(
        inf,
        "feet/test_live_planting.py::test_after_a_gap_and_with_another_actor_feet_begin_again",
    ),
    "feet/live_planting.PATCH_RADIUS_M": Guard(
        1e-6, "feet/test_live_heading.py::test_a_foot_on_its_ball_pivots"
    ),
    "feet/live_planting.MAX_HOLD_M": Guard(
        inf, "feet/test_live_planting.py::test_a_foot_that_is_held_too_far_away_slides_on"
    ),
    "feet/standing_feet.MIN_HIP_HEIGHT": Guard(
        0.0, "feet/test_lying_feet.py::test_feet_are_planted_until_the_actor_lies"
    ),
    "feet/standing_feet.MAX_PELVIS_SIZE": Guard(
        inf, "feet/test_lying_feet.py::test_hips_at_the_floor_say_nothing_about_lying"
    ),
    "motion_fitting/goals/hinge_limit.START_RAD": Guard(
        0.0, "motion_fitting/test_goals.py::test_only_straight_limbs_are_bent_before_a_fit"
    ),
    "motion_fitting/goals/hinge_limit.MIN_BEND": Guard(
        0.0,
        "motion_fitting/test_goals.py::test_a_knee_that_bends_backward_by_a_few_degrees_does_not_bend_farther",
    ),
    "motion_fitting/fit_in_windows.OVERLAP_S": Guard(
        1e-3, "motion_fitting/test_fit_in_windows.py::test_windows_cover_a_take_and_overlap"
    ),
    "feet/standing_feet.GROUND_PERCENTILE": Guard(
        1e-9,
        "feet/test_lying_feet.py::test_root_that_drops_through_the_floor_for_a_frame_does_not_lower_the_ground",
    ),
    "feet/standing_feet.MIN_CONTACT_S": Guard(
        1e-9, "feet/test_lying_feet.py::test_no_contact_is_shorter_because_the_actor_lies_down"
    ),
    "motion_fitting/goals/hinge_limit.HINGE_RAD": Guard(
        1e9, "motion_fitting/test_goals.py::test_a_knee_keeps_its_limit"
    ),
    "variation/synthesize.PIN_S": Guard(
        1e-6, "variation/test_synthesize.py::test_pins_hold_with_any_timing"
    ),
    "denoising/outliers/predictive_density.NEW_MOVEMENT_RATE": Guard(
        1e-30,
        "denoising/test_outlier_runs.py::test_kick_out_of_standing_still_is_cleared_and_a_burst_is_not",
    ),
    "denoising/outliers/predictive_density.RARE_MOVEMENT_WEIGHT": Guard(
        1e-30,
        "denoising/test_outlier_runs.py::test_second_error_of_a_take_need_not_be_as_likely_as_the_first",
    ),
    "denoising/outliers/predictive_density.RARE_MOVEMENT_SCALE": Guard(
        1.0,
        "denoising/test_outlier_runs.py::test_second_error_of_a_take_need_not_be_as_likely_as_the_first",
    ),
    "motion/humanoid/standing_rest.MIN_SIDE_COSINE": Guard(
        -2.0,
        "motion/test_standing_rest.py::test_a_trunk_that_rests_turned_away_from_the_legs_is_no_person",
    ),
    "motion/humanoid/standing_rest.STANDING_QUANTILE": Guard(
        1.0,
        "motion/test_standing_rest.py::test_the_feet_rest_as_they_stand_though_they_hang_most_of_the_time",
    ),
}
"""By key."""
