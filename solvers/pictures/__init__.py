"""Draw stick figures, curves and tables as PNG files, for documents, tests and reports.

>>> from solvers.pictures import StickFigureSettings, draw_stick_figures
>>> from solvers.samples import GaitSettings, walking_gait
>>> walk = walking_gait(GaitSettings(duration=1.0))
>>> picture = draw_stick_figures({"walk": walk}, StickFigureSettings(n_figures=5, height=100))
>>> picture.pixels.shape[2], str(picture.pixels.dtype)
(3, 'uint8')
"""

from typing import TYPE_CHECKING

from ..import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .canvas import SERIES, Canvas, lighten_color
    from .curves import CurveSettings, draw_curves
    from .picture import Picture, stack_pictures
    from .stick_figures import (
        StickFigureSettings,
        ViewDirection,
        draw_stick_figures,
        project_to_view,
    )
    from .table import draw_table

__all__ = [
    "SERIES",
    "Canvas",
    "CurveSettings",
    "Picture",
    "StickFigureSettings",
    "ViewDirection",
    "draw_curves",
    "draw_stick_figures",
    "draw_table",
    "lighten_color",
    "project_to_view",
    "stack_pictures",
]

import_on_demand(__name__)
