"""Bodies whose hands and knees bear on the floor in known frames, because they were made so.

Hands reach for planned wrists by two-bone IK; knees are fixed, and the hips swing about them.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from solvers.arrays import Array, Flags
from solvers.feet.body_supports import LIMBS, SUPPORTS
from solvers.motion import Motion, ReachSettings, forward_kinematics, reach
from solvers.rotations import inverse, multiply, quaternion_from_rotation_vector
from solvers.rotations.representations import IDENTITY
from solvers.samples import GaitSettings, walker_skeleton, walking_gait
from solvers.samples.walker import ANKLE_HEIGHT_M

from .made_takes import MadeTake, smooth_step

DURATION_S = 6.0
SIDES = ("Left", "Right")
THIGH_M, KNEE_M, WRIST_M = 0.43, 0.06, 0.06
"""Length of the sample's thigh; heights of a knee and a wrist that bear on the floor."""
ON_ALL_FOURS, ON_HANDS_AND_FEET = np.radians([80.0, 95.0])
"""Tilts of a trunk whose hands are on the floor."""
FLAT, TUCKED, INSTEP = np.radians([0.0, 60.0, 157.0])
"""Tilts of a foot that stands flat, on its toes, or lies on its instep."""
TUCKED_ANKLE_M = 0.15
"""Height of the ankle of a foot on its toes."""
FRONT = np.array([0.09, -0.4, ANKLE_HEIGHT_M])
"""Ankle of a foot in front of a body that kneels on one knee."""


@dataclass(frozen=True, eq=False)
class _Plan:
    """Hips (n_frames, 3) and tilt of the trunk; thighs, shins and wrists; contacts.

    Attributes
    ----------
    thighs, shins : radians, (n_frames, 2)
        Tilt of the bones against the vertical, forward.
    wrists : shape (n_frames, 2, 3), meters; NaN lets the arms hang
    contacts : shape (n_frames, 4), of `LIMBS`
    feet : radians
        Tilt of the left and the right foot.
    ankles : shape (n_frames, 2, 3), meters
        Where legs reach; NaN lets thighs and shins be.
    """

    hips: Array
    tilt: Array
    thighs: Array
    shins: Array
    wrists: Array
    contacts: Flags
    feet: tuple[float, float]
    ankles: Array


def made_supports(frame_rate: float) -> dict[str, MadeTake]:
    """Return all takes, whose contacts are those of `SUPPORTS`, (n_frames, 5)."""
    time = np.arange(round(DURATION_S * frame_rate)) / frame_rate
    walk = walking_gait(GaitSettings(duration=DURATION_S, frame_rate=frame_rate))
    none = np.zeros((walk.n_frames, len(SUPPORTS)), np.bool_)
    takes = {name: _take(plan(time), frame_rate) for name, plan in PLANS.items()}
    return takes | {"walk": MadeTake(walk, none)}


def _take(plan: _Plan, frame_rate: float) -> MadeTake:
    skeleton, n_frames = walker_skeleton(), len(plan.hips)
    rotations = np.tile(IDENTITY, (n_frames, skeleton.n_joints, 1))
    rotations[:, 0] = _about_x(plan.tilt)
    for number, side in enumerate(SIDES):
        thigh, shin = plan.thighs[:, number], plan.shins[:, number]
        rotations[:, skeleton.index(f"{side}UpLeg")] = _about_x(-thigh - plan.tilt)
        rotations[:, skeleton.index(f"{side}Leg")] = _about_x(thigh - shin)
        down = quaternion_from_rotation_vector([0.0, (1.0, -1.0)[number] * 1.2, 0.0])
        rotations[:, skeleton.index(f"{side}Arm")] = down
    motion = Motion(skeleton, rotations, plan.hips, frame_rate)
    for number, side in enumerate(SIDES):
        motion = _with_foot(motion, side, plan.ankles[:, number], plan.feet[number])
        wrist = plan.wrists[:, number]
        if np.isfinite(wrist).all():
            motion = _with_hand(motion, side, wrist)
    contacts = np.zeros((n_frames, len(SUPPORTS)), np.bool_)
    contacts[:, : len(LIMBS)] = plan.contacts
    return MadeTake(motion, contacts)


