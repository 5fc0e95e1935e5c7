"""The pelvis does not shake with the noise of nearly straight legs."""

import numpy as np

from solvers.motion import find_humanoid_map, forward_kinematics
from solvers.physics.body import build_physics_body
from solvers.physics.body_surface import SIDES, find_leg_chain
from solvers.physics.pelvis_offset import LegGoal, solve_pelvis_offset
from solvers.rotations.representations import quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait

FRAME_RATE = 240.0


def test_noise_of_straight_legs_does_not_shake_the_pelvis(rng):
    """0.3 mm of noise: 22 m/s² if each frame is solved by itself."""
    walk = walking_gait(GaitSettings(duration=1.0, frame_rate=FRAME_RATE))
    body = build_physics_body(walk, find_humanoid_map(walk.skeleton))
    straight = quaternion_from_rotation_vector(np.zeros((walk.n_frames, walk.n_joints, 3)))
    poses = forward_kinematics(walk.with_poses(straight))
    goals = []
    for side in SIDES:
        chain = find_leg_chain(body, side)
        noise = rng.normal(scale=0.0003, size=(walk.n_frames, 3))
        goals.append(LegGoal(chain, poses.positions[:, chain[-1]] + noise))

    shift = solve_pelvis_offset(poses, goals, FRAME_RATE, body.size)

    acceleration = np.linalg.norm(np.diff(shift, 2, axis=0), axis=-1) * FRAME_RATE**2
    assert acceleration.mean() < 10.0
