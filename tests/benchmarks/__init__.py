"""Benchmarks of all methods next to their peers.

They compute with one thread and one kernel of linear algebra on every machine. Where a tracker
that all but fails starts again is decided by the last digits, so another kernel of the same
library moves such rows: with 80 columns of depth from 4.70 cm to 5.67.
"""

import os
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).parents[1] / "fixtures"))  # for clusters and rigs

# Before numpy is imported.
for variable, value in {
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "OPENBLAS_CORETYPE": "Haswell",  # runs on every x86 processor since 2013
}.items():
    os.environ.setdefault(variable, value)
