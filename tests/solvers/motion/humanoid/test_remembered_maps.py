"""A map that was found before is that of the very same skeleton only."""

from dataclasses import replace

from rigs import mixamo

from solvers.motion import find_humanoid_map


def test_other_lengths_or_names_are_evaluated_again():
    rig = mixamo()
    found = find_humanoid_map(rig)

    unnamed = replace(rig, names=tuple(f"joint_{n}" for n in range(rig.n_joints)))

    assert find_humanoid_map(replace(rig)) is found
    assert find_humanoid_map(unnamed).joint("hips") == "joint_0"
    assert find_humanoid_map(mixamo(2.0)) is not found
