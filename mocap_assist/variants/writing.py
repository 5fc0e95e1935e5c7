"""Write variants into the scene, one at a time."""

from typing import NamedTuple

import bpy

from ...solvers.errors import InvalidMotionError
from ..actions.action_write import write_action
from ..actions.armature_write import check_writable
from ..blender import compat
from ..blender.compat import Source
from ..blender.time_slices import Sliced, Steps, should_yield
from ..find_similar.previews import give_picture
from ..runtime.subject import Subject, check_unchanged
from ..scene import history
from . import listing
from .button_settings import VaryBundle
from .keys import BaseExample, hold_others, without_still
from .reading import Switches, VaryScene, read_chosen_actions
from .solve_varying import Varied
from .tags import names_for, tag_variant


@Sliced
def write_variants(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    settings: VaryBundle,
    varied: Varied,
    solved_digest: str | None = None,
) -> Steps[str]:
    """Write a new action for each variant; return a sentence about them.

    Actions are known by their numbers from one turn to the next: undo replaces what pointers
    mean. Where not all can be written, none stays.

    Parameters
    ----------
    scene : bpy.types.Scene
    armature : bpy.types.Object
    settings : VaryBundle
    varied : Varied
    solved_digest : fingerprint of the solved problem; None if it cannot have changed since

    Raises
    ------
    InvalidMotionError
        The actions are not what was solved.
    """
    here, made = Subject.of(scene, armature), list[int]()
    found = yield from read_chosen_actions.steps(scene, armature, settings)
    scene, armature = here.find()
    writer = _Writer.of(found, settings, varied)
    yield from check_unchanged.steps(armature, solved_digest, found.problem)
    scene, armature = here.find()
    try:
        while len(made) < len(writer.names):
            made.append(writer.write(armature, len(made)))
            if should_yield():
                yield len(made) / len(writer.names)
                scene, armature = here.find()
        check_writable(armature)
    except BaseException:
        for action in _actions_with_numbers(made):
            bpy.data.actions.remove(action)
        raise
    listing.list_variants(scene, armature, _actions_with_numbers(made))
    return writer.message()


class _Writer(NamedTuple):
    """Data that all variants share."""

    settings: VaryBundle
    varied: Varied
    examples: tuple[str, ...]
    slot: str
    """Identifier of the first example's."""
    stage: BaseExample
    switches: Switches
    names: list[str]

    @classmethod
    def of(cls, found: VaryScene, settings: VaryBundle, varied: Varied) -> "_Writer":
        first = found.sources[0]
        return cls(
            settings,
            varied,
            tuple(action.name for action, _ in found.sources),
            first[1].identifier,
            BaseExample.of(found.takes, first, found.movers),
            found.switches,
            names_for(first[0], len(varied.motions)),
        )

    def write(self, armature: bpy.types.Object, number: int) -> int:
        """Write a variant; return the number of its action in this session."""
        motion = self.varied.motions[number]
        frames = self.stage.frames(motion.n_frames)
        controls = self.varied.keys
        keys = without_still(controls[number]) if controls else self.stage.keys(motion)
        action, slot = write_action(armature, self.names[number], frames, keys, self.switches)
        try:
            hold_others(action, slot, self.stage)
            entry = self._entry(number)
            history.record(action, self._first_example(), entry, of_another_rig=True)
        except BaseException:
            bpy.data.actions.remove(action)
            raise
        tag_variant(action, list(self.examples), number + 1, self.settings.varying.seed)
        give_picture(action, self.varied.pictures[number])
        return int(action.session_uid)

    def _first_example(self) -> Source:
        """Return the first example, as it is now."""
        action = bpy.data.actions.get(self.examples[0])
        slot = action and compat.find_slot(action, self.slot)
        if not slot:
            raise InvalidMotionError(
                f"{self.examples[0]} was deleted during the solve. Press the button again."
            )
        return action, slot

    def _entry(self, number: int) -> dict[str, object]:
        """Return the entry for the action's history."""
        return {
            "operation": "vary",
            "settings": history.json_ready(*self.settings),
            "examples": list(self.examples),
            "number": number + 1,
        }

    def message(self) -> str:
        """Return a sentence about all variants."""
        n_variants, n_examples = len(self.names), len(self.examples)
        made = self.names[0] if n_variants == 1 else f"{n_variants} variants"
        of = self.examples[0] if n_examples == 1 else f"{n_examples} actions"
        return " ".join([f"{made} of {of}.", *self.varied.remarks])


def _actions_with_numbers(numbers: list[int]) -> list[bpy.types.Action]:
    """Return the actions with these numbers of the session."""
    wanted = set(numbers)
    return [action for action in bpy.data.actions if action.session_uid in wanted]
