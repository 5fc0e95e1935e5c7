"""Measure the lengths and thickness of body parts in one frame of a standing actor."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...depth_scene import Camera, DepthRecording
from ...errors import InvalidMotionError
from ...motion.humanoid import ADULT_STATURE_M, SIDES
from ...progress import Progress, unwatched, within
from ...settings import setting
from ..body import CAPSULES, BodyModel, default_body
from ..detection import detect_pose, subsample_image
from ..forest import PARTS, PixelForest, classify_pixels
from .refine_body import refine_body
from .sample_cylinders import Cylinder, CylinderSettings, sample_cylinder

MEASURED_PARTS = tuple(
    f"{side}{part}"
    for side in SIDES
    for part in ("UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg")
)
"""Limbs with cylinder fits; the trunk is too short and wide for them."""
PARENT_LIMBS = {"LowerArm": "UpperArm", "Hand": "LowerArm", "LowerLeg": "UpperLeg"}
MIN_RADIUS_RATIO, MAX_RADIUS_RATIO = 0.6, 1.7
"""Range of radii relative to the default. Chosen by hand; `make sensitivity` varies them."""
PARENT_PARTS = {"UpperArm": "chest", "UpperLeg": "hips"}
TRUNK = ("hips", "spine", "chest")
MIN_QUALITY = 0.25
"""Quality, a fraction of fitting points, below which cylinders are ignored. Chosen by hand:
with x2 too few limbs are left; `make sensitivity` varies it."""
MIN_LIMBS = 4
"""Number of arms and legs, upper and lower, that must be measured for a body. Chosen by hand:
six are found in the frame of the metric; `make sensitivity` varies it."""
MAX_PIXELS = 6000
"""Number of pixels of the image in which limbs are measured. It bounds the run time."""
STATURE_STEP_M = 0.15
"""Meters between the statures that are tried. Chosen by hand; `make sensitivity` varies it."""
TESTED_STATURES_M = tuple(1.3 + STATURE_STEP_M * step for step in range(6))
"""Statures tested by the detector, meters. By definition from 1.3 m in steps of
`STATURE_STEP_M`."""
STATURE_RANGE_M = TESTED_STATURES_M[0] - STATURE_STEP_M, TESTED_STATURES_M[-1] + STATURE_STEP_M
"""Range of statures: others are images without a person. Meters."""


@dataclass(frozen=True, kw_only=True)
class CalibrationSettings(CylinderSettings):
    """Settings of the body calibration."""

    refine: bool = setting(
        True, "Fit bone lengths to complete bodies rather than to single limbs"
    )


DEFAULT_CALIBRATION = CalibrationSettings()


def calibrate_body(
    depth: DepthRecording,
    frame: int,
    forest: PixelForest,
    *,
    settings: CalibrationSettings = DEFAULT_CALIBRATION,
    progress: Progress = unwatched,
) -> BodyModel:
    """Measure the body of the actor in one frame.

    The actor should stand upright and face the camera, arms and legs straight and away from
    the trunk. The forest classifies the pixels. Random sampling fits a cylinder to each limb,
    and left and right are averaged [1]_. With `refine` only the radii come from cylinders. The
    stature is then that of the default body with the best detection score. The lengths follow
    from a joint fit of pose and shape (`refine_body`, more accurate over many frames).

    Parameters
    ----------
    depth : DepthRecording
        Contains only one body.
    frame : int
    forest : PixelForest
    settings : CalibrationSettings
    progress : Progress

    Raises
    ------
    InvalidMotionError
        There is no such frame, or it does not show at least four limbs.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [1] Wei, Zhang, Chai (2012), section 6.
    """
    observation, _ = subsample_image(depth.frame(frame), depth.camera, MAX_PIXELS)
    image, camera = observation.depth, observation.camera
    pixels = classify_pixels(image.astype(np.float32), camera, forest)
    labels = np.full(image.shape, -1)
    labels[pixels.rows, pixels.columns] = pixels.labels
    rng = np.random.default_rng(settings.seed)
    cylinders = _cylinders(image, labels, camera, rng, settings)
    if len(cylinders) < MIN_LIMBS:
        raise InvalidMotionError(
            f"Frame {frame} shows only {len(cylinders)} arms and legs well enough to measure."
            " Choose a frame where the actor faces the camera, limbs away from the body."
        )
    if not settings.refine:
        return body_from_cylinders(cylinders, _trunk_length(image, labels, camera, cylinders))
    body, pose = _detect_stature(depth, frame, forest, within(progress, 0.0, 0.8))
    body = _with_radii(body, cylinders)
    poses = np.tile(pose, (depth.n_frames, 1))
    return refine_body(
        depth,
        body,
        poses,
        frames=np.array([frame]),
        progress=within(progress, 0.8, 1.0),
    )


def _detect_stature(
    depth: DepthRecording, frame: int, forest: PixelForest, progress: Progress
) -> tuple[BodyModel, Array]:
    """Return the default body with the best detection score, and its pose."""
    image = depth.frame(frame)
    detections = {}
    for count, stature in enumerate(TESTED_STATURES_M):
        body = default_body(stature)
        detections[stature] = detect_pose(image, depth.camera, body, forest)
        progress((count + 1) / len(TESTED_STATURES_M), "Estimating the body size")
    best = max(detections, key=lambda stature: detections[stature].score)
    neighbors = [
        stature for stature in TESTED_STATURES_M if abs(stature - best) < 1.5 * STATURE_STEP_M
    ]
    stature = best
    if len(neighbors) == 3:
        below, top, above = (detections[one].score for one in neighbors)
        curvature = below - 2.0 * top + above
        stature = best + STATURE_STEP_M * 0.5 * (below - above) / min(curvature, -1e-9)
    return default_body(stature), detections[best].pose


def body_from_cylinders(cylinders: dict[str, Cylinder], trunk: float) -> BodyModel:
    """Return the body with these limbs; other parts have default proportions.

    Joints are midway between the ends of adjacent cylinders. Left and right are averaged; a
    limb measured on one side only applies to both.

    Parameters
    ----------
    cylinders : dict of part name to Cylinder
        Some of `MEASURED_PARTS`, each from its inner to its outer end.
    trunk : float, meters
        From hip center to the base of the neck; NaN: unknown.
    """
    default = default_body()
    lengths = _average_sides({
        part: float(np.linalg.norm(_joint(cylinders, part, 1) - _joint(cylinders, part, 0)))
        for part in cylinders
    })  # fmt: skip
    default_trunk = sum(default.length(name) for name in TRUNK)
    if np.isfinite(trunk):
        lengths |= {name: default.length(name) * trunk / default_trunk for name in TRUNK}
    ratios = [length / default.length(name) for name, length in lengths.items()]
    stature = float(np.clip(ADULT_STATURE_M * np.median(ratios), *STATURE_RANGE_M))
    return _with_radii(default_body(stature).with_lengths(**lengths), cylinders).symmetric()


def _with_radii(body: BodyModel, cylinders: dict[str, Cylinder]) -> BodyModel:
    """Return the body with the radii of the cylinders, averaged over both sides."""
    radii = body.radii.copy()
    for part, radius in _average_sides({
        part: cylinder.radius for part, cylinder in cylinders.items()
    }).items():  # fmt: skip
        radii[CAPSULES.index(part)] = radius
    return BodyModel(body.lengths, radii)


def _joint(cylinders: dict[str, Cylinder], part: str, end: int) -> Array:
    """Return the start (0) or end (1) of a limb, midway to the adjacent cylinder."""
    side = next(side for side in SIDES if part.startswith(side))
    limb = part.removeprefix(side)
    if end == 0:
        neighbor = f"{side}{PARENT_LIMBS.get(limb, '')}"
    else:
        children = [one for one, above in PARENT_LIMBS.items() if above == limb]
        neighbor = f"{side}{children[0] if children else ''}"
    end_point: Array = cylinders[part].ends[end]
    if neighbor not in cylinders:
        return end_point
    joint: Array = np.asarray(0.5 * (end_point + cylinders[neighbor].ends[1 - end]))
    return joint


def _average_sides(values_of_part: dict[str, float]) -> dict[str, float]:
    """Return the mean of both sides for each side; a single measurement applies to both."""
    mirrored: dict[str, float] = {}
    for limb in {part.removeprefix("left").removeprefix("right") for part in values_of_part}:
        values = [
            values_of_part[f"{side}{limb}"]
            for side in SIDES
            if f"{side}{limb}" in values_of_part
        ]
        mirrored |= {f"{side}{limb}": float(np.mean(values)) for side in SIDES}
    return mirrored


def _cylinders(
    image: Array,
    labels: NDArray[np.intp],
    camera: Camera,
    rng: np.random.Generator,
    settings: CalibrationSettings,
) -> dict[str, Cylinder]:
    """Return the cylinders of well-observed limbs, each from its inner to its outer end."""
    default = default_body()
    cylinders: dict[str, Cylinder] = {}
    for part in MEASURED_PARTS:
        part_indices = [PARTS.index(name) for name in (part, f"{part}End") if name in PARTS]
        radius = float(default.radii[CAPSULES.index(part)].mean())
        cylinder = sample_cylinder(
            image,
            np.isin(labels, part_indices),
            camera,
            (MIN_RADIUS_RATIO * radius, MAX_RADIUS_RATIO * radius),
            rng,
            settings,
        )
        inner_point = _inner_point(part, image, labels, camera)
        if cylinder is None or cylinder.quality < MIN_QUALITY or inner_point is None:
            continue
        order = np.argsort(np.linalg.norm(cylinder.ends - inner_point, axis=1))
        cylinders[part] = Cylinder(cylinder.ends[order], cylinder.radius, cylinder.quality)
    return cylinders


def _inner_point(
    part: str, image: Array, labels: NDArray[np.intp], camera: Camera
) -> Array | None:
    """Return the median point of a limb's parent part, or None if it is hidden."""
    side = next(side for side in SIDES if part.startswith(side))
    limb = part.removeprefix(side)
    return _median_point(
        PARENT_PARTS.get(limb, f"{side}{PARENT_LIMBS.get(limb)}"), image, labels, camera
    )


def _trunk_length(
    image: Array,
    labels: NDArray[np.intp],
    camera: Camera,
    cylinders: dict[str, Cylinder],
) -> float:
    """Return the distance from hip center to the base of the neck, meters."""
    legs = [f"{side}UpperLeg" for side in SIDES]
    hips = [cylinders[leg].ends[0] for leg in legs if leg in cylinders]
    neck = _median_point("neck", image, labels, camera)
    if len(hips) < len(SIDES) or neck is None:
        return float("nan")
    default = default_body()
    # The median of the neck's pixels is half a neck above its joint.
    return float(np.linalg.norm(neck - np.mean(hips, axis=0)) - 0.5 * default.length("neck"))


def _median_point(
    part: str, image: Array, labels: NDArray[np.intp], camera: Camera
) -> Array | None:
    part_mask = labels == PARTS.index(part)
    if np.count_nonzero(part_mask) < 4:
        return None
    point: Array = np.median(camera.back_project(image)[part_mask], axis=0)
    return point
