"""Clean poses from the joints of a depth camera, where its tracker was wrong or lost them.

>>> import numpy as np
>>> from solvers.motion import SENSOR_JOINTS, JointRecording, Sensor, Tracks
>>> from solvers.motion.humanoid import POSTURE_JOINTS, posture_joint_indices
>>> from solvers.motion.humanoid import postures_from_motion
>>> from solvers.reconstruction import build_posture_library, reconstruct_postures
>>> from solvers.samples import GaitSettings, walking_gait
>>> walk = walking_gait(GaitSettings(duration=1.0, frame_rate=30.0))
>>> names = SENSOR_JOINTS[Sensor.KINECT_V1]
>>> roles = {column: role for role, column in posture_joint_indices(names).items()}
>>> order = [POSTURE_JOINTS.index(roles[column]) for column in range(len(names))]
>>> true = postures_from_motion(walk)[:, order]
>>> hand = posture_joint_indices(names)["leftHand"]
>>> tracked = true.copy()
>>> tracked[10:20, hand] = np.nan
>>> recording = JointRecording(Tracks(names, tracked, 30.0), None, Sensor.KINECT_V1)
>>> result = reconstruct_postures(recording, build_posture_library([walk]))
>>> errors = np.linalg.norm(result.tracks.positions - true, axis=-1)
>>> bool(errors[10:20, hand].max() < 0.05)
True
"""

from typing import TYPE_CHECKING

from ..import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .joint_rotations import Reconstruction
    from .live_actor import LiveActor, measure_actor
    from .live_reconstructor import LivePose, LiveReconstructor, ObservedFrame
    from .pose_completion import PostureSettings, reconstruct_postures
    from .pose_library import (
        PostureLibrary,
        PostureLibrarySettings,
        build_posture_library,
        load_posture_library,
    )
    from .reconstruct import ReconstructMethod, ReconstructSettings, reconstruct
    from .reliability import (
        Reliability,
        ReliabilityMethod,
        ReliabilitySettings,
        measure_reliability,
    )
    from .residual_correction import (
        CorrectionMethod,
        CorrectionSettings,
        ResidualMethod,
        ResidualPrior,
        ResidualPriorSettings,
        correct_postures,
        learn_residual_prior,
        load_residual_prior,
    )

__all__ = [
    "CorrectionMethod",
    "CorrectionSettings",
    "LiveActor",
    "LivePose",
    "LiveReconstructor",
    "ObservedFrame",
    "PostureLibrary",
    "PostureLibrarySettings",
    "PostureSettings",
    "ReconstructMethod",
    "ReconstructSettings",
    "Reconstruction",
    "Reliability",
    "ReliabilityMethod",
    "ReliabilitySettings",
    "ResidualMethod",
    "ResidualPrior",
    "ResidualPriorSettings",
    "build_posture_library",
    "correct_postures",
    "learn_residual_prior",
    "load_posture_library",
    "load_residual_prior",
    "measure_actor",
    "measure_reliability",
    "reconstruct",
    "reconstruct_postures",
]

import_on_demand(__name__)
