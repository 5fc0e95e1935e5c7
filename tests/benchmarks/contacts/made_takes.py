"""Takes whose contacts are known because they were made from them.

The ankle of a foot in contact is fixed, or its ball, about which the heel rises; only the gait
rolls from heel to toes. A foot is in contact from its landing to its lift, to the frame.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from solvers.arrays import Array, Flags
from solvers.motion import Motion, ReachSettings, reach
from solvers.rotations import quaternion_from_rotation_vector, rotate
from solvers.rotations.representations import IDENTITY
from solvers.samples import GaitSettings, walker_skeleton, walking_gait
from solvers.samples.footsteps import TOE_OFF
from solvers.samples.gait import HEADING_STD_RAD
from solvers.samples.walk_plan import plan_walk
from solvers.samples.walker import ANKLE_HEIGHT_M

DURATION_S = 6.0
GRAVITY = 9.81
WIDTH_M = 0.18
"""Distance of the ankles of a standing body."""
STANDING_HIPS_M = 0.94
GAITS = ((0.7, 90.0), (1.0, 105.0), (1.3, 116.0), (1.6, 124.0))
"""Meters per second and steps per minute."""


@dataclass(frozen=True, eq=False)
class MadeTake:
    """A motion and its contacts, (n_frames, 2), left and right."""

    motion: Motion
    contacts: Flags


@dataclass(frozen=True, eq=False)
class Plan:
    """Hips (n_frames, 3); ankles (n_frames, 2, 3); contacts; pitch of both feet, radians."""

    hips: Array
    ankles: Array
    contacts: Flags
    pitch: Array | None = None


def made_takes(frame_rate: float) -> dict[str, MadeTake]:
    """Return all takes at a frame rate."""
    time = np.arange(round(DURATION_S * frame_rate)) / frame_rate
    takes = {
        f"walk at {speed:g} m/s": _walk(frame_rate, speed, cadence, seed)
        for seed, (speed, cadence) in enumerate(GAITS)
    }
    return takes | {name: pose_plan(plan(time), frame_rate) for name, plan in PLANS.items()}


def _walk(frame_rate: float, speed: float, cadence: float, seed: int) -> MadeTake:
    settings = GaitSettings(
        duration=DURATION_S, frame_rate=frame_rate, speed=speed, cadence=cadence, seed=seed
    )
    motion = walking_gait(settings)
    time = np.arange(motion.n_frames) / frame_rate
    plan = plan_walk(time, DURATION_S, speed, 60.0 / cadence, HEADING_STD_RAD, seed)
    return MadeTake(motion, np.stack([foot.phase < TOE_OFF for foot in plan.feet], axis=1))


def pose_plan(plan: Plan, frame_rate: float) -> MadeTake:
    """Put the legs of the sample's skeleton onto planned ankles."""
    skeleton = walker_skeleton()
    rotations = np.tile(IDENTITY, (len(plan.hips), skeleton.n_joints, 1))
    if plan.pitch is not None:
        for side, pitch in zip(("Left", "Right"), plan.pitch.T, strict=True):
            foot = quaternion_from_rotation_vector(pitch[:, None] * (1.0, 0.0, 0.0))
            rotations[:, skeleton.index(f"{side}Foot")] = foot
            rotations[:, skeleton.index(f"{side}ToeBase")] = foot * (1.0, -1.0, -1.0, -1.0)
    motion = Motion(skeleton, rotations, plan.hips, frame_rate)
    for number, side in enumerate(("Left", "Right")):
        joints = [skeleton.index(side + part) for part in ("UpLeg", "Leg", "Foot")]
        leg = (joints[0], joints[1], joints[2])
        motion = reach(motion, leg, plan.ankles[:, number], ReachSettings(softness=0.0))
    return MadeTake(motion, plan.contacts)


def still(time: Array) -> tuple[Array, Array]:
    """Return hips and ankles of a body that stands."""
    hips = np.tile([0.0, 0.0, STANDING_HIPS_M], (len(time), 1))
    ankles = np.zeros((len(time), 2, 3))
    ankles[:, :, 0] = (WIDTH_M / 2, -WIDTH_M / 2)
    ankles[..., 2] = ANKLE_HEIGHT_M
    return hips, ankles


def _sway(time: Array) -> Plan:
    """Stand; the hips sway by 3 cm."""
    hips, ankles = still(time)
    hips[:, 0] += 0.03 * np.sin(2.0 * np.pi * 0.4 * time)
    hips[:, 1] += 0.02 * np.sin(2.0 * np.pi * 0.3 * time)
    hips[:, 2] -= 0.03
    return Plan(hips, ankles, np.ones((len(time), 2), np.bool_))


def _rise_on_toes(time: Array) -> Plan:
    """Lift both heels by 45 degrees and lower them, about balls that stay."""
    hips, ankles = still(time)
    pitch = np.radians(45.0) * np.sin(np.pi * time / 2.0) ** 2
    ball = np.array([0.0, -0.14, -0.06])
    lifted = ball - rotate(
        quaternion_from_rotation_vector(pitch[:, None] * (1.0, 0.0, 0.0)), ball
    )
    ankles += lifted[:, None]
    hips += lifted
    hips[:, 2] -= 0.03
    return Plan(
        hips, ankles, np.ones((len(time), 2), np.bool_), np.stack([pitch, pitch], axis=1)
    )


def _one_leg(time: Array) -> Plan:
    """Stand on the left leg from 1 to 5 s, the right foot held 30 cm above the floor."""
    hips, ankles = still(time)
    up = smooth_step((time - 1.0) / 0.6) - smooth_step((time - 4.4) / 0.6)
    ankles[:, 1, 2] += 0.3 * up
    ankles[:, 1, 1] += 0.15 * up
    hips[:, 2] -= 0.03
    down = (time <= 1.0) | (time >= 5.0)
    return Plan(hips, ankles, np.stack([np.ones_like(down), down], axis=1))


