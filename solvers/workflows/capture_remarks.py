"""What an animator should know about a capture."""

import numpy as np

from ..depth_scene import Actor
from ..depth_tracking.body import default_body
from ..depth_tracking.capturing import Capture

MANY = 0.2
"""Share of joints out of sight from which the report tells it."""
AGREEING, BESIDE = 0.55, 0.035
"""Share of pixels that show both body and actor, and metres between them in depth, from which
on they are unlike; usual are .8 and .02."""
THICK = 1.3
"""How many times as thick as usual for its length a body may be: a wrong focal length changes
how long and wide it seems, but not how deep."""


def capture_remarks(actor: Actor, found: Capture, *, fitted: bool) -> tuple[str, ...]:
    """Return sentences on the actor, and how they were found.

    Parameters
    ----------
    actor : Actor
        Whose remarks come first.
    found : Capture
    fitted : bool
        Whether the body was found in the recording, rather than given.
    """
    said = [*actor.remarks]
    if actor.floor is None:
        said.append("No floor is seen: the camera is taken to have been level.")
    out_of_sight = float(found.doubtful.mean())
    if out_of_sight > MANY:
        said.append(
            f"{100 * out_of_sight:.0f} % of the joints were out of sight or badly explained,"
            " and are guessed from the frames before and after."
        )
    seen = np.isfinite(found.residual)
    if actor.seen.all() and not seen.all():
        said.append(f"In {int((~seen).sum())} of {len(seen)} frames nobody is seen.")
    thick = thickness(found)
    if fitted and thick > THICK:
        said.append(
            f"The actor would be {thick:.1f} times as thick as usual: check the focal length of"
            " the camera, the scale, and whether the actor carries something."
        )
    elif actor.feet_seen and seen.any():
        said += _unlike(float(np.median(found.coverage[seen])), np.median(found.residual[seen]))
    return tuple(said)


def _unlike(agreeing: float, beside: float) -> list[str]:
    if agreeing >= AGREEING and beside <= BESIDE:
        return []
    return [
        f"Body and pictures agree badly ({100 * agreeing:.0f} % overlap, {100 * beside:.1f} cm"
        " apart in depth): check the focal length, the scale, and whether there is anything but"
        " the actor in the pictures."
    ]


def thickness(found: Capture) -> float:
    """Return how thick the body is for its length, compared with the usual one."""
    usual = default_body()
    radii = np.median(found.body.radii / usual.radii)
    return float(radii / np.median(found.body.lengths / usual.lengths))
