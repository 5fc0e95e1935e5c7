"""A map that was found before is that of the very same skeleton only."""

from dataclasses import replace

import pytest
from rigs import mixamo

from solvers.motion import find_humanoid_map
from solvers.motion.humanoid.structure import roles_by_structure


def test_other_lengths_or_names_are_evaluated_again():
    rig = mixamo()
    found = find_humanoid_map(rig)

    unnamed = replace(rig, names=tuple(f"joint_{n}" for n in range(rig.n_joints)))

    assert find_humanoid_map(replace(rig)) is found
    assert find_humanoid_map(unnamed).joint("hips") == "joint_0"
    assert find_humanoid_map(mixamo(2.0)) is not found


def test_structure_stays_as_found_when_a_caller_changes_its_copy():
    rig = mixamo()
    expected = dict(roles_by_structure(rig).joints)

    roles_by_structure(rig).joints.clear()

    assert expected and roles_by_structure(rig).joints == expected


def test_structure_follows_offsets_that_change_in_place():
    rig = mixamo()
    height = roles_by_structure(rig).height

    rig.offsets[:] *= 2.0
    changed = roles_by_structure(replace(rig)).height

    assert changed == pytest.approx(2.0 * height)
