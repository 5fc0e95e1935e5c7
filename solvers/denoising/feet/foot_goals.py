"""The goals of a fit that plants feet."""

from collections.abc import Sequence

import numpy as np

from ...arrays import Array, Flags
from ...motion import Motion, WorldPoses
from ...motion_fitting import FittedMotion
from ...motion_fitting.goals import (
    BonePoint,
    FollowPosition,
    FollowRotation,
    FollowSource,
    Goal,
    HingeLimit,
    StayAtHeight,
    StayInPlace,
    StayStill,
    hinge_axis,
    hinge_flexion,
)
from .foot_trajectory import *
from .foot_trajectory import _loaded_displacements, _plausibility, _on_floor, _median_contact_heights, MAX_FLAT_RATE
from scipy.ndimage import gaussian_filter1d
from .legs import LegJoints
from .sole import *
from ...signals.smooth_correction import FADE_TIME_CONSTANTS
from ...rotations import rotation_vector_from_quaternion, multiply, inverse

P = dict(root=0.02, hip=np.radians(4), knee=np.radians(6), off=np.radians(2), ankle=np.radians(15), foot=np.radians(4), toe=np.radians(4), limit=np.radians(.3), min_flex=np.radians(4), still=np.radians(2), height=.002, root_tau=2.0, slide=.002, pos=.01)


def joints_of(legs):
    return [j for leg in legs for j in (*leg.chain, leg.toe) if j is not None]


def goals_of(motion, poses, legs, contacts, blend, hold_rotation, floor, p=P):
    joints = joints_of(legs)
    start = FittedMotion(motion, motion, tuple(joints))
    tol = np.full(start.n_variables, p["root"])
    tau = np.full(start.n_variables, blend / FADE_TIME_CONSTANTS)
    tau[:3] *= p["root_tau"]
    goals = []
    rate = motion.frame_rate
    for leg in legs:
        contact = contacts[:, 0 if leg.side == "left" else 1]
        tol[start.columns(leg.hip)] = p["hip"]
        tol[start.columns(leg.ankle)] = p["ankle"]
        tol[start.columns(leg.knee)] = p["knee"]
        if leg.toe is not None:
            tol[start.columns(leg.toe)] = p["toe"]
        size = leg.length(motion.skeleton) / ADULT_LEG_M
        points = sole_points(motion.skeleton, poses, leg)
        standing = measure_standing_heights(points, contact, rate)
        load = estimate_loads(points[..., 2] - standing, rate, size)
        height = np.sum(load * (points[..., 2] - standing), axis=1)
        contact_height = _median_contact_heights(height, contact)
        disp = _loaded_displacements(points, load)
        ankle = poses.positions[:, leg.ankle]
        w = both_in_contact(contact) * _plausibility(disp - np.diff(ankle, axis=0), rate, size)
        w = np.repeat(w[:, None], 3, axis=1)
        w[:, 2] *= _on_floor(np.abs(height - contact_height), size)
        rest = motion.skeleton.rest_positions
        bp = bone_points(motion.skeleton, leg)
        goals.append(StayInPlace(bp, load, w, p["slide"]))
        if floor and contact.any():
            level = np.median(height[contact])
            if np.median(np.abs(contact_height[contact] - level)) < MAX_LEVEL_SPREAD_M * size:
                near = contact & (np.abs(contact_height - level) < MAX_FLOOR_DISTANCE_M * size)
                hw = np.zeros(motion.n_frames)
                hw[:-1] = near[:-1] * w[:, 2]
                goals.append(StayAtHeight(bp, load, standing, level, hw, p["height"]))
        if hold_rotation and motion.n_frames > 1:
            rot = poses.rotations[:, leg.ankle]
            d = rotation_vector_from_quaternion(multiply(rot[1:], inverse(rot[:-1])))
            av = gaussian_filter1d(d * rate, SMOOTHING_S * rate, axis=0)
            slow = np.clip(2 - 2 * np.linalg.norm(av, axis=1) / MAX_FLAT_RATE, 0, 1)
            bal = np.clip(4 * load[:, 0] * (1 - load[:, 0]), 0, 1)
            goals.append(StayStill(leg.ankle, both_in_contact(contact) * slow * .5 * (bal[1:] + bal[:-1]), p["still"]))
        goals.append(FollowPosition(BonePoint(leg.ankle, np.zeros(3)), ankle, np.ones(motion.n_frames), p["pos"]))
        goals.append(FollowRotation(leg.ankle, poses.rotations[:, leg.ankle], p["foot"]))
        axis = hinge_axis(start, leg.knee, leg.ankle)
        if axis is not None:
            flex = hinge_flexion(start, leg.knee, leg.ankle, axis)
            goals.append(HingeLimit(leg.knee, leg.ankle, axis, np.minimum(flex, p["min_flex"]), p["limit"]))
    goals.append(FollowSource(tol, tau))
    return joints, goals


def bone_points(skeleton, leg):
    rest = skeleton.rest_positions
    ball = leg.toe if leg.toe is not None else next(iter(skeleton.children[leg.ankle]), leg.ankle)
    foot = rest[ball] - rest[leg.ankle]
    heel = np.array([0.0, 0.0, foot[2]]) - HEEL_FRACTION * foot * (1.0, 1.0, 0.0)
    out = [BonePoint(leg.ankle, heel), BonePoint(ball, np.zeros(3))]
    if leg.toe is not None:
        tip = next(iter(skeleton.children[leg.toe]), leg.toe)
        if tip != leg.toe:
            out.append(BonePoint(tip, np.zeros(3)))
    return out
