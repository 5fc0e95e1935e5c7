"""Share the pixels of a depth image between people."""

import numpy as np

from ..arrays import Array, Integers

NO_OWNER = -1
UNDIVIDED_FRACTION = 0.9
"""A connected component with at least this fraction of its pixels nearest to one person belongs
to that person. It guards a limb that is held out to another person
(`test_arm_held_out_to_another_person_keeps_its_owner`)."""


def share_pixels(distances: Array, components: Integers, reach: float) -> Integers:
    """Return the owner of each point, shape (n_points,); `NO_OWNER` for none.

    The owner is the nearest person. A connected component that is nearly all nearest to one
    person is all that person's. A component of which most points are out of reach has no owner.

    Parameters
    ----------
    distances : shape (n_points, n_people), meters
        Infinite for people who are absent.
    components : int, shape (n_points,)
        Connected component of each point, from 0.
    reach : float, meters
    """
    if not distances.shape[1] or not len(distances):
        return np.full(len(distances), NO_OWNER)
    n_people, n_components = distances.shape[1], int(components.max()) + 1
    nearest = distances.argmin(axis=1)
    counts = np.bincount(components * n_people + nearest, minlength=n_components * n_people)
    counts = counts.reshape(n_components, n_people)
    totals = np.maximum(counts.sum(axis=1), 1)
    main = counts.argmax(axis=1)
    undivided = counts.max(axis=1) >= UNDIVIDED_FRACTION * totals
    owners = np.where(undivided[components], main[components], nearest)
    in_reach = distances[np.arange(len(distances)), nearest] <= reach
    reached = np.bincount(components, weights=in_reach, minlength=n_components)
    return np.where((2.0 * reached >= totals)[components], owners, NO_OWNER)


def enlarged(owners: Integers, step: int, shape: tuple[int, ...]) -> Integers:
    """Return the owners of all pixels, (height, width), from every `step`-th column and row."""
    if step == 1:
        return owners
    from scipy.ndimage import distance_transform_edt  # slow to import: only when needed

    rows, columns = distance_transform_edt(
        owners == NO_OWNER, return_distances=False, return_indices=True
    )
    full = owners[rows, columns].repeat(step, axis=0).repeat(step, axis=1)
    cropped: Integers = full[: shape[0], : shape[1]]
    return cropped
