"""Our own denoiser under its several settings, as methods of the benchmark."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

from solvers.arrays import Array
from solvers.denoising import (
    Denoised,
    DenoiseMethod,
    DenoiseSettings,
    FilterBases,
    FilterBasesSettings,
    denoise,
    learn_filter_bases,
)
from solvers.motion import Motion

from .cases import Case

WINDOW = FilterBasesSettings().window


@dataclass(frozen=True)
class Ours:
    """`denoise` with bases from the training clips, or (`prior` false) from the take itself."""

    method: DenoiseMethod = DenoiseSettings().method
    prior: bool = True
    window: float = WINDOW

    def __call__(self, case: Case) -> Array:
        """Denoise the case."""
        return case.values(self.denoised(case.noisy_motion, case.training).recording)

    def denoised(self, noisy: Motion, training: Sequence[Motion]) -> Denoised:
        """Denoise any motion."""
        bases = learned(tuple(training), self.window) if self.prior else None
        return denoise(noisy, bases, settings=DenoiseSettings(method=self.method))


@lru_cache(maxsize=4)
def learned(training: tuple[Motion, ...], window: float) -> FilterBases:
    """Learn once for all levels of a clip."""
    return learn_filter_bases(training, settings=FilterBasesSettings(window=window))


OURS = {
    "ours": Ours(),
    "ours, no prior": Ours(prior=False),
    "[LC10] as published": Ours(method=DenoiseMethod.PUBLISHED),
}
SHORT_NAMES = {"ours": "ours", "published": "[LC10] as published", "alone": "ours, no prior"}
