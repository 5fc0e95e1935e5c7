"""Put a take on the floor where the file has none."""

from dataclasses import replace
from typing import TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...motion import (
    JointRecording,
    Motion,
    Tracks,
    find_humanoid_map,
    roles_by_name,
    world_poses,
)
from .body_unit import stature
from .file_axes import conventions_of

Recording = TypeVar("Recording", bound=Motion | Tracks | JointRecording)

SOLE_M = {"Toes": 0.02, "Foot": 0.07, "Hand": 0.03, "LowerLeg": 0.05, "hips": 0.1, "head": 0.1}
"""Height of a joint above what it stands or lies on, meters, by the end of its role. Chosen by
hand, to 0.01 m."""
OTHER_SOLE_M = 0.06
"""The same of other joints, meters. Chosen by hand within the 0.02 to 0.1 m of `SOLE_M`."""
FLOOR_PERCENTILE = 5.0
"""Percentile of the heights while the body rests on something. Measured: in 117 takes of CMU
and HDM05, which have a floor, the level is at most 10 cm off; the minimum is up to 26 cm below
the floor, the median up to 21 cm off."""
REST_S = 0.1
"""Seconds for which a body that stands or lies on something neither rises nor falls. Sweep on
the same takes: with 0.2 s hops, which rest for less, are up to 40 cm off."""
MAX_REST_SPEED = 0.25
"""Meters per second of rising or falling below which a body rests on something. Sweep: with
0.125 a hop of HDM05 is 41 cm off; with 0.5 the feet of a take of MSR Action3D, which sink as
the actor bends, put the floor 17 cm too low instead of 4."""
MIN_BELOW_FRACTION = 0.3
"""Depth of the feet below height 0, relative to the stature, of a take without a floor.
Measured: it is 0 on a floor, and 0.40 to 0.60 in the five takes of docs/benchmarks/importing.md
whose origin is in the body."""
MIN_UPRIGHT_FRACTION = 0.2
"""Height of the head above the hips, relative to the stature, of an actor who stands or sits.
Measured: 0.27 to 0.36 in upright bodies of several makers; x2 fails
`test_an_actor_far_below_the_floor_is_put_on_it`."""
MAX_FLIGHT_STATURES = 10.0
"""Distance from height 0, in statures, above which units of positions and bones differ rather
than heights. By definition of the units: confused ones give factors of 2.5 to 100."""
MIN_OFF_FLOOR_FRACTION = 0.08
"""Distance of the lowest level from height 0, relative to the stature, from which the report
asks a question. Measured: 0.04 and less in 300 takes that stand on a floor, and 0.08 to 0.12 in
six that are 15 to 23 cm off. It decides a sentence of the report only."""
MAX_HIPS_FRACTION = 0.15
"""Height of the hips, relative to the stature, of a take whose origin is the hips. Measured:
they are at 0.00 to 0.08 in four such takes of docs/benchmarks/importing.md, and at 0.5 where an
actor stands on a floor."""
MAX_FLAT_HIPS_FRACTION = 0.03
"""Median distance of the hips from height 0, relative to the stature, of a take whose origin is
the hips, in any pose. Chosen by hand: half of that of those who lie on a floor, 10 cm
(`SOLE_M`)."""
PLACED_M = 0.005
"""Distance from height 0, meters, up to which a take stands on it. It bounds the rounding of
keys of a take that was put there; measured floors are farther off."""
PLACED_BONES_M = 0.04
"""The same of bones of constant length that were solved from such joints, meters. Measured:
they are up to 0.034 m off in eleven takes of five sensors."""
PLACED = "No floor was measured, so the lowest level that the body rests on became height 0."
NO_FLOOR = (
    ("torso_7", "l_toes", "r_toes"),
    ("left_collar", "right_collar", "spine3", "left_foot"),
)
"""Joints of mocopi, and of SMPL, in BVH files: nothing of the room was measured."""
SIDES_OF_FLOOR = ("above", "below")


def put_on_floor(recording: Recording) -> Recording:
    """Move a take up or down so that the lowest level that the body rests on is height 0.

    A body rests where its lowest joint neither rises nor falls: feet that stand, hands of a
    handstand, the back of an actor who lies. So a jump is no floor, and neither are single
    wrong frames.
    """
    lift = -floor_level(recording)
    if isinstance(recording, Motion):
        shifted = recording.root_positions + np.array([0.0, 0.0, lift])
        return replace(recording, root_positions=shifted)
    if isinstance(recording, JointRecording):
        return cast(Recording, recording.with_tracks(_lifted(recording.tracks, lift)))
    return cast(Recording, _lifted(recording, lift))


def keep_on_floor(
    before: Motion | JointRecording,
    after: Recording,
    source: Motion | JointRecording | None = None,
) -> Recording:
    """Return a result at height 0 if its take was put there; otherwise unchanged.

    Trackers place ankles some centimeters above the true ones, so that corrected feet of a take
    that was put on the floor would be below it. Takes in the space of their sensor stay there,
    and so do those with a measured floor.

    Parameters
    ----------
    before : Motion or JointRecording
    after : Motion, Tracks or JointRecording
    source : Motion or JointRecording, optional
        Recording whose conventions say that no floor was measured; by default `before`.
    """
    if conventions_of(source or before).has_floor:
        return after
    tolerance = PLACED_BONES_M if isinstance(before, Motion) else PLACED_M
    return put_on_floor(after) if abs(floor_level(before)) <= tolerance else after


