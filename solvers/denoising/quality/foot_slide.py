"""Measure how far planted feet slide."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...arrays import Array, Flags
from ...errors import InvalidMotionError
from ...feet import find_foot_joints, find_foot_points, find_legs, sole_points
from ...motion import Motion, Tracks, WorldPoses
from ...motion.humanoid import SIDES, HumanoidMap, contacts_of_points, detect_contacts
from ...signals import find_runs


@dataclass(frozen=True, eq=False)
class FootSlide:
    """Horizontal motion of one foot in contact.

    Attributes
    ----------
    side : "left" or "right"
    joint : str
        Name of the ankle.
    contact : bool, shape (n_frames,)
    steps : float array, shape (n_frames, 2), meters
        Horizontal displacement since the previous frame; NaN outside contact and where not
        observed.
    frame_rate : float, hertz
    """

    side: str
    joint: str
    contact: Flags
    steps: Array
    frame_rate: float

    @property
    def speed(self) -> Array:
        """Horizontal speed, shape (n_frames,), m/s; NaN where `steps` is."""
        return np.asarray(np.linalg.norm(self.steps, axis=1) * self.frame_rate)

    @property
    def mean_speed(self) -> float:
        """Mean horizontal speed in contact, m/s; NaN where the foot is never in contact."""
        observed = self.speed[np.isfinite(self.speed)]
        return float(observed.mean()) if len(observed) else float("nan")

    @property
    def slides(self) -> tuple[tuple[int, int, float], ...]:
        """First frame, frame after the last one and displacement (m) of each contact.

        Contacts end where the foot is not observed, and at cuts.
        """
        return tuple(
            (start - 1, stop, float(np.linalg.norm(self.steps[start:stop].sum(axis=0))))
            for start, stop in find_runs(np.isfinite(self.steps).all(axis=1))
        )

    @property
    def longest(self) -> float:
        """Longest displacement from the start to the end of one contact, meters."""
        return max((slide for *_, slide in self.slides), default=0.0)

    @property
    def distance(self) -> float:
        """Distance covered in contact over the entire take, meters."""
        return float(np.nansum(self.speed) / self.frame_rate)


class FootPoints(NamedTuple):
    """Points of a foot over time.

    Attributes
    ----------
    side : "left" or "right"
    joint : str
        Name of the ankle.
    points : shape (n_frames, n_points, 3), meters
    """

    side: str
    joint: str
    points: Array


def foot_paths(
    tracks: Tracks, humanoid_map: HumanoidMap | None = None
) -> tuple[FootPoints, ...]:
    """Return ankle and toe of both feet, named as joints; none if one is missing."""
    points = find_foot_points(tracks, humanoid_map)
    if points is None:
        return ()
    return tuple(
        FootPoints(side, tracks.names[each[0]], tracks.positions[:, each])
        for side, each in zip(SIDES, points, strict=True)
    )


def sole_paths(
    motion: Motion, poses: WorldPoses, humanoid_map: HumanoidMap | None = None
) -> tuple[FootPoints, ...]:
    """Return ankle, heel, ball and tip of both feet; none if one is missing."""
    joints = find_foot_joints(motion.skeleton, humanoid_map)
    if joints is None:
        return ()
    soles = {leg.ankle: leg for leg in find_legs(motion.skeleton, humanoid_map)}
    paths = []
    for side, each in zip(SIDES, joints, strict=True):
        points = [poses.positions[:, joint] for joint in each]
        if leg := soles.get(int(each[0])):
            sole = sole_points(motion.skeleton, leg)
            points = [points[0], *(point.position(poses) for point in sole)]
        paths.append(FootPoints(side, motion.skeleton.names[each[0]], np.stack(points, axis=1)))
    return tuple(paths)


def measure_foot_slides(
    recording: Motion | Tracks,
    feet: tuple[FootPoints, ...],
    contacts: Flags | None,
    humanoid_map: HumanoidMap | None,
    cuts: tuple[int, ...],
) -> tuple[FootSlide, ...]:
    """Measure all feet of a recording, in contacts that are detected if not given.

    Contacts have the shape (n_frames, 2), the left foot first; cuts are frames.

    Raises InvalidMotionError if the contacts do not fit the recording.
    """
    if contacts is not None and np.shape(contacts) != (recording.n_frames, len(SIDES)):
        raise InvalidMotionError(
            f"Contacts need shape ({recording.n_frames}, 2), not {np.shape(contacts)}."
        )
    if not feet:
        return ()
    if contacts is None:
        contacts = (
            detect_contacts(recording, humanoid_map)
            if isinstance(recording, Motion)
            else contacts_of_points(
                np.stack([foot.points for foot in feet], axis=1), recording.frame_rate
            )
        )
    return tuple(
        measure_foot_slide(foot, contacts[:, index], recording.frame_rate, cuts)
        for index, foot in enumerate(feet)
    )


def measure_foot_slide(
    foot: FootPoints, contact: Flags, frame_rate: float, cuts: tuple[int, ...] = ()
) -> FootSlide:
    """Measure the horizontal speed of the slowest part of the foot.

    A rolling foot rotates about its heel, its ball, and then the tip of its toes. The slide is
    the motion that all its points share, so the slowest point counts.

    Parameters
    ----------
    foot : FootPoints
    contact : shape (n_frames,)
        A step counts if both of its frames are in contact.
    frame_rate : float, hertz
    cuts : tuple of int
        First frames of later segments; no step spans a cut.
    """
    steps = np.full((len(foot.points), 2), np.nan)
    displacements = np.diff(foot.points[..., :2], axis=0)
    lengths = np.nan_to_num(np.linalg.norm(displacements, axis=-1), nan=np.inf)
    slowest = displacements[np.arange(len(displacements)), lengths.argmin(axis=1)]
    steps[1:] = np.where((contact[1:] & contact[:-1])[:, None], slowest, np.nan)
    steps[list(cuts)] = np.nan
    return FootSlide(foot.side, foot.joint, contact, steps, frame_rate)
