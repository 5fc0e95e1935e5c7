"""Read the markers of a take for Clean, and write the result."""

from typing import Any, NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ...solvers.errors import InvalidMotionError
from ..actions.armature_write import Output, assign_result, check_writable
from ..actions.markers.holders import markers_of
from ..actions.markers.take import MarkerTake, read_markers, write_markers
from ..blender.time_slices import Steps
from ..runtime.subject import Subject
from ..scene import history
from .button_settings import CleanChoices, CleanOutput
from .solve_cleaning import Cleaned, Recordings


class MarkerReading(NamedTuple):
    """Markers below one object."""

    scene: bpy.types.Scene
    holder: bpy.types.Object
    raw: MarkerTake
    here: Subject
    """Scene and holder, which stay valid over time slices."""

    @classmethod
    def of(
        cls, scene: bpy.types.Scene, holder: bpy.types.Object, choices: CleanChoices
    ) -> "Steps[MarkerReading]":
        """Read what was recorded."""
        if choices.result_as is CleanOutput.DELTA_LAYER:
            raise InvalidMotionError(
                "Delta Layer is for armatures. Choose another output for markers."
            )
        for marker in markers_of(holder):
            check_writable(marker)
        here = Subject.of(scene, holder)
        raw = yield from read_markers.steps(holder, scene, choices.frame_range, recorded=True)
        scene, holder = here.find()
        return cls(scene, holder, raw, here)

    def limits(self, choices: CleanChoices, chosen: frozenset[str]) -> None:
        """Return None: markers have no joint limits."""

    def contacts(self) -> None:
        """Return None: markers have no foot contacts."""

    def present(self, chosen: frozenset[str]) -> Steps[Recordings | None]:
        """Return an earlier result for the unchanged markers."""
        if len(chosen) == self.raw.tracks.n_points:
            return None
        played = yield from read_markers.steps(self.holder, self.scene, grid=self.raw.grid)
        same = played.tracks.names == self.raw.tracks.names
        return played.recordings if same else None

    def write(
        self,
        choices: CleanChoices,
        cleaned: Cleaned,
        types: dict[str, NDArray[np.uint8]],
        entry: dict[str, Any],
    ) -> Steps[tuple[str, int]]:
        """Write a new action and play it; return its name, and that no curve was modified."""
        scene, holder = self.here.find()
        played = yield from read_markers.steps(holder, scene, grid=self.raw.grid)
        take = played.with_recordings(cleaned.recordings)
        names = set()
        written = yield from write_markers.steps(take, cleaned.moved, types)
        for marker, source, source_new in written:
            if source_new[0].name not in names:
                history.record(source_new[0], source, entry)
            names.add(source_new[0].name)
            assign_result(marker, *source_new, Output[choices.result_as.name])
        return ", ".join(sorted(names)), 0