def _with_foot(motion: Motion, side: str, ankle: Array, tilt: float) -> Motion:
    """Reach for an ankle, unless it is NaN, and tilt the foot; its toes stay level."""
    leg = [motion.skeleton.index(side + part) for part in ("UpLeg", "Leg", "Foot")]
    if np.isfinite(ankle).all():
        motion = reach(motion, (leg[0], leg[1], leg[2]), ankle, ReachSettings(softness=0.0))
    rotations, shin = motion.rotations.copy(), forward_kinematics(motion).rotations[:, leg[1]]
    foot, toes = _about_x([tilt, np.pi if tilt == INSTEP else 0.0])
    rotations[:, leg[2]] = multiply(inverse(shin), foot)
    rotations[:, motion.skeleton.index(f"{side}ToeBase")] = multiply(inverse(foot), toes)
    return motion.with_poses(rotations)


def _with_hand(motion: Motion, side: str, wrist: Array) -> Motion:
    """Reach for a wrist, with a hand that lies flat and points forward."""
    arm = [motion.skeleton.index(side + part) for part in ("Arm", "ForeArm", "Hand")]
    motion = reach(motion, (arm[0], arm[1], arm[2]), wrist, ReachSettings(softness=0.0))
    forearm = forward_kinematics(motion).rotations[:, arm[1]]
    sign = -1.0 if side == "Left" else 1.0
    flat = quaternion_from_rotation_vector([0.0, 0.0, sign * np.pi / 2])
    rotations = motion.rotations.copy()
    rotations[:, arm[2]] = multiply(inverse(forearm), flat)
    return motion.with_poses(rotations)


def _about_x(angle: ArrayLike) -> Array:
    return quaternion_from_rotation_vector(np.asarray(angle)[:, None] * (1.0, 0.0, 0.0))


def _on_all_fours(time: Array) -> _Plan:
    """Stay on hands and knees and sway by some centimeters."""
    thigh = 0.12 * np.sin(2.0 * np.pi * 0.4 * time)
    wrists = np.zeros((len(time), 2, 3))
    wrists[:] = ([0.2, -0.5, WRIST_M], [-0.2, -0.5, WRIST_M])
    return _Plan(
        _above_knees(time, thigh), np.full_like(time, ON_ALL_FOURS),
        _both(thigh), np.full((len(time), 2), -np.pi / 2), wrists,
        np.ones((len(time), 4), np.bool_), (INSTEP, INSTEP), _free(time),
    )  # fmt: skip


def _crawl(time: Array) -> _Plan:
    """Walk on hands and feet; each hand is lifted for 0.4 s of every 1.2 s."""
    hips = np.tile([0.0, 0.0, 0.55], (len(time), 1))
    hips[:, 1] -= 0.25 * time
    wrists, hands = _steps(time, (0.0, 0.6))
    ankles, _ = _steps(time, (0.9, 0.3))
    wrists += (0.0, -0.45, WRIST_M)
    ankles += (0.0, 0.25, TUCKED_ANKLE_M)
    ankles[..., 0] *= 0.5
    contacts = np.hstack([hands, np.zeros_like(hands)])
    legs = np.zeros((len(time), 2))
    tilt = np.full_like(time, ON_HANDS_AND_FEET)
    # Bent a little, so that the knees bend forward.
    return _Plan(
        hips, tilt, legs + 0.9, legs - 1.2, wrists, contacts, (TUCKED, TUCKED), ankles
    )  # fmt: skip


def _steps(time: Array, lags: tuple[float, float]) -> tuple[Array, Flags]:
    """Return steps of 30 cm, lifted by 10 cm for 0.4 s of every 1.2 s, and when they rest."""
    path = np.zeros((len(time), 2, 3))
    path[..., 0] = (0.2, -0.2)
    down = np.zeros((len(time), 2), np.bool_)
    for number, lag in enumerate(lags):
        cycle, phase = np.divmod(time - lag + 1.2, 1.2)
        swing = np.clip(phase / 0.4, 0.0, 1.0)
        path[:, number, 1] = -0.3 * (cycle - 1.0 + smooth_step(swing)) - 0.25 * lag
        path[:, number, 2] = 0.1 * np.sin(np.pi * swing) ** 2
        down[:, number] = phase >= 0.4
    return path, down


