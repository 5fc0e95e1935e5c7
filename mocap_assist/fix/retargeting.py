"""The last step of Fix My Take: give the fixed motion to another armature."""

from collections.abc import Callable
from typing import Any

from ...solvers.errors import MocapAssistError, SolveCancelled
from ...solvers.retargeting import RetargetSettings
from ..blender.time_slices import Steps, runs_in_slices
from ..jobs.job import Job, run, runs_here
from ..retarget.button_settings import RetargetBundle, RetargetChoices
from ..retarget.scene_retargeting import read_retarget, write_retargeted
from ..runtime.subject import Subject

POINTS = "Not retargeted: points have no skeleton, so there is no pose to transfer."


def retargeted(here: Subject, rig: str, report: dict[str, Any]) -> Steps[dict[str, Any]]:
    """Retarget the subject's action to an armature; return the extended report.

    What cannot be retargeted is still fixed; the report then says why.
    """
    scene, subject = here.find()
    if subject.type != "ARMATURE":
        return _report_sentence(report, POINTS, is_notice=True)
    bundle = RetargetBundle(RetargetChoices(target=rig), RetargetSettings())
    try:
        solve = yield from read_retarget.steps(scene, subject, bundle)
        result = yield from _solve(solve)
        sentence = yield from write_retargeted.steps(*here.find(), bundle, result)
    except SolveCancelled:
        raise
    except MocapAssistError as error:  # the fixed action is written already
        return _report_sentence(report, f"Not retargeted. {error}", is_notice=True)
    return _report_sentence(report, sentence, is_notice=False)


def _solve(solve: Callable[..., Any]) -> Steps[Any]:
    """Solve in a process of its own, unless it is short; meanwhile only Esc works."""
    if runs_here(solve) or not runs_in_slices():
        return run(solve)
    job = Job(solve)
    try:
        while not job.done():
            yield job.progress()[0]
    except BaseException:  # such as Esc, or another file
        job.cancel()
        job.tidy_up()
        raise
    return job.result()


def _report_sentence(
    report: dict[str, Any], sentence: str, *, is_notice: bool
) -> dict[str, Any]:
    headline = sentence if is_notice else report["headline"]
    return report | {"steps": [*report["steps"], sentence], "headline": headline}
