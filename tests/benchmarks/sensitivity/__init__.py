"""How much each tuned constant of the solvers moves the errors on development clips."""

import os

# Before numpy is imported: several processes of several threads each only wait for each other.
for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ[variable] = "1"