def describe_placement(recording: Motion | Tracks | JointRecording) -> tuple[str, ...]:
    """Return a sentence if a take has no floor of its own and stands at height 0."""
    is_placed = not conventions_of(recording).has_floor
    return (PLACED,) if is_placed and abs(floor_level(recording)) <= PLACED_M else ()


def floor_level(recording: Motion | Tracks | JointRecording) -> float:
    """Return the lowest height that the body rests on; 0 if nothing is observed."""
    lowest = _lowest(recording)
    if not len(lowest):
        return 0.0
    resting = lowest[_rests(lowest, recording.frame_rate)]
    return float(np.percentile(resting if len(resting) else lowest, FLOOR_PERCENTILE))


def _lowest(recording: Motion | Tracks | JointRecording) -> Array:
    """Return the height below the body in each frame with an observed joint."""
    points, soles = _points(recording)
    heights = np.where(np.isfinite(points[..., 2]), points[..., 2] - soles, np.inf)
    lowest = heights.min(axis=1, initial=np.inf)
    return np.asarray(lowest[np.isfinite(lowest)])


def lacks_floor(recording: Motion | Tracks | JointRecording) -> bool:
    """Whether height 0 is not a measured floor.

    This holds for depth cameras and video models, unless their format has a floor: the hips are
    the origin, and the feet hang below. It also holds for a motion whose hips are at height 0
    in most frames, and where an upright actor is far below it in most frames.
    """
    if not conventions_of(recording).has_floor:
        return True
    if not isinstance(recording, Motion):
        return False
    names = {name.lower() for name in recording.skeleton.names}
    if any(names.issuperset(family) for family in NO_FLOOR):
        return True
    roles = find_humanoid_map(recording.skeleton).indices(recording.skeleton)
    tall = stature(recording)
    if "hips" not in roles or tall is None:
        return False
    heights = _points(recording, [roles["hips"], roles["head"], *roles.values()])[0][..., 2]
    observed = heights[np.isfinite(heights).all(axis=1)]
    if not len(observed):
        return False
    hips, head = np.median(observed[:, :2], axis=0)
    if np.median(np.abs(observed[:, 0])) < MAX_FLAT_HIPS_FRACTION * tall:
        return True
    is_upright = head - hips > MIN_UPRIGHT_FRACTION * tall
    is_origin = abs(hips) < MAX_HIPS_FRACTION * tall
    is_sunk = np.median(observed.min(axis=1)) < -MIN_BELOW_FRACTION * tall
    if not (is_upright and (is_origin or is_sunk)):
        return False
    return floor_level(recording) < -MIN_BELOW_FRACTION * tall


def question_of_floor(recording: Motion | Tracks | JointRecording) -> str:
    """Return a question if an actor never comes near height 0; otherwise nothing.

    Heights of a measured floor are kept, as of an actor on a platform. Markers lie on objects
    too, also below the floor; only where most are below height 0, there is a question.
    """
    tall, lowest = stature(recording), _lowest(recording)
    if tall is None or not len(lowest):
        return ""
    if isinstance(recording, Tracks) and np.nanmedian(recording.positions[..., 2]) >= 0.0:
        return ""
    nearest = float(np.percentile(np.abs(lowest), FLOOR_PERCENTILE))
    if nearest < MIN_OFF_FLOOR_FRACTION * tall:
        return ""
    level = float(np.median(lowest))
    side = SIDES_OF_FLOOR[level < 0.0]
    if nearest > MAX_FLIGHT_STATURES * tall:
        return (
            f"The actor stays {abs(level):.2g} m {side} the floor: positions and bone lengths"
            " of the file have different units; export it again with one unit"
        )
    return (
        f"The actor stays {abs(level):.2g} m {side} the floor; set Place on Floor to On if this"
        " is not right"
    )


def _lifted(tracks: Tracks, lift: float) -> Tracks:
    return tracks.with_positions(tracks.positions + np.array([0.0, 0.0, lift]))


def _points(
    recording: Motion | Tracks | JointRecording, joints: list[int] | None = None
) -> tuple[Array, Array]:
    """Return the joints of the body, (n_frames, n, 3), and how high each is above its sole."""
    if isinstance(recording, Motion):
        roles = find_humanoid_map(recording.skeleton).indices(recording.skeleton)
        points = world_poses(
            recording.skeleton, recording.rotations, recording.root_positions
        ).positions
    else:
        tracks = recording.tracks if isinstance(recording, JointRecording) else recording
        points = tracks.positions
        named = roles_by_name(tracks.names) if isinstance(recording, JointRecording) else {}
        roles = {role: tracks.names.index(name) for role, name in named.items()}
    if joints is not None or not roles:
        chosen = joints if joints is not None else list(range(points.shape[1]))
        return points[:, chosen], np.zeros(len(chosen))
    soles = [
        next((sole for end, sole in SOLE_M.items() if role.endswith(end)), OTHER_SOLE_M)
        for role in roles
    ]
    return points[:, list(roles.values())], np.array(soles)


def _rests(lowest: Array, frame_rate: float) -> NDArray[np.bool_]:
    """Return whether the lowest joint neither rises nor falls around each frame."""
    width = max(1, round(REST_S * frame_rate))
    if len(lowest) <= width:
        return np.ones(len(lowest), dtype=np.bool_)
    speeds = np.abs(lowest[width:] - lowest[:-width]) * frame_rate / width
    rests = np.zeros(len(lowest), dtype=np.bool_)
    rests[width // 2 : width // 2 + len(speeds)] = speeds < MAX_REST_SPEED
    return rests
