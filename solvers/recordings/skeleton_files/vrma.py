"""Read VRM animations (`.vrma`): glTF whose extension names the humanoid bones."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import Motion, Skeleton
from ...progress import Progress, Remark, unwatched
from ...rotations import IDENTITY, inverse, multiply, normalize, rotate, slerp, unroll
from ..containers import GlbFile, UniqueNames, check_n_joints, printable, vector
from ..conventions import (
    check_scale,
    correct_stated_unit,
    describe_guesses,
    file_conventions,
    rotations_z_up_from_y_up,
    z_up_from_y_up,
)

EXTENSION = "VRMC_vrm_animation"
MARK = f'"{EXTENSION}"'.encode()
HIPS = "hips"
RATES_HZ = (30.0, 24.0, 25.0, 60.0, 50.0, 100.0, 120.0)
"""Rates tried for the keys, which are times without one."""
DEFAULT_RATE_HZ = 60.0
KEY_TOLERANCE_S = 1e-3
"""Seconds by which a key may be off a frame: rounding of the times in a file."""
MAX_FRAMES = 1_000_000
MAX_POSES = 1 << 25
"""Rotations of joints, and keys. It bounds the memory: 1.1 GB, and some 4 GB on the way."""
MAX_DEPTH, MAX_BONES = 200, 500
STEP, CUBIC = "STEP", "CUBICSPLINE"


class _Channel(NamedTuple):
    """Keys of a property of a node."""

    times: Array
    values: Array
    is_step: bool


class _Node(NamedTuple):
    """A node in the rest pose, and its keys."""

    parent: int
    position: Array
    rotation: Array
    """w x y z."""
    channels: Mapping[str, _Channel]


def is_vrma(head: bytes) -> bool:
    """Return whether the JSON of a glTF file names this extension."""
    return head.startswith(b"glTF") and MARK in head


def read_vrma(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Motion:
    """Read a VRM animation [1]_, in meters, Z up; joints are called by their humanoid roles.

    The rest pose is that of the file, a T-pose by definition, in which joints do not rotate.
    Nodes between two bones are kept still in it. Keys have times but no rate: it is the first
    of common rates on which all keys are, otherwise 60 Hz. Expressions and gaze are not read.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: 1, or what makes an absurd body plausible; converters of BVH wrote centimeters.
    progress : Progress

    Raises
    ------
    InvalidFileError
        The file is damaged or too large, or has no hips or no animation.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [1] VRM Consortium, VRMC_vrm_animation-1.0.
    """
    check_scale(scale)
    file = GlbFile(path)
    nodes = _nodes(file)
    bones = _bones(file, len(nodes))
    names, order, parents = _tree(file, nodes, bones)
    times, rate = _sample_times(file, nodes, order)
    _check_n_poses(file, len(times) * len(order))
    progress(0.5, "Reading")
    unit = 1.0 if scale is None else scale
    rest = np.array([_world_rest(nodes, node)[1] for node in order])
    rotations = np.zeros((len(times), len(order), 4))
    for joint, node in enumerate(order):
        world_rotation, _ = _world_rest(nodes, nodes[node].parent)
        change = multiply(_sampled_rotation(nodes[node], times), inverse(nodes[node].rotation))
        rotations[:, joint] = multiply(
            multiply(world_rotation, change), inverse(world_rotation)
        )
    offsets = rest - np.where(np.array(parents)[:, None] >= 0, rest[parents], 0.0)
    world_rotation, origin = _world_rest(nodes, nodes[order[0]].parent)
    path_of_hips = origin + rotate(world_rotation, _sampled_position(nodes[order[0]], times))
    stated = file_conventions("Y", unit=unit)
    skeleton = Skeleton(tuple(names), tuple(parents), z_up_from_y_up(unit * offsets))
    motion = Motion(
        skeleton,
        rotations_z_up_from_y_up(normalize(rotations)),
        z_up_from_y_up(unit * path_of_hips),
        rate,
        stated,
    )
    corrected = correct_stated_unit(motion, stated, 1.0) if scale is None else motion
    for message in ("Reading", *map(Remark, describe_guesses(corrected))):
        progress(1.0, message)
    return corrected


def _bones(file: GlbFile, n_nodes: int) -> dict[int, str]:
    """Return the role of each node that is a humanoid bone."""
    try:
        listed = file.json["extensions"][EXTENSION]["humanoid"]["humanBones"]
        found = {bone["node"]: str(role) for role, bone in listed.items()}
    except (KeyError, TypeError, AttributeError):
        found = {}
    if HIPS not in found.values():
        raise InvalidFileError(
            f"{file.path} is a VRM animation without hips. Export it with the bones of a body."
        )
    is_valid = all(isinstance(node, int) and 0 <= node < n_nodes for node in found)
    if not is_valid or len(found) > MAX_BONES:
        raise file.damaged()
    return found


def _nodes(file: GlbFile) -> list[_Node]:
    """Return all nodes with the keys of the first animation."""
    listed = file.items("nodes")
    check_n_joints(file.path, len(listed))
    parents = [-1] * len(listed)
    for index, node in enumerate(listed):
        children = node.get("children", [])
        for child in children if isinstance(children, list) else []:
            if not isinstance(child, int) or not 0 <= child < len(listed) or child == index:
                raise file.damaged()
            parents[child] = index
    keys: list[dict[str, _Channel]] = [{} for _ in listed]
    n_keys = 0
    for animation in file.items("animations")[:1]:
        samplers = _objects(animation.get("samplers"))
        for channel in _objects(animation.get("channels")):
            target = channel.get("target")
            if not isinstance(target, dict):
                continue
            moved, kind = target.get("node"), target.get("path")
            if isinstance(moved, int) and 0 <= moved < len(keys) and kind in _SIZES:
                keys[moved][kind] = _channel(file, samplers, channel.get("sampler"), kind)
                n_keys += len(keys[moved][kind].times)
                _check_n_poses(file, n_keys)  # Channels may share their numbers.
    return [
        _Node(
            parents[index],
            vector(node.get("translation"), (0.0, 0.0, 0.0)),
            _unit(np.roll(vector(node.get("rotation"), (0.0, 0.0, 0.0, 1.0)), 1)),
            keys[index],
        )
        for index, node in enumerate(listed)
    ]


def _check_n_poses(file: GlbFile, n_poses: int) -> None:
    if n_poses > MAX_POSES:
        raise InvalidFileError(
            f"{file.path} has {n_poses:,} poses of joints; {MAX_POSES:,} can be read. Export a"
            " shorter part."
        )


_SIZES = {"rotation": 4, "translation": 3}


def _objects(value: Any) -> list[Mapping[str, Any]]:
    return [each for each in value if isinstance(each, dict)] if isinstance(value, list) else []


def _unit(rotation: Array) -> Array:
    return np.where(rotation @ rotation > 0.0, normalize(rotation), IDENTITY)


def _channel(
    file: GlbFile, samplers: list[Mapping[str, Any]], index: Any, kind: str
) -> _Channel:
    if not isinstance(index, int) or not 0 <= index < len(samplers):
        raise file.damaged()
    sampler = samplers[index]
    times, values = file.numbers(sampler.get("input")), file.numbers(sampler.get("output"))
    if sampler.get("interpolation") == CUBIC:
        values = values[1::3]  # between its tangents
    times = times[:, 0]
    if (
        values.shape != (len(times), _SIZES[kind])
        or not (np.isfinite(times).all() and np.isfinite(values).all())
        or (np.diff(times) < 0.0).any()
    ):
        raise file.damaged()
    if kind == "rotation":
        if (np.linalg.norm(values, axis=1) == 0.0).any():
            raise file.damaged()
        values = unroll(normalize(np.roll(values, 1, axis=1)))
    return _Channel(times, values, sampler.get("interpolation") == STEP)


def _tree(
    file: GlbFile, nodes: list[_Node], bones: Mapping[int, str]
) -> tuple[list[str], list[int], list[int]]:
    """Return names, nodes and parents of the bones below the hips, parents first."""
    above: dict[int, int] = {}
    depths: dict[int, int] = {}
    for node in bones:
        at, depth, parent = nodes[node].parent, 0, -1
        while at >= 0:
            depth += 1
            if depth > MAX_DEPTH:  # a circle
                raise file.damaged()
            parent = at if parent < 0 and at in bones else parent
            at = nodes[at].parent
        above[node], depths[node] = parent, depth
    hips = next(node for node, role in bones.items() if role == HIPS)
    kept = {hips: 0}
    for node in sorted(bones, key=lambda node: (depths[node], node)):
        if above[node] in kept:
            kept.setdefault(node, len(kept))
    given = UniqueNames()
    names = [given.give(printable(bones[node])) for node in kept]
    return names, list(kept), [kept[above[node]] if node != hips else -1 for node in kept]


def _world_rest(nodes: list[_Node], index: int) -> tuple[Array, Array]:
    """Return rotation and position of a node in the world, in the rest pose; -1: the world."""
    chain, at = [], index
    while at >= 0:
        chain.append(at)
        at = nodes[at].parent
    rotation, position = np.array(IDENTITY), np.zeros(3)
    for node in reversed(chain):
        position = position + rotate(rotation, nodes[node].position)
        rotation = multiply(rotation, nodes[node].rotation)
    return rotation, position


def _sample_times(file: GlbFile, nodes: list[_Node], bones: list[int]) -> tuple[Array, float]:
    """Return the times of the frames in seconds, from 0, and their rate."""
    keys = [channel.times for bone in bones for channel in nodes[bone].channels.values()]
    if not keys:
        raise InvalidFileError(
            f"{file.path} has no animation of a bone, only a pose or expressions. Export a"
            " motion."
        )
    times = np.unique(np.concatenate(keys))
    off = {rate: np.abs(times - np.round(times * rate) / rate).max() for rate in RATES_HZ}
    rate = next((each for each in off if off[each] < KEY_TOLERANCE_S), DEFAULT_RATE_HZ)
    n_frames = int(np.floor(times[-1] * rate + 0.5)) + 1
    if not 0 < n_frames <= MAX_FRAMES:
        raise file.damaged()
    return np.arange(n_frames) / rate, rate


def _sampled_rotation(node: _Node, times: Array) -> Array:
    channel = node.channels.get("rotation")
    if channel is None:
        return np.broadcast_to(node.rotation, (len(times), 4))
    before, after, fraction = _between(channel, times)
    return slerp(channel.values[before], channel.values[after], fraction)


def _sampled_position(node: _Node, times: Array) -> Array:
    channel = node.channels.get("translation")
    if channel is None:
        return np.broadcast_to(node.position, (len(times), 3))
    before, after, fraction = _between(channel, times)
    start, stop = channel.values[before], channel.values[after]
    return np.asarray(start + fraction[:, None] * (stop - start))


def _between(channel: _Channel, times: Array) -> tuple[Array, Array, Array]:
    """Return the keys around each time, and the fraction of the way between them."""
    last = len(channel.times) - 1
    before = np.clip(np.searchsorted(channel.times, times, side="right") - 1, 0, last)
    after = np.minimum(before + 1, last)
    span = channel.times[after] - channel.times[before]
    fraction = (times - channel.times[before]) / np.where(span > 0.0, span, 1.0)
    fraction = np.clip(np.where(span > 0.0, fraction, 0.0), 0.0, 1.0)
    return before, after, np.zeros_like(fraction) if channel.is_step else fraction
