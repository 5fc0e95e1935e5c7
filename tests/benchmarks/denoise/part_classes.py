"""The eleven motion classes of HDM05: noise and outliers, leave one actor out."""

from ..shared import clips
from ..shared.noise import angle_error, learn_channels
from ..shared.tables import Scores
from .cases import Case, Level
from .methods import Method

LEVELS = (Level(3.0), Level(3.0, 0.10))
SHORT = {
    "depositFloorR": "deposit",
    "elbowToKnee1RepsLelbowStart": "elbow to knee",
    "grabHighR": "grab high",
    "hopBothLegs1hops": "hop",
    "jogLeftCircle4StepsRstart": "jog",
    "kickLFront1Reps": "kick",
    "lieDownFloor": "lie down",
    "rotateArmsBothBackward1Reps": "rotate arms",
    "sneak2StepsLStart": "sneak",
    "squat1Reps": "squat",
    "throwBasketball": "throw",
}


def class_cases(n_clips: int, dev: bool) -> dict[str, list[Case]]:
    """Return the cases of each class; the examples are the other actors' clips of it.

    `n_clips` clips of each class, in turn from the scored (or else the development) actors.
    """
    found = {}
    for name in clips.hdm05_classes():
        takes = clips.hdm05(name)
        actors = sorted({take.split("_")[0] for take in takes})
        chosen = [actor for actor in actors if (actor in clips.DEV_ACTORS) == dev]
        by_actor = [[take for take in takes if take.startswith(actor)] for actor in chosen]
        longest = max(map(len, by_actor))
        mixed = [each[i] for i in range(longest) for each in by_actor if i < len(each)]
        found[name] = []
        for take in mixed[:n_clips]:
            actor = take.split("_")[0]
            training = tuple(
                motion for other, motion in takes.items() if other.split("_")[0] != actor
            )
            channels = learn_channels(training)
            found[name] += [
                Case(take, level, takes[take], training, channels) for level in LEVELS
            ]
    return found


def compare_classes(cases: dict[str, list[Case]], methods: dict[str, Method]) -> list[Scores]:
    """Run all methods on all classes; one table for each level, one column for each class.

    By angles of rotations: actors differ so much that channels about the mean of the others
    come near half a turn, where they jump.
    """
    unit = "geodesic angle of local rotations, degrees"
    found = {str(level): Scores(f"HDM05 classes at {level}", unit) for level in LEVELS}
    for name, several in cases.items():
        for case in several:
            for title, method in methods.items():
                estimate = case.motion(method(case))
                figure = float(angle_error(estimate, case.truth, case.channels.joints).mean())
                scores = found[str(case.level)]
                scores.add(title, SHORT.get(name, name), case.name, figure, follows=False)
        print(f"  HDM05 {name}", flush=True)
    for scores in found.values():
        scores.add_overall()
    return list(found.values())
