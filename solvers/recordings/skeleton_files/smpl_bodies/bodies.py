"""List the bodies of the parameters of SMPL, and read their motions."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from ....arrays import Array
from ....errors import InvalidFileError, InvalidSettingError
from ....motion import Motion, Skeleton
from ....progress import Progress, Remark, unwatched
from ....rotations import quaternion_from_rotation_vector
from ...conventions import (
    DEFAULT_FRAME_RATE,
    Bodies,
    UpAxisName,
    check_scale,
    common_rate,
    file_conventions,
    observed_body,
    path_from_camera,
    put_on_floor,
    rotations_z_up_from_y_up,
    stand_upright,
    z_up_from_y_up,
)
from .easymocap import with_root_at_pelvis
from .joints import smpl_joints
from .parameters import (
    BODY_SCALES,
    N_BODY,
    N_WITH_COMPONENTS,
    OF_CAMERA,
    POSITIONS,
    RATES,
    ROOT,
    ROTATIONS,
    SCALES,
    member,
    rotation_vectors,
)

MAX_HEIGHT_M = 10.0
AMASS_UP: dict[UpAxisName, float] = {"Z": 0.8, "Y": 0.0}
"""Weight of the evidence of AMASS for each axis (`estimate_up_axis`), by definition Z."""
VIDEO_UP: dict[UpAxisName, float] = {"Y": 0.1, "Z": 0.05, "-Y": 0.0}
"""The same weight of video models: mostly Y and, in the camera's axes, -Y. Chosen by hand below
`FLOOR_WEIGHT`, 0.3."""


def bodies_of_parameters(
    path: Path | str,
    people: Mapping[str, Mapping[str, Array]],
    *,
    scale: float | None,
    height: float,
    on_floor: bool,
) -> Bodies[Motion]:
    """List the bodies of the parameters of people, by their names (`open_smpl`).

    Parameters
    ----------
    path : Path or str
    people : mapping of name to arrays by their names
        Rotations are rotation vectors.
    scale, height, on_floor : as of `open_smpl`

    Raises
    ------
    InvalidFileError
        There are no rotations of a body, or arrays of different lengths.
    InvalidSettingError
        Scale or height is not positive.
    """
    check_scale(scale)
    if not 0.0 < height < MAX_HEIGHT_M:
        raise InvalidSettingError(f"height is {height:g} m; it must be above 0 and below 10.")
    bodies = [with_root_at_pelvis(path, person) for person in people.values()]
    vectors = [rotation_vectors(path, person) for person in bodies]
    rates = [_rate(person, unwatched) for person in bodies]
    listed = tuple(
        observed_body(
            name,
            np.flatnonzero(np.isfinite(each).all(axis=(1, 2))),
            len(each),
            len(each) / rate,
        )
        for name, each, rate in zip(people, vectors, rates, strict=True)
    )

    def read(index: int, progress: Progress) -> Motion:
        motion = _motion(path, bodies[index], vectors[index], scale, height, progress)
        return put_on_floor(motion) if on_floor else motion

    return Bodies(str(path), listed, read)


def _motion(
    path: Path | str,
    arrays: Mapping[str, Array],
    vectors: Array,
    scale: float | None,
    height: float,
    progress: Progress,
) -> Motion:
    """Return the motion of one person from axes times angles."""
    n_frames = len(vectors)
    hands = vectors.shape[1] > N_BODY
    positions = member(arrays, POSITIONS)
    if positions is None:
        positions = np.zeros((n_frames, 3))
        progress(0.5, Remark("The file has no positions, so the body stays in place"))
    if positions.shape == (n_frames, 1, 3):
        positions = positions[:, 0]
    if positions.shape != (n_frames, 3):
        raise InvalidFileError(
            f"{path} has {n_frames} poses but positions of shape {positions.shape}."
        )
    name = next((each for each in POSITIONS if each in arrays), "")
    positions, limited = path_from_camera(name, positions)
    if limited:
        progress(0.5, limited)
    used = (next((name for name in names if name in arrays), "") for names in
            ((*ROTATIONS, *ROOT), POSITIONS))  # fmt: skip
    if not OF_CAMERA.isdisjoint(used):
        progress(
            0.5,
            Remark("Poses are relative to the camera: if it moved, the actor moves with it"),
        )
    poses = member(arrays, ROTATIONS)
    if poses is not None and poses[0].size in N_WITH_COMPONENTS:
        progress(
            0.5,
            Remark("The fingers are components of the licensed model and are left out"),
        )
    height *= _number(arrays, BODY_SCALES, 1.0)
    rate = _rate(arrays, progress)
    unit = scale if scale is not None else 1.0 / _number(arrays, SCALES, 1.0)
    names, parents, offsets = smpl_joints(hands, height)
    rotations = rotations_z_up_from_y_up(quaternion_from_rotation_vector(vectors))
    motion = Motion(
        Skeleton(names, parents, z_up_from_y_up(offsets)),
        rotations,
        z_up_from_y_up(positions * unit),
        rate,
        replace(file_conventions("Y", unit=unit), has_floor=False),
    )
    is_amass = not {"mocap_frame_rate", "mocap_framerate"}.isdisjoint(arrays)
    return stand_upright(motion, progress, AMASS_UP if is_amass else VIDEO_UP)


def _number(arrays: Mapping[str, Array], names: tuple[str, ...], default: float) -> float:
    array = member(arrays, names)
    value = float(array.ravel()[0]) if array is not None and array.size else default
    return value if 0.0 < value < np.inf else default


def _rate(arrays: Mapping[str, Array], progress: Progress) -> float:
    rate = _number(arrays, RATES, 0.0)
    if rate > 0.0:
        return common_rate(rate)
    progress(0.5, Remark(f"The file has no frame rate; {DEFAULT_FRAME_RATE:g} Hz is assumed"))
    return DEFAULT_FRAME_RATE
