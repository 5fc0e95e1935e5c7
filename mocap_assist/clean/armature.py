"""Read an armature for Clean, and write the result."""

from functools import partial
from typing import Any, NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ...solvers.arrays import Array
from ...solvers.motion import JointLimits
from ..actions.armature_read import read_take
from ..actions.armature_write import (
    Output,
    assign_result,
    check_writable,
    count_modified,
    write_take,
)
from ..actions.contact_keys import animators_contacts, write_contacts
from ..actions.delta_layer import lay_delta, write_delta
from ..actions.limits import read_limits
from ..actions.take import ArmatureTake
from ..actions.unchanged_samples import RecordedChannels
from ..blender.block_references import SourceReference, kept_when_complete
from ..blender.compat import Source
from ..blender.time_slices import Steps, in_thread
from ..runtime.played import Played
from ..runtime.selection import played_source
from ..scene import history
from .button_settings import CleanChoices, CleanOutput, Limits
from .solve_cleaning import Cleaned, Recordings, names_of


class ArmatureReading(NamedTuple):
    """An armature and the action that it plays."""

    scene: bpy.types.Scene
    armature: bpy.types.Object
    recorded: Source
    played: Source
    """Action of the armature: the recorded one, or an earlier result made from it."""
    raw: ArmatureTake
    references: Played
    """To scene, armature and action, which stay valid over time slices."""

    @classmethod
    def of(
        cls, scene: bpy.types.Scene, armature: bpy.types.Object, choices: CleanChoices
    ) -> "Steps[ArmatureReading]":
        """Read what was recorded."""
        check_writable(armature)
        references = Played.of(scene, armature)
        recorded = history.cleaned_from(played_source(armature))
        raw = yield from read_take.steps(armature, scene, choices.frame_range, recorded)
        return cls._resolve(references, raw)

    @classmethod
    def _resolve(cls, references: Played, raw: ArmatureTake) -> "ArmatureReading":
        """Look up all data again: pointers are stale after a time slice."""
        scene, armature, played = references.find()
        return cls(scene, armature, history.cleaned_from(played), played, raw, references)

    def limits(self, choices: CleanChoices, chosen: frozenset[str]) -> JointLimits | None:
        """Return the rig's joint limits, if the settings use them."""
        if choices.joint_limits is not Limits.CONSTRAINTS:
            return None
        return read_limits(self.armature, self.raw, chosen)

    def contacts(self) -> Array | None:
        """Return the contacts that the animator keyed or edited, as `animators_contacts`."""
        return animators_contacts(self.played, self.raw.frames)

    def present(self, chosen: frozenset[str]) -> Steps[Recordings | None]:
        """Return an earlier result for the unchanged bones, if it differs from raw."""
        everything = len(chosen) == len(self.raw.rig.bones)
        if everything or self.played == self.recorded:
            return None
        take = yield from read_take.steps(
            self.armature, self.scene, source=self.played, grid=self.raw.grid
        )
        same = [names_of(one) for one in take.recordings] == [
            names_of(one) for one in self.raw.recordings
        ]
        return take.recordings if same else None

    def write(
        self,
        choices: CleanChoices,
        cleaned: Cleaned,
        types: dict[str, NDArray[np.uint8]],
        entry: dict[str, Any],
    ) -> Steps[tuple[str, int]]:
        """Write a new action and play it; return its name and how many curves were modified."""
        take = yield from in_thread.steps(partial(self.raw.with_recordings, cleaned.recordings))
        now = self._resolve(self.references, self.raw)
        n_modified = count_modified(now.played, cleaned.moved)
        action, slot = yield from write_take.steps(
            now.armature,
            now.played,
            take,
            cleaned.moved,
            types,
            recorded=RecordedChannels(self.raw, SourceReference.of(now.recorded)),
        )
        now = self._resolve(self.references, self.raw)
        if cleaned.planted is not None:
            write_contacts(
                now.armature,
                action,
                slot,
                take.frames,
                cleaned.planted.all_contacts,
                detected=True,
                edited=now.contacts(),
            )
        history.record(action, now.played, entry)
        if choices.result_as is CleanOutput.DELTA_LAYER:
            made = SourceReference.of((action, slot))
            with kept_when_complete(action):
                delta = yield from write_delta.steps(now.armature, now.recorded, (action, slot))
                now, (action, slot) = self._resolve(self.references, self.raw), made.find()
            lay_delta(now.armature, now.recorded, delta)
        else:
            assign_result(now.armature, action, slot, Output[choices.result_as.name])
        return action.name, n_modified
