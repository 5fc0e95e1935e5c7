"""Each goal of a fit left out in turn: what it is good for."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from importlib import import_module
from unittest.mock import patch

import numpy as np

from solvers.feet import plant_feet
from solvers.motion import Motion, Skeleton, find_humanoid_map
from solvers.motion_fitting import Goal
from solvers.motion_fitting.goals import FollowSource
from solvers.retargeting import retarget

from ..retarget.retarget_measures import acted, ik_figures, world_figures
from ..shared.tables import number, table
from .part_takes import Planter

CLEAN = "solvers.feet.plant_in_window"
RETARGET = ("solvers.retargeting.place_feet", "solvers.retargeting.place_hands")
OF_PLANTING = {
    "StayInPlace": "loaded sole in place",
    "StayAtHeight": "sole on the floor",
    "StayStill": "no turning on the spot",
    "FollowPosition": "ankle on its path",
    "FollowRotation": "foot turned as recorded",
    "HingeLimit": "knee not bent backward",
    "smooth": "smooth changes",
}
OF_RETARGETING = {
    "FollowPosition": "ankles and hands on their paths",
    "FollowRotation": "foot turned as in the source",
    "StayInPlace": "no more slide than the source",
    "StayAbove": "above the floor",
    "KeepSeparation": "hands that meet",
    "HingeLimit": "limits of knees, elbows and toes",
    "smooth": "smooth changes",
}
COLUMNS = (
    "IK: foot cm", "IK: hand cm", "slide cm/s", "below floor cm", "sunk feet %",
    "knee acceleration", "elbow acceleration",
)  # fmt: skip


@contextmanager
def without(kind: str, *modules: str) -> Iterator[None]:
    """Leave out one kind of goal in the fits of some modules."""
    with ExitStack() as stack:
        for name in modules:
            stack.enter_context(
                patch.object(import_module(name), "fit_motion", _fit(name, kind))
            )
        yield


def _fit(module: str, kind: str) -> Callable[..., object]:
    fit = import_module(module).fit_motion

    def fit_without(start: object, goals: Sequence[Goal], *arguments: object) -> object:
        kept = [_left(goal, kind) for goal in goals if type(goal).__name__ != kind]
        return fit(start, kept, *arguments)

    return fit_without


def _left(goal: Goal, kind: str) -> Goal:
    if kind == "smooth" and isinstance(goal, FollowSource):
        return replace(goal, time_constants=np.zeros_like(goal.time_constants))
    return goal


def planters_without() -> dict[str, Planter]:
    """Return planting with each goal left out."""

    def planter(kind: str) -> Planter:
        def plant(motion: Motion, contacts: object) -> Motion:
            with without(kind, CLEAN):
                return plant_feet(motion, contacts).motion

        return plant

    complete: dict[str, Planter] = {
        "planted": lambda motion, contacts: plant_feet(motion, contacts).motion
    }
    return complete | {f"without: {name}": planter(kind) for kind, name in OF_PLANTING.items()}


def retarget_table(
    title: str, motions: Iterable[Motion], rigs: dict[str, Callable[[], Skeleton]]
) -> str:
    """Return the figures of retargeting with each goal left out."""
    motions = list(motions)
    rows = {"all goals": _retarget_figures(motions, rigs)}
    for kind, name in OF_RETARGETING.items():
        with without(kind, *RETARGET):
            rows[f"without: {name}"] = _retarget_figures(motions, rigs)
    cells = {name: [number(float(value)) for value in values] for name, values in rows.items()}
    where = f"{len(motions)} takes to {' and '.join(rigs)}"
    return f"**{title}, {where}**\n\n{table(['goals', *COLUMNS], cells)}\n"


def _retarget_figures(
    motions: Sequence[Motion], rigs: dict[str, Callable[[], Skeleton]]
) -> list[float]:
    figures = []
    for motion in motions:
        for make in rigs.values():
            rig = make()
            maps = find_humanoid_map(motion.skeleton), find_humanoid_map(rig)
            given = acted(retarget(motion, maps[0], rig, maps[1]), maps[1])
            source = acted(motion, maps[0])
            found = ik_figures(source, given) | world_figures(source, given)
            figures.append([found[column] for column in COLUMNS])
    return [float(value) for value in np.mean(figures, axis=0)]
