"""Recordings of other sensors, rooms and people without ground truth: before and after."""

from collections.abc import Callable
from functools import partial
from time import process_time

import numpy as np

from solvers.arrays import Array
from solvers.motion import JointRecording, Tracks, forward_kinematics
from solvers.motion.humanoid.body_size import segment_lengths
from solvers.motion.humanoid.posture_joints import posture_positions
from solvers.motion.skeletons.joint_recording import TRACKED
from solvers.reconstruction import (
    Reconstruction,
    ReconstructMethod,
    ReconstructSettings,
    measure_reliability,
    reconstruct,
)
from solvers.recordings import read_recording

from ..peers.gap_fillers import linear
from ..peers.smoothers import gaussian
from ..shared.clips import DATA
from ..shared.tables import number, table

FILES = {
    "irds": "*_stand.txt",
    "irds, wheelchair": "*_wheelchair.txt",
    "kimore": "*.csv",
    "msr_action3d": "a*_s01_e01_*.txt",
    "laban": "Ges*.csv",
}
N_FILES = 5
SOUND, WRONG = 0.8, 0.5
COLUMNS = (
    "length deviation, cm", "jerk, m/s³", "displacement, reliable joints, cm",
    "displacement, unreliable joints, cm", "ms per frame",
)  # fmt: skip


def recordings(n_repetitions: int) -> list[str]:
    """Return one table for each data set."""
    return [_table(name, takes_of(name)) for name in FILES]


def takes_of(name: str) -> list[JointRecording]:
    """A few takes, evenly from all there are."""
    paths = sorted((DATA / "kinect" / name.split(",")[0]).glob(FILES[name]))
    chosen = np.unique(np.linspace(0, len(paths) - 1, N_FILES).round().astype(int))
    found = [read_recording(paths[index]) for index in chosen]
    return [take for take in found if isinstance(take, JointRecording)]


def _table(name: str, takes: list[JointRecording]) -> str:
    reliabilities = [measure_reliability(take).combined for take in takes]
    rows = {
        "before": _row(takes, reliabilities, lambda take: take.tracks),
        "linear, Gaussian, 2 frames": _row(takes, reliabilities, _filtered),
    }
    for method in (
        ReconstructMethod.POSTURES,
        ReconstructMethod.RESIDUALS,
        ReconstructMethod.BOTH,
    ):
        words = "ours (both)" if method is ReconstructMethod.BOTH else method.value
        solve = partial(reconstruct, settings=ReconstructSettings(method=method))
        rows[words] = _row(takes, reliabilities, _tracks(solve))
        if method is ReconstructMethod.BOTH:
            rows["ours, skeleton"] = _row(takes, reliabilities, _skeleton(solve))
    words = f"{sum(take.n_frames for take in takes)} frames, {_flags(takes)}"
    reliability = np.concatenate([one.ravel() for one in reliabilities])
    below = (reliability < WRONG).mean()
    words += f"; mean reliability {reliability.mean():.2f}, {below:.1%} below {WRONG:g}"
    return f"**{name}** ({len(takes)} takes, {words})\n\n" + table(["", *COLUMNS], rows) + "\n"


def _flags(takes: list[JointRecording]) -> str:
    states = [take.tracking_state for take in takes if take.tracking_state is not None]
    if not states:
        return "no tracking state"
    guessed = np.concatenate([(state < TRACKED).ravel() for state in states])
    return f"{guessed.mean():.1%} of joints not tracked"


def _filtered(take: JointRecording) -> Tracks:
    flat = take.tracks.positions.reshape(take.n_frames, -1)
    smooth = gaussian(linear(flat, take.frame_rate), take.frame_rate, 2.0)
    return take.tracks.with_positions(smooth.reshape(take.tracks.positions.shape))


def _tracks(solve: Callable[[JointRecording], Reconstruction]) -> Callable[..., Tracks]:
    return lambda take: solve(take).tracks


def _skeleton(solve: Callable[[JointRecording], Reconstruction]) -> Callable[..., Tracks]:
    def joints(take: JointRecording) -> Tracks:
        motion = solve(take).motion
        world = forward_kinematics(motion).positions
        shared_names = [name for name in take.names if name in motion.skeleton.names]
        indices = [motion.skeleton.names.index(name) for name in shared_names]
        positions = np.full((motion.n_frames, take.n_joints, 3), np.nan)
        positions[:, [take.names.index(name) for name in shared_names]] = world[:, indices]
        return take.tracks.with_positions(positions)

    return joints


def _row(
    takes: list[JointRecording],
    reliabilities: list[Array],
    solve: Callable[[JointRecording], Tracks],
) -> list[str]:
    lengths, jerks, reliable, unreliable, taken = [], [], [], [], 0.0
    for take, reliability in zip(takes, reliabilities, strict=True):
        started = process_time()
        made = solve(take)
        taken += process_time() - started
        lengths.append(_varying(made))
        jerks.append(_jerk(made))
        moved = np.linalg.norm(made.positions - take.tracks.positions, axis=-1)
        reliable.append(moved[(reliability > SOUND) & np.isfinite(moved)])
        unreliable.append(moved[(reliability < WRONG) & np.isfinite(moved)])
    n_frames = sum(take.n_frames for take in takes)
    jitter = [np.concatenate(one) for one in (reliable, unreliable)]
    figures = [
        100.0 * float(np.mean(lengths)),
        float(np.mean(jerks)),
        *(100.0 * float(one.mean()) if len(one) else np.nan for one in jitter),
    ]
    return [*map(number, figures), f"{1e3 * taken / n_frames:.2f}"]


def _varying(made: Tracks) -> float:
    """Mean over bones between joints of postures of the deviation of their lengths."""
    found = segment_lengths(posture_positions(made))[:, 1:]
    return float(np.nanmean(np.nanstd(found[:, np.isfinite(found).any(axis=0)], axis=0)))


def _jerk(made: Tracks) -> float:
    third = np.diff(posture_positions(made), 3, axis=0) * made.frame_rate**3
    return float(np.nanmean(np.linalg.norm(third, axis=-1)))