def _push_ups(time: Array) -> _Plan:
    """Lower and lift a straight body on its hands."""
    down = 0.5 - 0.5 * np.cos(2.0 * np.pi * time / 2.0)
    tilt = np.radians(74.0 + 12.0 * down)
    feet = np.array([0.0, 0.75, TUCKED_ANKLE_M])
    hips = feet + 0.88 * np.stack([0.0 * tilt, -np.sin(tilt), np.cos(tilt)], axis=1)
    wrists = np.zeros((len(time), 2, 3))
    wrists[:] = ([0.28, -0.55, WRIST_M], [-0.28, -0.55, WRIST_M])
    contacts = np.zeros((len(time), 4), np.bool_)
    contacts[:, :2] = True
    along = _both(-tilt)
    return _Plan(hips, tilt, along, along, wrists, contacts, (TUCKED, TUCKED), _free(time))


def _kneel(time: Array) -> _Plan:
    """Come down onto the right knee in 0.8 s, sway, and rise; it bears from 1.8 to 4.5 s."""
    up = 1.0 - smooth_step((time - 1.0) / 0.8) + smooth_step((time - 4.5) / 0.8)
    thigh = 0.15 * np.sin(2.0 * np.pi * 0.5 * time)
    hips = _above_knees(time, thigh)
    hips[:, 2] += 0.35 * up
    contacts = np.zeros((len(time), 4), np.bool_)
    contacts[:, 3] = (time >= 1.8) & (time <= 4.5)
    ankles = _free(time)
    ankles[:, 0] = FRONT
    shins = np.full((len(time), 2), -np.pi / 2)
    return _Plan(
        hips, np.zeros_like(time), _both(thigh), shins, _free(time), contacts, (FLAT, INSTEP),
        ankles,
    )  # fmt: skip


def _pick_up(time: Array) -> _Plan:
    """Bend down until the hands are 15 cm above the floor for a second, and up again."""
    down = smooth_step((time - 1.0) / 1.2) - smooth_step((time - 3.2) / 1.2)
    hips = np.tile([0.0, 0.0, 0.93], (len(time), 1))
    hips[:, 2] -= 0.4 * down
    thigh = np.arccos(np.clip((hips[:, 2] - 0.14) / 0.83, -1.0, 1.0))
    wrists = np.zeros((len(time), 2, 3))
    wrists[..., 0] = (0.2, -0.2)
    wrists[..., 1] = (-0.05 - 0.4 * down)[:, None]
    wrists[..., 2] = (0.85 - 0.7 * down)[:, None]
    none = np.zeros((len(time), 4), np.bool_)
    return _Plan(
        hips, 1.0 * down, _both(thigh), _both(-thigh), wrists, none, (FLAT, FLAT), _free(time)
    )


def _above_knees(time: Array, thigh: Array) -> Array:
    """Return hips above knees that stay, of an upright or tilted pelvis."""
    hips = np.zeros((len(time), 3))
    hips[:, 1] = THIGH_M * np.sin(thigh)
    hips[:, 2] = KNEE_M + THIGH_M * np.cos(thigh)
    return hips


def _free(time: Array) -> Array:
    return np.full((len(time), 2, 3), np.nan)


def _both(values: Array) -> Array:
    return np.stack([values, values], axis=1)


PLANS: dict[str, Callable[[Array], _Plan]] = {
    "on hands and knees": _on_all_fours,
    "walk on hands and feet": _crawl,
    "push-ups": _push_ups,
    "kneel down": _kneel,
    "pick up": _pick_up,
}


def joints_of(support: str) -> Sequence[str]:
    """Return the joints of a hand or knee, or the hips, in these bodies."""
    if support == "hips":
        return ("Hips",)
    side = "Left" if support.startswith("left") else "Right"
    return (f"{side}Hand", f"{side}Hand_end") if support.endswith("Hand") else (f"{side}Leg",)
