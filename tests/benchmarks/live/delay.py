"""Delay of a live frame by stage: from the sender's socket to what Blender looks at."""

import socket
import tempfile
from pathlib import Path
from time import thread_time
from typing import NamedTuple

import numpy as np

from solvers.feet import LivePlanting
from solvers.motion import JointRecording, Motion, Skeleton, find_humanoid_map
from solvers.motion import forward_kinematics as world_poses_of
from solvers.recordings.streams import (
    PoseFrame,
    StreamListener,
    StreamProtocol,
    encode_recording,
)
from solvers.retargeting import LiveRetargeting
from solvers.rotations import IDENTITY
from solvers.workflows import LiveTake, PoseTake

from ..importing.bench_scene_io import load_checkout

POLL_MS, LOOK_MS = 2.0, 1000.0 / 120.0
"""Longest waits: for the next look at the socket, and for Blender's next look at the poses
(`POLL_INTERVAL_S`, `LOOK_INTERVAL_S`)."""


class Delay(NamedTuple):
    """Milliseconds of processor time of each frame after calibration."""

    receive: list[float]
    solve: list[float]
    rig: list[float]
    pass_on: list[float]

    def cells(self) -> list[str]:
        """Return the medians, and the sum of the 95th percentiles and of the longest waits."""
        medians = [float(np.median(stage)) for stage in self]
        late = sum(float(np.percentile(stage, 95)) for stage in self) + POLL_MS + LOOK_MS
        return [*(f"{each:.1f}" for each in medians), f"{late:.0f}"]


def measure_delay(
    recording: Motion | JointRecording, protocol: StreamProtocol, target: Skeleton
) -> Delay:
    """Send a recording frame by frame, and measure what each stage takes."""
    load_checkout()
    from mocap_ext.mocap_assist.jobs.protocol import PREVIEWS, append_preview, read_previews

    take, rig, delay, offset = None, None, Delay([], [], [], []), 0
    with (
        StreamListener(0) as listener,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender,
        tempfile.TemporaryDirectory() as folder,
        (Path(folder) / PREVIEWS).open("wb") as file,
    ):
        sender.connect(listener.receiver.address)
        for packets in encode_recording(recording, protocol):
            for datagram in packets.datagrams:
                sender.send(datagram)
            clock = [thread_time()]
            frames = listener.poll()
            clock.append(thread_time())
            if not frames:
                continue
            if take is None:
                take = PoseTake() if isinstance(frames[0], PoseFrame) else LiveTake()
            poses = take.add(frames)
            clock.append(thread_time())
            if rig is None and take.calibration is not None:
                rig = _Rig(take.calibration, target)
            elif rig is not None and poses:
                keys = rig.keys(poses[-1].motion)
                clock.append(thread_time())
                append_preview(file, keys)
                _, offset = read_previews(Path(folder), offset)
                clock.append(thread_time())
                for stage, elapsed in zip(delay, np.diff(clock), strict=True):
                    stage.append(1e3 * float(elapsed))
    return delay


class _Rig:
    """A rig with a control for each joint of a skeleton."""

    def __init__(self, calibration: Motion, skeleton: Skeleton) -> None:
        from mocap_ext.mocap_assist.scene.controls import Carried, Control, TargetRig, keys_of

        roles = find_humanoid_map(skeleton)
        source = find_humanoid_map(calibration.skeleton)
        self._retargeting = LiveRetargeting(calibration, source, skeleton, roles)
        self._planting = LivePlanting(self._retargeting.update(calibration), roles)
        controls = tuple(
            Control(name, joint, joint, parent, IDENTITY, IDENTITY, position, True, not joint)
            for joint, (name, parent, position) in enumerate(
                zip(skeleton.names, skeleton.parents, skeleton.rest_positions, strict=True)
            )
        )
        self._target = TargetRig(skeleton, roles, controls, 1.0)
        self._still = Carried(IDENTITY[None], np.zeros(3), np.zeros((1, 3)))
        self._keys_of = keys_of

    def keys(self, pose: Motion) -> list[np.ndarray]:
        """Return the channels of all controls."""
        posed = self._planting.update(self._retargeting.update(pose), pose.dt).motion
        poses = world_poses_of(posed)
        keys = self._keys_of(self._target, poses, self._still)
        return [each.rotations.astype(np.float32) for each in keys.values()]
