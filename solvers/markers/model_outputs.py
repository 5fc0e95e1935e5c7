"""Points of a take that a model computed: no marker was there."""

import re
from collections import defaultdict
from collections.abc import Sequence

from .marker_sets import PREFIX

SIDED = ("CL", "FE", "FO", "HN", "HU", "RA", "TI", "TO")
SEGMENTS = ("HED", "TRX", "PEL", "SPI", *(side + segment for side in "LR" for segment in SIDED))
"""Segments of Plug-in-Gait; each has an origin and the ends of three axes."""
AXES = "OALP"
"""Last letters: origin, anterior, lateral, proximal (Vicon Plug-in Gait Reference Guide)."""
COMPUTED = re.compile(
    r"""^cent(re|er)ofmass(floor)?$       # of Plug-in-Gait
    | ^[lr]_?[hkaesw]jc$                  # centers of hip, knee, ankle, elbow, shoulder, wrist
    | ^v_                                 # landmarks of Visual3D
    | (angles?|moments?|forces?|powers?)$ # such as LHipAngles: no positions
    """,
    re.VERBOSE | re.IGNORECASE,
)


def find_model_outputs(names: Sequence[str]) -> tuple[int, ...]:
    """Return the indices of points that a model computed from the markers.

    Those are the segments of Plug-in-Gait (`HEDO`, `LFEP`: only where all four points of a
    segment are there, since `LCLA` alone is a marker on the clavicle), centers of mass and of
    joints, angles, moments, forces and powers.
    """
    segments: dict[tuple[str, str], list[int]] = defaultdict(list)
    found = set()
    for index, name in enumerate(names):
        match = PREFIX.match(name.strip())
        prefix, label = (match[1] or "", match[2]) if match else ("", name)
        if COMPUTED.search(label) or COMPUTED.search(name):
            found.add(index)
        if len(label) == 4 and label[:3].upper() in SEGMENTS and label[3].upper() in AXES:
            segments[prefix, label[:3].upper()].append(index)
    for indices in segments.values():
        if len(indices) >= len(AXES):
            found.update(indices)
    return tuple(sorted(found))
