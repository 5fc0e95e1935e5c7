"""Hands, knees and hips on the floor: detected against known ones, and held in place."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping

import numpy as np

from solvers.arrays import Flags
from solvers.feet import PlantSettings, find_legs, plant_feet
from solvers.feet.body_supports import SUPPORTS, detect_supports
from solvers.feet.limb_goals import find_limb_contacts
from solvers.feet.support import Support
from solvers.motion import Motion, WorldPoses, find_humanoid_map, forward_kinematics
from solvers.motion.humanoid import SIDES
from solvers.recordings import read_acclaim
from solvers.rotations import angle_between
from solvers.signals import find_runs

from ..first_press import takes
from ..shared import clips
from ..shared.tables import number, table
from .detectors import SPEED
from .made_supports import joints_of, made_supports
from .part_takes import INPUTS, acceleration_ratio

RATE_HZ = 30.0
"""Hertz."""
PARTS = {"hands": slice(0, 2), "knees": slice(2, 4), "hips": slice(4, 5)}
"""Columns of `SUPPORTS`."""
HEIGHT_M = 0.1
"""Meters above the lowest joint of the take, of the peer."""
OURS, HIPS_KEYED = "feet, hands and knees", "hips too, if keyed"
FEET_ALONE, GIVEN = "feet alone", "as given"
COLUMNS = (
    "frames in contact", "slide, cm/s", "worst drift, mm", "elbow, times given",
    "largest change, deg", "root to the truth, cm",
)  # fmt: skip
Planter = Callable[[Motion], Motion]


def support_tables(actors: Iterable[str], movements: Iterable[takes.Take]) -> list[str]:
    """Return the tables of detection and of slide."""
    made = [take.motion for take in made_supports(RATE_HZ).values()]
    captured = [
        clips.every(read_acclaim(path), clips.STEP)
        for actor in actors
        for path in sorted(clips.HDM05.glob(f"HDM_{actor}_lieDownFloor_*_120.amc"))
    ]
    return [
        _detection_table(),
        _movement_table(movements),
        *(
            _slide_table(f"{title}, {what}", motions, spoil)
            for title, motions in (
                ("Made bodies on hands and knees", made),
                ("HDM05, actors lie down", captured),
            )
            for what, spoil in INPUTS.items()
        ),
    ]


def _detection_table() -> str:
    """Return precision and recall of each take and part of the body."""
    detectors: Mapping[str, Callable[[Motion], Flags]] = {
        "ours": _detected,
        "height and speed": _below_thresholds,
    }
    rows = {}
    totals: dict[tuple[str, str], np.ndarray] = defaultdict(lambda: np.zeros(3))
    for name, take in made_supports(RATE_HZ).items():
        for part, columns in PARTS.items():
            cells = []
            for method, detect in detectors.items():
                found, known = detect(take.motion)[:, columns], take.contacts[:, columns]
                counts = np.array([(found & known).sum(), found.sum(), known.sum()])
                totals[method, part] += counts
                cells.append(_precision_and_recall(*counts))
            rows[f"{name}, {part}"] = cells
    for part in PARTS:
        rows[f"all, {part}"] = [
            _precision_and_recall(*totals[method, part]) for method in detectors
        ]
    title = f"**Hands, knees and hips of made bodies: precision and recall, {RATE_HZ:g} Hz**"
    return f"{title}\n\n{table(['take', *detectors], rows)}\n"


def _movement_table(movements: Iterable[takes.Take]) -> str:
    """Return what is detected in kicks, hops, punches, dances and walks."""
    rows, others = {}, 0
    for take in movements:
        found = _detected(takes.read(take)).sum(axis=0)
        if found.any():
            rows[str(take)] = [f"{count:g}" for count in found]
        else:
            others += 1
    rows[f"{others} other takes"] = ["0"] * len(SUPPORTS)
    title = "**All kinds of movement: frames in which a part is detected**"
    return f"{title}\n\n{table(['take', *SUPPORTS], rows)}\n"


def _precision_and_recall(both: float, found: float, known: float) -> str:
    """Return both, or how many frames were detected where there is no contact."""
    if not known:
        return "none detected" if not found else f"{found:g} frames detected"
    return f"{both / max(found, 1):.2f} {both / known:.2f}"


def _detected(motion: Motion) -> Flags:
    humanoid = find_humanoid_map(motion.skeleton)
    return detect_supports(motion, humanoid, find_legs(motion.skeleton, humanoid))


def _below_thresholds(motion: Motion) -> Flags:
    """Return what is low and slow above the lowest joint of the take."""
    positions = forward_kinematics(motion).positions
    found = []
    for support in SUPPORTS:
        path = positions[:, motion.skeleton.index(joints_of(support)[0])]
        speed = np.linalg.norm(np.gradient(path, axis=0), axis=1) * motion.frame_rate
        height = path[:, 2] - positions[..., 2].min()
        found.append((height < HEIGHT_M) & (speed < SPEED))
    return np.stack(found, axis=1)


def _slide_table(
    title: str, truths: Iterable[Motion], spoil: Callable[[Motion], Motion]
) -> str:
    figures: dict[str, list[list[float]]] = defaultdict(list)
    for truth in truths:
        given = spoil(truth)
        supports = _detected(given)
        if not supports.any():
            continue
        alone = plant_feet(given, settings=PlantSettings(hands_and_knees=False))
        keyed = plant_feet(given, np.hstack([alone.contacts, supports]))
        for name, motion in (
            (OURS, plant_feet(given).motion), (HIPS_KEYED, keyed.motion),
            (FEET_ALONE, alone.motion), (GIVEN, given),
        ):  # fmt: skip
            figures[name].append(_figures(truth, given, motion, supports))
    rows = {
        name: [number(float(value)) for value in (
            np.sum(of_takes, axis=0)[0], np.mean(of_takes, axis=0)[1],
            *np.max(of_takes, axis=0)[2:-1], np.nanmean([each[-1] for each in of_takes]),
        )]
        for name, of_takes in figures.items()
    }  # fmt: skip
    n_takes = len(next(iter(figures.values()), []))
    return f"**{title}, {n_takes} takes**\n\n{table(['planted', *COLUMNS], rows)}\n"


def _figures(truth: Motion, given: Motion, motion: Motion, supports: Flags) -> list[float]:
    """Return the figures of `COLUMNS`."""
    humanoid, poses = find_humanoid_map(given.skeleton), forward_kinematics(given)
    limbs = find_limb_contacts(given, poses, humanoid, supports)
    after = forward_kinematics(motion)
    n_frames = float(supports.sum())
    slide = 100.0 * sum(limb.slide(after) for limb in limbs) / n_frames * given.frame_rate
    drift = 1000.0 * max(_drift(limb, after) for limb in limbs)
    roles = humanoid.indices(given.skeleton)
    elbows = acceleration_ratio(given, motion, [roles[f"{side}LowerArm"] for side in SIDES])
    change = np.degrees(angle_between(motion.rotations, given.rotations)).max()
    sits = supports[:, SUPPORTS.index("hips")]
    away = 100.0 * (motion.root_positions - truth.root_positions)[sits, :2]
    root = np.sqrt((away**2).sum(axis=1).mean()) if sits.any() else np.nan
    return [n_frames, slide, drift, elbows, float(change), float(root)]


def _drift(limb: Support, poses: WorldPoses) -> float:
    """Return the farthest way of the loaded point over the floor within a contact, meters."""
    positions = np.stack([point.position(poses) for point in limb.points], axis=1)
    steps = np.einsum("fp,fpi->fi", limb.step_load, np.diff(positions, axis=0))[:, :2]
    return max(
        (
            float(np.linalg.norm(np.cumsum(steps[start:stop], axis=0), axis=1).max())
            for start, stop in find_runs(limb.contact[1:] & limb.contact[:-1])
        ),
        default=0.0,
    )
