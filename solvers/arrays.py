"""The array type that every family shares."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
"""Numbers in double precision; docstrings give the shape and the unit."""
