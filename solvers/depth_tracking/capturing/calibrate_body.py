"""Measure a body in one frame in which it stands still: lengths and thickness of its parts."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import Camera, DepthRecording
from ...errors import InvalidMotionError
from ...progress import Progress, unwatched, within
from ...settings import setting
from ..body import CAPSULES, SIDES, USUAL_STATURE, BodyModel, usual_body
from ..detection import detect_pose, thinned
from ..forest import PARTS, PixelForest, classify_pixels
from .refine_body import refine_body
from .sample_cylinders import Cylinder, CylinderSettings, sample_cylinder

Array = NDArray[np.float64]

MEASURED = tuple(
    f"{side}{part}"
    for side in SIDES
    for part in ("UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg")
)
"""Limbs whose cylinders are sampled; those of the trunk are too short and wide for that."""
ABOVE = {"LowerArm": "UpperArm", "Hand": "LowerArm", "LowerLeg": "UpperLeg"}
THINNEST, THICKEST = 0.6, 1.7
"""Radii tried, as shares of the usual."""
INNER = {"UpperArm": "chest", "UpperLeg": "hips"}
TRUNK = ("hips", "spine", "chest")
SURE = 0.25
"""Cylinders of less quality tell nothing."""
LEAST_LIMBS = 4
PIXELS = 6000
STATURES = 1.2, 2.2
STEP = 0.15
TRIED = tuple(1.3 + STEP * step for step in range(6))
"""Statures tried, metres."""


@dataclass(frozen=True, kw_only=True)
class CalibrationSettings(CylinderSettings):
    """How a body is measured."""

    refine: bool = setting(True, "Fit bone lengths to whole bodies rather than to single limbs")


USUAL = CalibrationSettings()


def calibrate_body(
    depth: DepthRecording,
    frame: int,
    forest: PixelForest,
    *,
    settings: CalibrationSettings = USUAL,
    progress: Progress = unwatched,
) -> BodyModel:
    """Measure the body that stands before the camera in one frame.

    It should face the camera, upright, arms and legs straight and away from the trunk. Pixels
    are told apart by the forest; a cylinder is fitted to each limb by random sampling; what the
    cylinders of left and right tell is averaged [1]_. With `refine` only their radii are used:
    stature is that of the usual adult whose pose is detected best, and the lengths then follow
    from a joint fit of pose and shape to the frame (`refine_body`, which measures better still
    over many tracked frames).

    Parameters
    ----------
    depth : DepthRecording
        Of nothing but one body.
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
    observation, _ = thinned(depth.frame(frame), depth.camera, PIXELS)
    picture, camera = observation.depth, observation.camera
    pixels = classify_pixels(picture.astype(np.float32), camera, forest)
    labels = np.full(picture.shape, -1)
    labels[pixels.rows, pixels.columns] = pixels.labels
    rng = np.random.default_rng(settings.seed)
    cylinders = _cylinders(picture, labels, camera, rng, settings)
    if len(cylinders) < LEAST_LIMBS:
        raise InvalidMotionError(
            f"Frame {frame} shows {len(cylinders)} arms and legs well enough to measure;"
            " choose one where the actor faces the camera, arms and legs away from the body."
        )
    if not settings.refine:
        return body_of_cylinders(cylinders, _trunk_length(picture, labels, camera, cylinders))
    body, pose = _usual_body_found(depth, frame, forest, within(progress, 0.0, 0.8))
    body = _with_radii(body, cylinders)
    poses = np.tile(pose, (depth.n_frames, 1))
    return refine_body(
        depth,
        body,
        poses,
        frames=np.array([frame]),
        progress=within(progress, 0.8, 1.0),
    )


def _usual_body_found(
    depth: DepthRecording, frame: int, forest: PixelForest, progress: Progress
) -> tuple[BodyModel, Array]:
    """Return the usual adult of the stature whose pose is detected best, and that pose."""
    picture = depth.frame(frame)
    found = {}
    for tried, stature in enumerate(TRIED):
        body = usual_body(stature)
        found[stature] = detect_pose(picture, depth.camera, body, forest)
        progress((tried + 1) / len(TRIED), "Finding the stature")
    best = max(found, key=lambda stature: found[stature].score)
    near = [stature for stature in TRIED if abs(stature - best) < 1.5 * STEP]
    stature = best
    if len(near) == 3:
        below, top, above = (found[one].score for one in near)
        bend = below - 2.0 * top + above
        stature = best + STEP * 0.5 * (below - above) / min(bend, -1e-9)
    return usual_body(stature), found[best].pose


