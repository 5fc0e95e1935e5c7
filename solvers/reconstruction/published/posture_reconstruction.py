"""Reconstruct poses as published in [SHJT13]."""

from dataclasses import replace

import numpy as np

from ...arrays import Array
from ...motion import JointRecording
from ...progress import Progress, within
from ..joint_rotations import Reconstruction, build_body_postures
from ..pose_completion import (
    MODEL_ERROR_M,
    CompletedPostures,
    ObservedTake,
    PostureSettings,
    confidence_from_deviation,
    reconstruct_postures,
    synthesize,
)
from ..pose_library import PostureLibrary, index_postures
from ..pose_space import EnergyTargets, PostureSpaces
from ..reliability import ReliabilityMethod, ReliabilitySettings, measure_reliability
from .posture_search import search_sequentially


def reconstruct_published_postures(
    recording: JointRecording,
    postures: PostureLibrary | None,
    *,
    settings: PostureSettings,
    progress: Progress,
) -> Reconstruction:
    """Reconstruct poses with the reliability and the stochastic search of [1]_.

    Parameters, result and errors are those of `reconstruct_postures`; see `search_as_published`
    for the settings that count.

    References
    ----------
    .. [1] Shum, Ho, Jiang, Takagi (2013). Real-time posture reconstruction for Microsoft
       Kinect. IEEE Transactions on Cybernetics 43(5).
    """
    reliability = measure_reliability(
        recording,
        settings=ReliabilitySettings(
            method=ReliabilityMethod.PUBLISHED, causal=settings.causal
        ),
        progress=within(progress, 0.0, 0.1),
    )
    return reconstruct_postures(
        recording,
        postures,
        settings=settings,
        reliability=reliability,
        complete=search_as_published,
        progress=within(progress, 0.1, 1.0),
    )


def search_as_published(
    take: ObservedTake, library: PostureLibrary, settings: PostureSettings, progress: Progress
) -> CompletedPostures:
    """Search each frame's pose of least energy, starting from the frame before.

    Nothing else is done: `smoothing`, `memory`, `pace` and `rounds` have no effect.
    """
    body = replace(
        build_body_postures(library.directions, library.changes, take.lengths),
        twists=library.twists,
    )
    causal_settings = replace(settings, causal=True, pace=0.0, smoothing=0.0)
    index = index_postures(body, library.groups)

    def choose(spaces: PostureSpaces, targets: EnergyTargets, last: Array | None) -> Array:
        return search_sequentially(spaces, targets, before=last)[0]

    chosen, twists = synthesize(take, body, index, causal_settings, progress, choose)
    deviation = np.hypot(chosen.spread, MODEL_ERROR_M)
    return CompletedPostures(
        chosen.values,
        confidence_from_deviation(deviation),
        deviation,
        twists and replace(twists, ignore_flexion=True),
        method="postures by stochastic search",
    )
