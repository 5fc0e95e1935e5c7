"""Read recorded motion of all supported file formats, and write the common ones.

>>> from pathlib import Path
>>> from tempfile import TemporaryDirectory
>>> from solvers.recordings import read_recording, write_bvh
>>> from solvers.samples import GaitSettings, walking_gait
>>> with TemporaryDirectory() as folder:
...     path = Path(folder) / "walk.bvh"
...     write_bvh(walking_gait(GaitSettings(duration=1.0, frame_rate=30.0)), path)
...     walk = read_recording(path)
>>> walk.n_frames, walk.frame_rate
(30, 30.0)
"""

from typing import TYPE_CHECKING

from ..import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .conventions import ALL_BODIES, Bodies, Body
    from .depth_files import (
        CameraOrientation,
        DepthSettings,
        detect_depth_format,
        is_depth_folder,
        read_depth,
    )
    from .folders import (
        depth_takes_in,
        describe_no_recording,
        may_contain_motion,
        one_path_per_take,
        recordings_in,
        takes_in,
    )
    from .formats import detect_format
    from .joint_files import (
        read_freemocap,
        read_kinect_csv,
        read_msr_action3d,
        read_ui_prmd,
        read_ui_prmd_pair,
        write_joint_csv,
        write_joint_json,
    )
    from .joints import read_joints, write_joints
    from .marker_files import read_c3d, read_trc, write_c3d, write_trc
    from .read_as import open_as, questions_of, read_as, settle
    from .read_recording import (
        is_depth_recording,
        list_bodies,
        open_bodies,
        read_motion_or_tracks,
        read_recording,
        read_tracked,
    )
    from .reading_settings import (
        DEFAULT_READING,
        Axis,
        FloorPlacement,
        FloorPlacementSettings,
        ReadingSettings,
        Unit,
    )
    from .recording_figures import recording_figures
    from .refuse_stand_ins import refuse_stand_ins
    from .scene_suffixes import SCENE_SUFFIXES, is_scene_file, suffix_by_content
    from .skeleton_files import read_acclaim, read_bvh, write_bvh

__all__ = [
    "ALL_BODIES",
    "DEFAULT_READING",
    "SCENE_SUFFIXES",
    "Axis",
    "Bodies",
    "Body",
    "CameraOrientation",
    "DepthSettings",
    "FloorPlacement",
    "FloorPlacementSettings",
    "ReadingSettings",
    "Unit",
    "depth_takes_in",
    "describe_no_recording",
    "detect_depth_format",
    "detect_format",
    "is_depth_folder",
    "is_depth_recording",
    "is_scene_file",
    "list_bodies",
    "may_contain_motion",
    "one_path_per_take",
    "open_as",
    "open_bodies",
    "questions_of",
    "read_acclaim",
    "read_as",
    "read_bvh",
    "read_c3d",
    "read_depth",
    "read_freemocap",
    "read_joints",
    "read_kinect_csv",
    "read_motion_or_tracks",
    "read_msr_action3d",
    "read_recording",
    "read_tracked",
    "read_trc",
    "read_ui_prmd",
    "read_ui_prmd_pair",
    "recording_figures",
    "recordings_in",
    "refuse_stand_ins",
    "settle",
    "suffix_by_content",
    "takes_in",
    "write_bvh",
    "write_c3d",
    "write_joint_csv",
    "write_joint_json",
    "write_joints",
    "write_trc",
]

import_on_demand(__name__)
