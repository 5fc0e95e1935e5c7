"""Fixtures: walks that differ, and a model of them."""

from collections.abc import Callable
from functools import cache

import pytest

from solvers.motion import Motion
from solvers.samples import GaitSettings, walking_gait
from solvers.variation import VariationModel, VaryMethod, VarySettings, learn_variation_model


@pytest.fixture(scope="session")
def walks() -> list[Motion]:
    return [
        walking_gait(
            GaitSettings(
                duration=120.0 / cadence,
                frame_rate=60.0,
                seed=seed,
                cadence=cadence,
                speed=speed,
            )
        )
        for seed, cadence, speed in ((1, 110, 1.2), (2, 106, 1.1), (3, 120, 1.35), (4, 95, 1.0))
    ]


@pytest.fixture(scope="session")
def learned_with(walks) -> Callable[[VaryMethod], VariationModel]:
    """Return the model of the walks by a method, learned once for all tests."""
    return cache(
        lambda method: learn_variation_model(walks, settings=VarySettings(method=method))
    )


@pytest.fixture(scope="session")
def model(learned_with) -> VariationModel:
    return learned_with(VaryMethod.MIXTURE)


@pytest.fixture(scope="session", params=VaryMethod, ids=lambda method: method.value)
def learned(request, learned_with) -> tuple[VariationModel, VarySettings]:
    """Return a model for each method, and the settings that go with it."""
    return learned_with(request.param), VarySettings(method=request.param)
