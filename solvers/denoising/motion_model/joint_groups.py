"""Find the joints that are looked at together: each alone, or with the one that it hangs on."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Flags


def find_joint_groups(
    parents: NDArray[np.intp], moves: Flags, n_joints: int
) -> NDArray[np.intp]:
    """Return each moving joint with its nearest ancestors that move.

    Parameters
    ----------
    parents : shape (n,)
        -1 where there is none.
    moves : shape (n,)
    n_joints : int
        Of a group.

    Returns
    -------
    shape (n_groups, n_joints)
        The joint first. Joints with too few ancestors have no group.
    """
    groups = []
    for joint in np.flatnonzero(moves):
        group, ancestor = [joint], parents[joint]
        while ancestor >= 0 and len(group) < n_joints:
            if moves[ancestor]:
                group.append(ancestor)
            ancestor = parents[ancestor]
        if len(group) == n_joints:
            groups.append(group)
    return np.array(groups, dtype=np.intp).reshape(-1, n_joints)
