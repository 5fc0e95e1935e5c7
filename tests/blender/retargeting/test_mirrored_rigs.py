"""A source whose left is the viewer's: the button Retarget and its panel report the knees."""

import pytest

SENTENCE = "The knees of the source bend backward."


@pytest.fixture
def mirrored_walker(load, import_bvh, tmp_path):
    """A walk without toes, with the names of left and right swapped."""
    samples, files = load("solvers.samples"), load("solvers.recordings")
    motion = load("solvers.motion")
    walk = samples.walking_gait(samples.GaitSettings(duration=2.0, frame_rate=30.0))
    kept = [j for j, name in enumerate(walk.skeleton.names) if "Toe" not in name]
    body = walk.skeleton.select(kept)
    names = tuple(
        name.replace("Left", "*").replace("Right", "Left").replace("*", "Right")
        for name in body.names
    )
    walk = motion.Motion(
        motion.Skeleton(names, body.parents, body.offsets),
        walk.rotations[:, kept], walk.root_positions, 30.0,
    )  # fmt: skip
    files.write_bvh(walk, tmp_path / "mirrored.bvh")
    return import_bvh(tmp_path / "mirrored.bvh", 0.01)


def test_panel_and_history_report_backward_knees(
    mirrored_walker, make_rig, blank, draw, give, load
):
    shown = blank.context.scene.mocap_assist.retarget
    target = make_rig("Mixamo")
    shown.target = target.name

    action = give(mirrored_walker, target)

    history = load("mocap_assist.scene.history")
    (remark,) = history.history(action)[-1]["remarks"]
    assert SENTENCE in remark
    assert SENTENCE in " ".join(draw("MOCAP_PT_retarget"))


def test_the_message_of_the_button_reports_backward_knees(
    mirrored_walker, make_rig, blank, load
):
    target = make_rig("Mixamo")
    retargeting = load("mocap_assist.retarget.scene_retargeting")
    button_settings = load("mocap_assist.retarget.button_settings")
    settings = button_settings.RetargetBundle(
        button_settings.RetargetChoices(target=target.name),
        load("solvers.retargeting").RetargetSettings(),
    )
    scene = blank.context.scene

    solve = retargeting.read_retarget(scene, mirrored_walker, settings)
    sentence = retargeting.write_retargeted(
        scene, mirrored_walker, settings, solve(progress=lambda *_: None)
    )

    assert SENTENCE in sentence


def test_a_walk_with_true_sides_is_given_without_a_word(walker, make_rig, blank, draw, give):
    target = make_rig("Mixamo")
    blank.context.scene.mocap_assist.retarget.target = target.name

    give(walker, target)

    assert SENTENCE not in " ".join(draw("MOCAP_PT_retarget"))
