"""Convert the spaces of depth cameras to ours: the camera is at the origin and looks along +Y.

An actor who faces the camera faces -Y, as in every rest pose, with the left hand at +X.
Recordings of joints do not store the height and tilt of the camera.
"""

import numpy as np
from numpy.typing import NDArray


def from_kinect_space(positions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Convert (..., 3) of Kinect v1 and v2: x to the camera's left, y up, z forward."""
    x, y, z = np.moveaxis(positions, -1, 0)
    return np.stack([-x, z, y], axis=-1)


def from_azure_space(positions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Convert (..., 3) of the Azure Kinect's depth camera: x right, y down, z forward."""
    x, y, z = np.moveaxis(positions, -1, 0)
    return np.stack([x, z, -y], axis=-1)
