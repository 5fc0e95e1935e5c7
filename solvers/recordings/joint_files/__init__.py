"""Read and write joints of depth cameras and pose estimators."""

from .azure_csv import is_azure_csv, open_azure_csv
from .azure_json import is_azure_json, open_azure_json
from .freemocap import is_npy, read_freemocap, read_freemocap_points
from .irds import is_irds, open_irds
from .joint_csv import is_joint_csv, open_joint_csv, write_joint_csv
from .joint_json import is_joint_json, open_joint_json, write_joint_json
from .json_bodies import (
    is_frame_json,
    is_frames_json,
    open_frames_json,
    people_of_frame,
    time_of_frame,
)
from .json_table import is_json_table, open_json_table
from .kinect_csv import is_kinect_csv, read_kinect_csv
from .long_table import is_long_table, open_long_table
from .mediapipe_csv import is_mediapipe_csv, read_mediapipe_csv
from .msr_action3d import is_msr_action3d, read_msr_action3d
from .ntu_skeleton import is_ntu_skeleton, open_ntu_skeleton
from .nuitrack import (
    is_nuitrack_csv,
    is_nuitrack_json,
    open_nuitrack_csv,
    open_nuitrack_json,
)
from .point_table import is_point_table, open_point_table
from .table_titles import MAX_TITLE_LINES, MIN_POINTS
from .ui_prmd import is_ui_prmd, read_ui_prmd, read_ui_prmd_pair
from .zed_json import is_zed_json, open_zed_json

__all__ = [
    "MAX_TITLE_LINES",
    "MIN_POINTS",
    "is_azure_csv",
    "is_azure_json",
    "is_frame_json",
    "is_frames_json",
    "is_irds",
    "is_joint_csv",
    "is_joint_json",
    "is_json_table",
    "is_kinect_csv",
    "is_long_table",
    "is_mediapipe_csv",
    "is_msr_action3d",
    "is_npy",
    "is_ntu_skeleton",
    "is_nuitrack_csv",
    "is_nuitrack_json",
    "is_point_table",
    "is_ui_prmd",
    "is_zed_json",
    "open_azure_csv",
    "open_azure_json",
    "open_frames_json",
    "open_irds",
    "open_joint_csv",
    "open_joint_json",
    "open_json_table",
    "open_long_table",
    "open_ntu_skeleton",
    "open_nuitrack_csv",
    "open_nuitrack_json",
    "open_point_table",
    "open_zed_json",
    "people_of_frame",
    "read_freemocap",
    "read_freemocap_points",
    "read_kinect_csv",
    "read_mediapipe_csv",
    "read_msr_action3d",
    "read_ui_prmd",
    "read_ui_prmd_pair",
    "time_of_frame",
    "write_joint_csv",
    "write_joint_json",
]
