"""What the button Vary writes into the scene, one variant at a time."""

import bpy

from ...solvers.errors import InvalidMotionError
from ..jobs.varying import Varied
from ..library.previews import give_picture
from ..scene import compat, history
from ..scene.action_write import write_action
from ..scene.armature_write import check_writable
from ..scene.compat import Source
from ..subject import check_unchanged
from . import listing
from .choices import VaryBundle
from .keys import Stage, hold_others, without_still
from .reading import read
from .tags import names_for, tag


class VariantsWriter:
    """New actions for variants; `step` writes one, so that nobody waits long.

    Actions are known by their numbers between steps: undo replaces what pointers mean.

    Parameters
    ----------
    scene : bpy.types.Scene
    armature : bpy.types.Object
    settings : VaryBundle
    varied : Varied
    asked : fingerprint of what was solved; None where nothing can have changed since

    Raises
    ------
    InvalidMotionError
        The actions are not what was solved.
    """

    def __init__(
        self,
        scene: bpy.types.Scene,
        armature: bpy.types.Object,
        settings: VaryBundle,
        varied: Varied,
        asked: str | None = None,
    ) -> None:
        found = read(scene, armature, settings)
        check_unchanged(armature, asked, found.problem)
        self._settings, self._varied = settings, varied
        self._examples = [action.name for action, _ in found.sources]
        self._slot = found.sources[0][1].identifier
        self._stage = Stage.of(found.takes, found.sources[0], found.movers)
        self._switches = found.switches
        self._names = names_for(found.sources[0][0], len(varied.motions))
        self._made: list[int] = []

    @property
    def fraction(self) -> float:
        """How much is written."""
        return len(self._made) / len(self._names)

    def step(self, scene: bpy.types.Scene, armature: bpy.types.Object) -> str:
        """Write the next variant; return a sentence once all are written."""
        place = len(self._made)
        motion, stage = self._varied.motions[place], self._stage
        frames = stage.frames(motion.n_frames)
        controls = self._varied.keys
        keys = without_still(controls[place]) if controls else stage.keys(motion)
        action, slot = write_action(armature, self._names[place], frames, keys, self._switches)
        self._made.append(action.session_uid)
        hold_others(action, slot, stage)
        history.record(action, self._source(), self._entry(place), of_another_rig=True)
        tag(action, self._examples, place + 1, self._settings.varying.seed)
        give_picture(action, self._varied.pictures[place])
        if len(self._made) < len(self._names):
            return ""
        check_writable(armature)
        listing.fill(scene, armature, _numbered(self._made))
        return self._sentence()

    def take_back(self) -> None:
        """Remove what was written."""
        for action in _numbered(self._made):
            bpy.data.actions.remove(action)

    def _source(self) -> Source:
        """Return the first example, as it is now."""
        action = bpy.data.actions.get(self._examples[0])
        slot = action and compat.slot_called(action, self._slot)
        if not slot:
            raise InvalidMotionError(
                f"{self._examples[0]} was deleted meanwhile. Press the button again."
            )
        return action, slot

    def _entry(self, place: int) -> dict[str, object]:
        """Return what the action remembers of how it was made."""
        return {
            "operation": "vary",
            "settings": history.plain(*self._settings),
            "examples": self._examples,
            "number": place + 1,
        }

    def _sentence(self) -> str:
        n_variants, n_examples = len(self._names), len(self._examples)
        made = self._names[0] if n_variants == 1 else f"{n_variants} variants"
        of = self._examples[0] if n_examples == 1 else f"{n_examples} actions"
        return " ".join([f"{made} of {of}.", *self._varied.remarks])


def _numbered(numbers: list[int]) -> list[bpy.types.Action]:
    """Return the actions with these numbers of the session."""
    wanted = set(numbers)
    return [action for action in bpy.data.actions if action.session_uid in wanted]
