"""Combine the solver families into complete workflows, from a recording to a result."""

from typing import TYPE_CHECKING

from ..import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .clean_from_library import LibraryBases, bases_from_library, clean_from_library
    from .depth_capture import (
        CapturedMotion,
        capture_actor,
        capture_every_person,
        capture_from_cameras,
        capture_recording,
        capture_remarks,
        capture_seen_actor,
        capture_separated_people,
        find_actor_of_cameras,
    )
    from .fix_chains import ChainResult
    from .fix_report import (
        UNKNOWN,
        MotionFromJoints,
        TakeFigures,
        TakeOrigin,
        describe_missing_points,
        drop_missing_points,
        figure_texts,
        find_origin,
        measure_take,
    )
    from .fix_take import FixedTake, FixSettings, fix_take
    from .index_files import IndexReport, index_files
    from .live import (
        LiveMotion,
        LiveSession,
        LiveTake,
        LiveTakeSettings,
        PoseTake,
        SessionUpdate,
    )
    from .motion_from_markers import MarkerMotion, MarkerMotionSettings, motion_from_markers
    from .planting import PlantingResult, plant_feet_if_possible
    from .postures_from_clips import posture_library_from_clips
    from .reconstruct_from_library import (
        LibraryPostures,
        postures_from_library,
        reconstruct_from_library,
    )
    from .reconstruct_motion import RebuiltMotion, reconstruct_motion
    from .reconstruct_recording import ReconstructedMotion, reconstruct_recording
    from .vary_motions import Variants, vary_motions

__all__ = [
    "UNKNOWN",
    "CapturedMotion",
    "ChainResult",
    "FixSettings",
    "FixedTake",
    "IndexReport",
    "LibraryBases",
    "LibraryPostures",
    "LiveMotion",
    "LiveSession",
    "LiveTake",
    "LiveTakeSettings",
    "MarkerMotion",
    "MarkerMotionSettings",
    "MotionFromJoints",
    "PlantingResult",
    "PoseTake",
    "RebuiltMotion",
    "ReconstructedMotion",
    "SessionUpdate",
    "TakeFigures",
    "TakeOrigin",
    "Variants",
    "bases_from_library",
    "capture_actor",
    "capture_every_person",
    "capture_from_cameras",
    "capture_recording",
    "capture_remarks",
    "capture_seen_actor",
    "capture_separated_people",
    "clean_from_library",
    "describe_missing_points",
    "drop_missing_points",
    "figure_texts",
    "find_actor_of_cameras",
    "find_origin",
    "fix_take",
    "index_files",
    "measure_take",
    "motion_from_markers",
    "plant_feet_if_possible",
    "posture_library_from_clips",
    "postures_from_library",
    "reconstruct_from_library",
    "reconstruct_motion",
    "reconstruct_recording",
    "vary_motions",
]

import_on_demand(__name__)
