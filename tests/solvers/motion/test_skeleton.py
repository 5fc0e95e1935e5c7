"""A skeleton is a tree, and refuses other input."""

import pickle

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidMotionError
from solvers.motion import Skeleton


def test_children_and_depths_follow_from_parents(leg):
    assert leg.children == ((1,), (2,), (3,), ())
    assert leg.depths.tolist() == [0, 1, 2, 3]
    assert leg.ancestors(3) == [2, 1, 0]
    assert leg.subtree(1) == [1, 2, 3]


def test_rest_positions_sum_the_offsets(leg):
    assert_allclose(leg.rest_positions[:, 2], [0.9, 0.45, 0.03, 0.0], atol=1e-15)
    assert_allclose(leg.height, 0.9)


def test_end_site_is_a_leaf_with_the_end_suffix(leg):
    assert [leg.is_end_site(joint) for joint in range(4)] == [False, False, False, True]


def test_index_finds_joints_or_lists_the_existing_names(leg):
    assert leg.index("ankle") == 2
    with pytest.raises(InvalidMotionError, match="no joint tail; the skeleton has hip, knee"):
        leg.index("tail")


def test_selected_joints_get_the_nearest_selected_ancestor(body):
    joints = [body.index(name) for name in ("Hips", "LeftFoot", "Head")]

    chosen = body.select(joints)

    assert chosen.parents == (-1, 0, 0)
    assert_allclose(chosen.rest_positions, body.rest_positions[joints])


def test_skeleton_can_be_compared_and_pickled(leg):
    copied = pickle.loads(pickle.dumps(leg))

    assert copied.same_joints(leg)
    assert_allclose(copied.offsets, leg.offsets)


def test_skeleton_copies_its_offsets():
    offsets = np.zeros((1, 3))
    skeleton = Skeleton(("root",), (-1,), offsets)
    offsets[:] = 5.0

    assert_allclose(skeleton.offsets, 0.0)


@pytest.mark.parametrize(("names", "parents", "shape", "sentence"), [
    ((), (), (0, 3), "at least one joint"),
    (("a", "a"), (-1, 0), (2, 3), "Joint names must be unique; duplicates: a"),
    (("a", "b"), (-1,), (2, 3), r"as many parents \(not 1\)"),
    (("a", "b"), (-1, 0), (3, 3), r"not \(3, 3\)"),
    (("a", "b"), (0, -1), (2, 3), "first joint must be the root"),
    (("a", "b", "c"), (-1, 2, 0), (3, 3), "parent must come before its children: b"),
    (("a", "b"), (-1, -1), (2, 3), "parent must come before its children: b"),
])  # fmt: skip
def test_skeleton_raises_for_invalid_trees(names, parents, shape, sentence):
    with pytest.raises(InvalidMotionError, match=sentence):
        Skeleton(names, parents, np.zeros(shape))


def test_skeleton_raises_for_infinite_offsets():
    with pytest.raises(InvalidMotionError, match="not finite"):
        Skeleton(("a",), (-1,), np.array([[np.nan, 0, 0]]))
