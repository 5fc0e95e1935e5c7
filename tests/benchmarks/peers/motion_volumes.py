"""A peer of retrieval: low-rank subspaces of motion volumes, as in [SJF11].

[SJF11] Sun, Junejo, Foroosh (2011). Motion retrieval using low-rank subspace decomposition of
motion volume. Computer Graphics Forum 30(7). Written from its abstract and from what [ZH14]
says of it: how far the postures of a clip are from each other, joint by joint, is a volume
(frame, frame, joint), and its projection onto few modes (higher-order SVD) is compared.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solvers.arrays import Array, Flags
from solvers.motion import Tracks

from .complete_postures import CompletePostures, learn_complete_postures, resampled


@dataclass(frozen=True)
class MotionVolumes:
    n_samples: int = 32
    n_time_modes: int = 8
    n_joint_modes: int = 8
    frame_rate: float = 30.0

    def prepare(self, clips: Sequence[Tracks]) -> "VolumeLibrary":
        complete, found = learn_complete_postures(clips, self.frame_rate)
        volumes = np.stack([volume(frames, self.n_samples) for frames in found])
        times = _modes(np.moveaxis(volumes, 1, 0), self.n_time_modes)
        joints = _modes(np.moveaxis(volumes, 3, 0), self.n_joint_modes)
        cores = np.stack([core(each, times, joints) for each in volumes])
        return VolumeLibrary(complete, cores, times, joints, self.n_samples)


@dataclass(frozen=True, eq=False)
class VolumeLibrary:
    complete: CompletePostures
    cores: Array
    times: Array
    joints: Array
    n_samples: int

    def describe(self, tracks: Tracks) -> Array:
        return core(volume(self.complete(tracks), self.n_samples), self.times, self.joints)

    def distances(self, query: Array, allowed: Flags) -> Array:
        return np.asarray(np.sqrt(((self.cores - query) ** 2).sum(axis=(1, 2, 3))))


def volume(frames: Array, n_samples: int) -> Array:
    """Return the self-similarity of each joint, shape (n_moments, n_moments, 20)."""
    samples = resampled(frames, n_samples).reshape(n_samples, -1, 3)
    return np.asarray(np.linalg.norm(samples[:, None] - samples[None], axis=-1))


def core(volume: Array, times: Array, joints: Array) -> Array:
    """Return the volume in the modes."""
    return np.einsum("abj,ap,bq,jr->pqr", volume, times, times, joints, optimize=True)


def _modes(unfolded: Array, n_modes: int) -> Array:
    rows = unfolded.reshape(len(unfolded), -1)
    return np.asarray(np.linalg.eigh(rows @ rows.T)[1][:, ::-1][:, :n_modes])
