"""Read depth images from MATLAB files, as in UTD-MHAD."""

from pathlib import Path

from ...depth_scene import Camera, DepthRecording
from ...errors import InvalidFileError
from ...progress import Progress, unwatched
from ..containers import MatlabArray, is_matlab, matlab_arrays
from ..conventions import DEFAULT_FRAME_RATE, MILLIMETER
from .settings import DEFAULT_DEPTH_SETTINGS, DepthSettings
from .stack import DepthStack, check_size

NAMES = ("d_depth", "depth")
KINECT_V1 = Camera(285.63, 285.63, 159.0, 120.0, 320, 240)
"""Camera of UTD-MHAD, focal lengths in pixels, after mirroring its images: by definition of the
data set u = 160 + 285.63 x / z in the file."""


def is_depth_mat(path: Path, head: bytes) -> bool:
    """Return whether a file is MATLAB 5 and has a depth array."""
    if not is_matlab(head):
        return False
    try:
        return _depth(path) is not None
    except InvalidFileError:
        return True


def read_depth_mat(
    path: Path | str,
    settings: DepthSettings = DEFAULT_DEPTH_SETTINGS,
    *,
    progress: Progress = unwatched,
) -> DepthRecording:
    """Read a MATLAB file with an array `d_depth` (rows, columns, frames), millimeters [1]_.

    The Kinect software mirrored the actor: the right hand is on the right. The images of
    UTD-MHAD are mirrored too and are flipped here. The camera is that of the data set, a Kinect
    v1 at 320 x 240, unless the settings override it.

    Parameters and errors are those of `read_depth`.

    References
    ----------
    .. [1] Chen, Jafari, Kehtarnavaz (2015). UTD-MHAD: a multimodal dataset for human action
       recognition utilizing a depth camera and a wearable inertial sensor. IEEE ICIP.
       doi:10.1109/ICIP.2015.7350781
    """
    path = Path(path)
    depth = _depth(path)
    if depth is None:
        raise InvalidFileError(
            f"{path} has no depth array; it must be called {' or '.join(NAMES)} and have rows,"
            " columns and frames."
        )
    height, width, n_frames = depth.shape
    check_size(path, height, width)
    given = settings.camera(width, height)
    if given is None and (width, height) != (KINECT_V1.width, KINECT_V1.height):
        raise InvalidFileError(
            f"{path} has images of {width} x {height} pixels and does not state the camera. Set"
            " its focal lengths fx and fy in pixels."
        )
    stack = DepthStack(
        depth.content,
        depth.kind,
        (height, width),
        settings.scale or MILLIMETER,
        by_column=True,
        mirrored=given is None,
    )
    progress(1.0, "Reading")
    return DepthRecording(
        given or KINECT_V1, n_frames, settings.frame_rate or DEFAULT_FRAME_RATE, stack
    )


def _depth(path: Path) -> MatlabArray | None:
    arrays = matlab_arrays(path)
    return next(
        (
            array
            for array in arrays
            if array.name in NAMES and len(array.shape) == 3 and min(array.shape) > 0
        ),
        None,
    )
