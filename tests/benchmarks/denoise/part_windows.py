"""What the examples and the length of the patterns do: window sizes; right, wrong and mixed."""

from collections.abc import Mapping, Sequence

import numpy as np

from solvers.denoising import DenoiseMethod as DenoiseMethod
from solvers.motion import Motion

from ..shared import clips
from ..shared.noise import learn_channels
from ..shared.tables import Scores
from .cases import Case, Level
from .methods import PEERS
from .ours import Ours
from .part_denoise import leave_one_out
from .part_gaps import Gap, cut, score
from .part_gaps import ours as filled_by

WINDOWS = (0.2, 1 / 3, 0.5, 2 / 3, 1.0, 1.5, 2.0)
LEVELS = (Level(3.0), Level(3.0, 0.10))
GAP = Gap("left leg", ("LeftUpLeg",), 1.0)
HOPS = {
    "49_02": {"left": (8.0, 12.0), "right": (12.5, 15.5)},
    "49_03": {"left": (4.0, 5.5), "right": (6.0, 7.5)},
}
"""Seconds of the hops in the takes."""


def compare_windows(names: Sequence[str]) -> list[Scores]:
    """Our method with patterns of many lengths, on noise and on a gap."""
    found = [
        Scores("Window sizes, CMU walks at 3, 0", "mean absolute error, degrees"),
        Scores("Window sizes, CMU walks, left leg gone for 1 s", "geodesic angle, degrees"),
    ]
    for case in leave_one_out(clips.walks(), names, [LEVELS[0]]):
        missing = cut(case, GAP, 0)
        for window in WINDOWS:
            for name, method in (("ours", None), ("[LC10] as published", True)):
                kind = {"method": DenoiseMethod.PUBLISHED} if method else {}
                ours = Ours(window=window, **kind)
                column = f"{window:.2g} s"
                found[0].add(name, column, case.name, case.error(ours(case)))
                figure = score(case, filled_by(ours), *missing)
                found[1].add(name, column, case.name, figure)
        print(f"  {case.name} with windows", flush=True)
    return found


def compare_priors(names: Sequence[str]) -> tuple[list[Scores], dict[str, str]]:
    """Walks, hops and kicks with right, wrong, mixed and no examples.

    Returns the scores, and what the method said that it used, by target and prior.
    """
    found = [
        Scores(f"Right and wrong examples, {level}", "mean absolute error, degrees", "right")
        for level in LEVELS
    ]
    priors_used: dict[str, str] = {}
    for target, (takes, right, wrong) in _targets(names).items():
        for name, truth in takes.items():
            own = tuple(motion for other, motion in right.items() if other != name)
            other = tuple(wrong.values())
            priors = {"right": own, "wrong": other, "mixed": own + other}
            for scores, level in zip(found, LEVELS, strict=True):
                _add(
                    scores,
                    target,
                    Case(name, level, truth, own, learn_channels(own)),
                    priors,
                    priors_used,
                )
        print(f"  {target} with right and wrong examples", flush=True)
    return found, priors_used


def _add(
    scores: Scores,
    target: str,
    case: Case,
    priors: Mapping[str, tuple[Motion, ...]],
    priors_used: dict[str, str],
) -> None:
    for prior, training in priors.items():
        done = Ours().denoised(case.noisy_motion, training)
        error = case.error(case.values(done.recording))
        scores.add(prior, target, case.name, error, follows=False)
        priors_used[f"{target}, {prior}"] = done.prior_used
        published = Ours(method=DenoiseMethod.PUBLISHED)
        done = published.denoised(case.noisy_motion, training)
        error = case.error(case.values(done.recording))
        scores.add(f"[LC10] as published, {prior}", target, case.name, error, follows=False)
    alone = Ours(prior=False).denoised(case.noisy_motion, ())
    scores.add("none", target, case.name, case.error(case.values(alone.recording)))
    priors_used[f"{target}, none"] = alone.prior_used
    for peer in ("Gaussian, width tuned on the truth", "Hampel + GCV spline"):
        scores.add(peer, target, case.name, case.error(PEERS[peer](case)))


def _targets(
    names: Sequence[str],
) -> dict[str, tuple[Mapping[str, Motion], Mapping[str, Motion], Mapping[str, Motion]]]:
    """Return for each target: clips to clean, clips like them, clips unlike them."""
    walks = clips.walks()
    hops = {
        f"{take} {side}": _seconds(clips.hops()[take], *span)
        for take, sides in HOPS.items()
        for side, span in sides.items()
    }
    kicks, jogs = clips.hdm05("kickLFront1Reps"), clips.hdm05("jogLeftCircle4StepsRstart")
    dev = clips.DEV_ACTORS
    kicked = [name for name in kicks if name.split("_")[0] not in dev][: len(names)]
    return {
        "walk (wrong: hops)": ({name: walks[name] for name in names}, walks, hops),
        "hop (wrong: walks)": (hops, hops, walks),
        "kick (wrong: jogs)": ({name: kicks[name] for name in kicked}, kicks, jogs),
    }


def _seconds(motion: Motion, start: float, stop: float) -> Motion:
    frames = np.round(np.array([start, stop]) * motion.frame_rate).astype(int)
    return motion.slice(*frames)