def _hop(time: Array, feet: Sequence[int]) -> Plan:
    """Hop on the given feet: 0.2 s on the floor, 0.3 s in the air."""
    cycle, phase = np.divmod(time, 0.5)
    in_air = phase >= 0.2
    flight = np.where(in_air, phase - 0.2, 0.0)
    height = 0.5 * GRAVITY * flight * (0.3 - flight)
    # On the floor the hips brake and accelerate like a spring: half a sine.
    push = 0.5 * GRAVITY * 0.3 * 0.2 / np.pi * np.sin(np.pi * phase / 0.2)
    hips, ankles = still(time)
    hips[:, 2] += -0.05 + height - np.where(in_air, 0.0, push)
    hips[:, 1] -= 0.6 * time
    ankles[:, :, 1] -= 0.3 * (cycle + flight / 0.3)[:, None] + 0.06
    ankles[..., 2] += height[:, None]
    contacts = np.repeat(~in_air[:, None], 2, axis=1)
    for foot in {0, 1} - set(feet):
        ankles[:, foot] = hips + (ankles[:, foot, :] - hips) * (1.0, 0.0, 0.0)
        ankles[:, foot, 1:] += (0.2, -0.55)
        contacts[:, foot] = False
    return Plan(hips, ankles, contacts)


def _run(time: Array) -> Plan:
    """Run at 2.8 m/s: 0.25 s on the floor and 0.45 s in the air for each foot."""
    hips, ankles = still(time)
    hips[:, 1] -= 2.8 * time
    hips[:, 2] = 0.86 + 0.03 * np.cos(2.0 * np.pi * (time - 0.125) / 0.35 + np.pi)
    contacts = np.zeros((len(time), 2), np.bool_)
    for foot, lag in enumerate((0.0, 0.35)):
        cycle, phase = np.divmod(time + lag, 0.7)
        swing = np.clip((phase - 0.25) / 0.45, 0.0, 1.0)
        landed_s = 0.7 * (cycle + smooth_step(swing)) - lag + 0.125
        ankles[:, foot, 0] *= 0.5
        ankles[:, foot, 1] = -2.8 * landed_s
        ankles[:, foot, 2] += 0.3 * np.sin(np.pi * swing) ** 2
        contacts[:, foot] = phase < 0.25
    return Plan(hips, ankles, contacts)


def _side_steps(time: Array) -> Plan:
    """Step sideways by 20 cm, each foot lifted by 4 cm for 0.4 s of every 1.2 s."""
    hips, ankles = still(time)
    contacts = np.zeros((len(time), 2), np.bool_)
    hips[:, 0] += 0.2 * time / 1.2
    hips[:, 2] -= 0.06
    for foot, lag in enumerate((0.0, 0.6)):
        cycle, phase = np.divmod(time - lag + 1.2, 1.2)
        swing = np.clip(phase / 0.4, 0.0, 1.0)
        ankles[:, foot, 0] += 0.2 * (cycle - 1.0 + smooth_step(swing))
        ankles[:, foot, 2] += 0.04 * np.sin(np.pi * swing) ** 2
        contacts[:, foot] = phase >= 0.4
    return Plan(hips, ankles, contacts)


def _box(time: Array) -> Plan:
    """Step onto a box of 20 cm and stand on it: left from 1 s, right from 2 s, for 0.6 s."""
    hips, ankles = still(time)
    contacts = np.ones((len(time), 2), np.bool_)
    for foot, start in enumerate((1.0, 2.0)):
        step = smooth_step((time - start) / 0.6)
        inside = (time > start) & (time < start + 0.6)
        lift = np.sin(np.pi * np.clip((time - start) / 0.6, 0.0, 1.0)) ** 2
        ankles[:, foot, 1] -= 0.35 * step
        ankles[:, foot, 2] += 0.2 * step + 0.12 * lift
        contacts[:, foot] = ~inside
    body = smooth_step((time - 1.5) / 1.0)
    hips[:, 1] -= 0.35 * body
    hips[:, 2] += 0.2 * body - 0.12
    return Plan(hips, ankles, contacts)


def _chair(time: Array) -> Plan:
    """Sit on a chair; the right leg is crossed over from 2 s on."""
    hips, ankles = still(time)
    hips[:, 1:] = (0.0, 0.5)
    ankles[:, :, 1] = -0.42
    up = smooth_step((time - 2.0) / 0.7)
    ankles[:, 1] += up[:, None] * (0.2, -0.05, 0.3)
    return Plan(hips, ankles, np.stack([np.ones_like(time) > 0.0, time <= 2.0], axis=1))


PLANS: dict[str, Callable[[Array], Plan]] = {
    "stand and sway": _sway,
    "rise on the toes": _rise_on_toes,
    "stand on one leg": _one_leg,
    "hop on both legs": lambda time: _hop(time, (0, 1)),
    "hop on the left leg": lambda time: _hop(time, (0,)),
    "run at 2.8 m/s": _run,
    "side steps": _side_steps,
    "sit on a chair": _chair,
    "step onto a box": _box,
}


def smooth_step(ratio: Array) -> Array:
    """Go from 0 to 1 with minimum jerk (Flash and Hogan 1985)."""
    ratio = np.clip(ratio, 0.0, 1.0)
    return np.asarray(ratio**3 * (10.0 - 15.0 * ratio + 6.0 * ratio**2))