def body_of_cylinders(cylinders: dict[str, Cylinder], trunk: float) -> BodyModel:
    """Return the body of these limbs; all else is as usual for the stature that they tell.

    Joints are midway between the ends of the cylinders that meet there. Left and right are
    averaged; what one side tells alone holds for both.

    Parameters
    ----------
    cylinders : dict of part name to Cylinder
        Of some of `MEASURED`, each from its inner to its outer end.
    trunk : float, metres
        From the middle of the hips to the lower end of the neck; NaN: unknown.
    """
    usual = usual_body()
    lengths = _both_sides({
        part: float(np.linalg.norm(_joint(cylinders, part, 1) - _joint(cylinders, part, 0)))
        for part in cylinders
    })  # fmt: skip
    usual_trunk = sum(usual.length(name) for name in TRUNK)
    if np.isfinite(trunk):
        lengths |= {name: usual.length(name) * trunk / usual_trunk for name in TRUNK}
    ratios = [length / usual.length(name) for name, length in lengths.items()]
    stature = float(np.clip(USUAL_STATURE * np.median(ratios), *STATURES))
    return _with_radii(usual_body(stature).with_lengths(**lengths), cylinders).symmetric()


def _with_radii(body: BodyModel, cylinders: dict[str, Cylinder]) -> BodyModel:
    """Return the body with limbs as thick as their cylinders, the same left and right."""
    radii = body.radii.copy()
    for part, radius in _both_sides({
        part: cylinder.radius for part, cylinder in cylinders.items()
    }).items():  # fmt: skip
        radii[CAPSULES.index(part)] = radius
    return BodyModel(body.lengths, radii)


def _joint(cylinders: dict[str, Cylinder], part: str, end: int) -> Array:
    """Return where a limb begins (0) or ends (1): between its cylinder and the next one."""
    side = next(side for side in SIDES if part.startswith(side))
    limb = part.removeprefix(side)
    if end == 0:
        other = f"{side}{ABOVE.get(limb, '')}"
    else:
        below = [one for one, above in ABOVE.items() if above == limb]
        other = f"{side}{below[0] if below else ''}"
    place: Array = cylinders[part].ends[end]
    if other not in cylinders:
        return place
    joint: Array = np.asarray(0.5 * (place + cylinders[other].ends[1 - end]))
    return joint


def _both_sides(told: dict[str, float]) -> dict[str, float]:
    """Return the mean of left and right for both; the one that is told where only one is."""
    both: dict[str, float] = {}
    for limb in {part.removeprefix("left").removeprefix("right") for part in told}:
        values = [told[f"{side}{limb}"] for side in SIDES if f"{side}{limb}" in told]
        both |= {f"{side}{limb}": float(np.mean(values)) for side in SIDES}
    return both


def _cylinders(
    picture: Array,
    labels: NDArray[np.intp],
    camera: Camera,
    rng: np.random.Generator,
    settings: CalibrationSettings,
) -> dict[str, Cylinder]:
    """Return the cylinders of limbs seen well, each from its inner to its outer end."""
    usual = usual_body()
    found: dict[str, Cylinder] = {}
    for part in MEASURED:
        places = [PARTS.index(name) for name in (part, f"{part}End") if name in PARTS]
        radius = float(usual.radii[CAPSULES.index(part)].mean())
        cylinder = sample_cylinder(
            picture,
            np.isin(labels, places),
            camera,
            (THINNEST * radius, THICKEST * radius),
            rng,
            settings,
        )
        inner = _inner_place(part, picture, labels, camera)
        if cylinder is None or cylinder.quality < SURE or inner is None:
            continue
        order = np.argsort(np.linalg.norm(cylinder.ends - inner, axis=1))
        found[part] = Cylinder(cylinder.ends[order], cylinder.radius, cylinder.quality)
    return found


def _inner_place(
    part: str, picture: Array, labels: NDArray[np.intp], camera: Camera
) -> Array | None:
    """Return the middle of what a limb hangs on, or None where that is not seen."""
    side = next(side for side in SIDES if part.startswith(side))
    limb = part.removeprefix(side)
    return _middle(INNER.get(limb, f"{side}{ABOVE.get(limb)}"), picture, labels, camera)


def _trunk_length(
    picture: Array,
    labels: NDArray[np.intp],
    camera: Camera,
    cylinders: dict[str, Cylinder],
) -> float:
    """Return how far the neck's lower end is above the middle of both hip joints, metres."""
    legs = [f"{side}UpperLeg" for side in SIDES]
    hips = [cylinders[leg].ends[0] for leg in legs if leg in cylinders]
    neck = _middle("neck", picture, labels, camera)
    if len(hips) < len(SIDES) or neck is None:
        return float("nan")
    usual = usual_body()
    # The middle of the neck's pixels is half a neck above its joint.
    return float(np.linalg.norm(neck - np.mean(hips, axis=0)) - 0.5 * usual.length("neck"))


def _middle(
    part: str, picture: Array, labels: NDArray[np.intp], camera: Camera
) -> Array | None:
    own = labels == PARTS.index(part)
    if np.count_nonzero(own) < 4:
        return None
    middle: Array = np.median(camera.back_project(picture)[own], axis=0)
    return middle
