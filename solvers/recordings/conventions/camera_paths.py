"""Take the camera of a video model for a path only as far as it is one."""

import re

import numpy as np

from ...arrays import Array
from ...progress import Remark

OF_CROP = frozenset(("predcamt", "camt"))
"""Names, without signs, of the camera of a picture cut around the person."""
OF_PICTURE = frozenset(("predcamtfull", "camtfull"))
"""The same of the complete picture."""
MAX_DISTANCE_M = 25.0
"""Distance from the camera, meters, beyond which its focal length was invented. Measured: HMR
2.0 sees an actor of 0.4 to 1.3 in a picture of 256 pixels, by a focal length of 5000, from 30
to 100 m; models that estimate it, such as SAM 3D Body, have 2 to 20 m."""
CROPPED = Remark(
    "The position is that of a camera of the cut-out picture, which follows the actor: the body"
    " stays in place. Save the path in the world, as GVHMR and WHAM have it"
)
WITHOUT_DEPTH = Remark(
    "The distance from the camera follows from an invented focal length and is left out: the"
    " actor only moves across the picture. Save the path in the world, as GVHMR and WHAM have"
    " it"
)


def path_from_camera(name: str, positions: Array) -> tuple[Array, Remark | None]:
    """Return what is known of the path of a body from its position relative to a camera.

    Models of weak perspective assume a very long focal length. In the picture cut around an
    actor, none of the position is a path; in the complete one, the depth is none.

    Parameters
    ----------
    name : str
        Name of the positions in the file.
    positions : shape (..., 3), meters
    """
    plain = re.sub(r"[\W_]", "", name).lower()
    depths = positions[..., 2][np.isfinite(positions[..., 2])]
    if plain not in OF_CROP | OF_PICTURE or not depths.size:
        return positions, None
    if abs(np.median(depths)) <= MAX_DISTANCE_M:
        return positions, None
    path = np.where(np.isfinite(positions), 0.0, np.nan)
    if plain in OF_PICTURE:
        path[..., :2] = positions[..., :2]
    return path, WITHOUT_DEPTH if plain in OF_PICTURE else CROPPED
