"""Rigs whose left is the viewer's: without toes, only bent knees show where they face."""

from dataclasses import replace

from rigs import rigify_deform

from solvers.motion import Motion, find_humanoid_map
from solvers.progress import Remark, collect_remarks, unwatched
from solvers.retargeting import retarget
from solvers.samples import GaitSettings, walking_gait


def walk_without_toes() -> Motion:
    walk = walking_gait(GaitSettings(duration=2.0, frame_rate=30.0))
    kept = [j for j, name in enumerate(walk.skeleton.names) if "Toe" not in name]
    return Motion(
        walk.skeleton.select(kept), walk.rotations[:, kept], walk.root_positions, 30.0
    )


def with_sides_of_the_viewer(walk: Motion) -> Motion:
    words = {"Left": "Right", "Right": "Left"}
    names = tuple(
        words[side] + name.removeprefix(side)
        if (side := next((s for s in words if name.startswith(s)), ""))
        else name
        for name in walk.skeleton.names
    )
    return replace(walk, skeleton=replace(walk.skeleton, names=names))


def remarks_on(walk: Motion) -> list[Remark]:
    target, remarks = rigify_deform(), []
    roles = find_humanoid_map(walk.skeleton), find_humanoid_map(target)
    listener = collect_remarks(unwatched, remarks)
    retarget(walk, roles[0], target, roles[1], progress=listener)
    return remarks


def test_knees_that_bend_backward_are_reported():
    (remark,) = remarks_on(with_sides_of_the_viewer(walk_without_toes()))

    assert "If left and right are mirrored, swap them" in remark


def test_body_without_toes_is_retargeted_without_a_remark():
    assert remarks_on(walk_without_toes()) == []
