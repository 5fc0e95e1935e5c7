"""Sum the ground's forces on the parts of a simulated body."""

import numpy as np

from ..arrays import Array
from .world import World


def add_loads(world: World, loads: Array, factor: float) -> None:
    """Add the current upward ground force at each end of `PhysicsBody.ground_capsules`, times a
    factor, to `loads`, shape (n_ends,)."""
    data = world.data
    active = data.contact.efc_address >= 0
    addresses = data.contact.efc_address[active]
    if not len(addresses):
        return
    geometries = data.contact.geom[active].max(axis=1)
    offsets = data.contact.pos[active] - data.geom_xpos[geometries]
    along = np.einsum("ci,ci->c", offsets, data.geom_xmat[geometries][:, 2::3])
    ends = world.first_ends[geometries] + (along < 0.0)
    np.add.at(loads, ends, factor * data.efc_force[addresses])
