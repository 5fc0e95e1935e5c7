"""Solve of the button Simulate: a body with mass that follows the motion."""

from dataclasses import replace
from typing import NamedTuple

from ...solvers.motion import Motion
from ...solvers.physics import Simulated, SimulateSettings, apply_strength, simulate
from ...solvers.progress import Progress, unwatched
from ..clean.solve_cleaning import changed_joints


class SimulatedTake(NamedTuple):
    """Input of a simulation at full strength."""

    body: Motion
    settings: SimulateSettings


class Resimulated(NamedTuple):
    """Simulation at full strength, the blended motion, and the names of changed joints."""

    simulated: Simulated
    body: Motion
    moved: frozenset[str]


def take_of(body: Motion, settings: SimulateSettings) -> SimulatedTake:
    """Return the input of a simulation, which does not depend on the strength."""
    return SimulatedTake(body, replace(settings, strength=1.0))


def simulate_take(
    take: SimulatedTake,
    strength: float,
    simulated: Simulated | None = None,
    *,
    progress: Progress = unwatched,
) -> Resimulated:
    """Simulate a take, unless that was done already, and blend by the strength."""
    if simulated is None:
        simulated = simulate(take.body, settings=take.settings, progress=progress)
    body = apply_strength(take.body, simulated, strength)
    return Resimulated(simulated, body, changed_joints(take.body, body))
