"""Several people in one depth recording, tracked together with one depth buffer."""

from typing import TYPE_CHECKING

from ...import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .capture_people import capture_people

__all__ = ["capture_people"]

import_on_demand(__name__)
