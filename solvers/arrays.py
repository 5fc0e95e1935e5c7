"""The array types that every family shares."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
"""Numbers in double precision; docstrings give the shape and the unit."""
Single = NDArray[np.float32]
"""Numbers in single precision."""
Flags = NDArray[np.bool_]
"""Whether something holds, by frame, joint or pixel."""
Integers = NDArray[np.intp]
"""Indices and counts."""
