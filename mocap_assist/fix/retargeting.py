"""The last step of Fix My Take: give the fixed motion to another armature."""

from typing import Any

from ...solvers.errors import MocapAssistError, SolveCancelled
from ...solvers.retargeting import RetargetSettings
from ..blender.time_slices import Steps
from ..retarget.button_settings import RetargetBundle, RetargetChoices
from ..retarget.retargeting import read_retarget, write_retargeted
from ..runtime.subject import Subject

POINTS = "Not retargeted: points without a skeleton have no pose to give."


def retargeted(here: Subject, rig: str, report: dict[str, Any]) -> Steps[dict[str, Any]]:
    """Retarget what the subject plays to an armature; return the report with what was done.

    What cannot be retargeted is still fixed; the report then says why.
    """
    scene, subject = here.find()
    if subject.type != "ARMATURE":
        return _reported(report, POINTS, is_notice=True)
    bundle = RetargetBundle(RetargetChoices(target=rig), RetargetSettings())
    try:
        solve = yield from read_retarget.steps(scene, subject, bundle)
        sentence = yield from write_retargeted.steps(*here.find(), bundle, solve())
    except SolveCancelled:
        raise
    except MocapAssistError as error:  # the fixed action is written already
        return _reported(report, f"Not retargeted. {error}", is_notice=True)
    return _reported(report, sentence, is_notice=False)


def _reported(report: dict[str, Any], sentence: str, *, is_notice: bool) -> dict[str, Any]:
    headline = sentence if is_notice else report["headline"]
    return report | {"steps": [*report["steps"], sentence], "headline": headline}
