"""Learn how feet, hands and knees in contact move, and print the numbers of their models.

    make contacts

Feet (foot_contacts.py) from made ones with random parameters and walks of CMU's development
subjects, hands and knees (body_supports.py) from made ones alone, with noise and slow errors.
No force plate and no scored take is among them. The model's log loss over all frames is
minimized, so that its probabilities are calibrated.
"""

from collections.abc import Iterable, Iterator
from dataclasses import fields

import numpy as np
from scipy.optimize import minimize

from solvers.arrays import Array
from solvers.feet.body_supports import LEARNED as LEARNED_SUPPORTS
from solvers.motion.humanoid.foot_contacts import (
    CONTACT_MODEL,
    ContactModel,
    FeetInMotion,
    measure_feet,
)
from solvers.signals import smooth_gaussian, two_state_probabilities

from .contact_captures import RATE_HZ as CAPTURE_RATE
from .contact_captures import labeled_walks
from .contact_takes import KINDS, made_feet
from .support_takes import PLANS, made_supports

RATE_HZ = 60.0
"""Hertz; the model does not depend on it."""
TAKES_OF_A_KIND = 16
NOISE_M = (0.0, 0.0, 0.0, 0.003, 0.01, 0.03, 0.06)
"""Standard deviations of the noise of each frame; a knee of 1 degree makes 0.01."""
COMMON_NOISE = 0.9
"""Part of it that ankle and toes share."""
SLOW_ERROR_M, SLOW_S, SLOW_TAKES = (0.003, 0.015), 0.12, 0.25
"""Meters of errors that change slowly, as cleaning leaves them; their duration, and the part of
takes that have them."""
UNEVEN_M, SLOPE = (0.001, 0.006), 0.012
"""Meters by which made feet move on the floor, and its slope: no capture is exact."""
WEIGHT_OF_WALKS = 12.0
"""Weight of a second of captured walks: there are few, and only their feet leave the floor as
people's do. Chosen by hand: with 8 contacts of walks end too early, with 20 feet of made takes
that hang are planted."""
PRIOR = 1e-4
"""Weight of the squared distance of the logarithms from where the search starts."""


GROUND_M = 0.01
"""Meters of deviation of a joint of the body that rests on the ground."""

Weighted = tuple[FeetInMotion, Array, Array]
"""Feet, contacts and the weight of each frame."""


def main() -> None:
    """Learn and print."""
    print("foot_contacts.py")
    _learn(_takes(np.random.default_rng(0)), CONTACT_MODEL)
    print("body_supports.py")
    _learn(_supports(np.random.default_rng(0)), LEARNED_SUPPORTS)


def _learn(examples: Iterable[Weighted], initial: ContactModel) -> None:
    takes = list(examples)
    truth, weight = (_padded([take[number] for take in takes]) for number in (1, 2))
    feet = [take[0] for take in takes]
    start = np.log([getattr(initial, field.name) for field in fields(ContactModel)])

    def loss(logs: Array) -> float:
        probability = np.clip(_probabilities(feet, _model(logs)), 1e-6, 1.0 - 1e-6)
        surprise = -np.log(np.where(truth > 0.5, probability, 1.0 - probability))
        mean = np.average(surprise, weights=weight)
        return float(mean + PRIOR * ((logs - start) ** 2).sum())

    found = minimize(loss, start, method="L-BFGS-B", options={"eps": 1e-3, "maxiter": 60})
    for field, value in zip(fields(ContactModel), np.exp(found.x), strict=True):
        print(f"    {field.name}={value:.3g},")
    print(f"log loss {loss(found.x):.4f} of {weight.astype(bool).sum()} frames of a limb")


def _model(logs: Array) -> ContactModel:
    return ContactModel(*map(float, np.exp(logs)))


def _probabilities(feet: list[FeetInMotion], model: ContactModel) -> Array:
    """Return probabilities, (n_frames, n_takes, 2); evidence after a take's end is 0."""
    evidence = _padded([one.evidence(model) for one in feet])
    return two_state_probabilities(evidence, RATE_HZ, model.landing_rate, model.lift_rate)


def _padded(arrays: list[Array]) -> Array:
    result = np.zeros((max(map(len, arrays)), len(arrays), 2))
    for number, array in enumerate(arrays):
        result[: len(array), number] = array
    return result


def _takes(rng: np.random.Generator) -> Iterator[Weighted]:
    for kind in KINDS:
        for _ in range(TAKES_OF_A_KIND):
            positions, contacts = made_feet(kind, RATE_HZ, rng)
            positions = _on_a_real_floor(positions, rng)
            yield _feet(positions, rng), contacts.astype(float), np.ones(contacts.shape)
    for walk in labeled_walks():
        positions, contacts, known = (part[:: round(CAPTURE_RATE / RATE_HZ)] for part in walk)
        yield _feet(positions, rng), contacts.astype(float), WEIGHT_OF_WALKS * known


def _supports(rng: np.random.Generator) -> Iterator[Weighted]:
    for kind in PLANS:
        for _ in range(TAKES_OF_A_KIND):
            positions, contacts = made_supports(kind, RATE_HZ, rng)
            positions = _on_a_real_floor(positions, rng)
            ground = np.full(len(positions), rng.normal(scale=GROUND_M))
            yield _feet(positions, rng, ground), contacts.astype(float), np.ones(contacts.shape)


def _on_a_real_floor(positions: Array, rng: np.random.Generator) -> Array:
    """Return feet that are not exactly still, on a floor that is not exactly level."""
    moved = positions + _slow(positions.shape, rng.uniform(*UNEVEN_M), rng)
    moved[..., 2] += moved[..., :2] @ rng.normal(scale=SLOPE, size=2)
    return moved


def _feet(
    positions: Array, rng: np.random.Generator, ground: Array | None = None
) -> FeetInMotion:
    """Return the feet with noise or a slow error."""
    common = (*positions.shape[:2], 1, 3)
    if rng.random() < SLOW_TAKES:
        error = _slow(common, rng.uniform(*SLOW_ERROR_M), rng)
    else:
        noise = rng.choice(NOISE_M)
        own = np.sqrt(1.0 - COMMON_NOISE**2) * rng.normal(size=positions.shape)
        error = noise * (COMMON_NOISE * rng.normal(size=common) + own)
    return measure_feet(positions + error, RATE_HZ, ground)


def _slow(shape: tuple[int, ...], deviation: float, rng: np.random.Generator) -> Array:
    error = smooth_gaussian(rng.normal(size=shape), SLOW_S * RATE_HZ)
    return deviation * error / error.std()


if __name__ == "__main__":
    main()
