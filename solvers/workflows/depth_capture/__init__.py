"""The motion of actors in depth recordings: separated, captured, planted and reported."""

from typing import TYPE_CHECKING

from ...import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .capture_every_person import capture_every_person, capture_separated_people
    from .capture_from_cameras import (
        capture_from_cameras,
        capture_seen_actor,
        find_actor_of_cameras,
    )
    from .capture_recording import CapturedMotion, capture_actor, capture_recording
    from .capture_remarks import capture_remarks, relative_thickness

__all__ = [
    "CapturedMotion",
    "capture_actor",
    "capture_every_person",
    "capture_from_cameras",
    "capture_recording",
    "capture_remarks",
    "capture_seen_actor",
    "capture_separated_people",
    "find_actor_of_cameras",
    "relative_thickness",
]

import_on_demand(__name__)
