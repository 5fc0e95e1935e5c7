"""Variants of a generated rig by Rigify: its controls are keyed, its body varies."""

import numpy as np
import pytest

ENDS = ("DEF-hand.L", "DEF-hand.R", "DEF-foot.L", "DEF-foot.R", "DEF-spine.006")
FRAMES = (1, 8, 15, 22, 29)


@pytest.fixture
def hero(blank, rigify_file, walker):
    """The rig, and actions of it that the three walks were given to."""
    with blank.data.libraries.load(str(rigify_file), link=False) as (_, found):
        found.objects = ["Hero"]
    rig = blank.data.objects["Hero"]
    blank.context.scene.collection.objects.link(rig)
    names = "walk_1; walk_2; walk_3"
    done = blank.ops.mocap_assist.retarget(target="Hero", takes="LISTED", actions=names)
    assert done == {"FINISHED"}
    rig.location, rig.rotation_euler = (2.0, 1.0, 0.0), (0.0, 0.0, 0.5)
    blank.context.view_layer.objects.active = rig
    rig.select_set(True)
    play(rig, blank.data.actions["walk_1.Hero"])
    return rig


def play(rig, action):
    rig.animation_data.action = action
    rig.animation_data.action_slot = action.slots[0]


@pytest.fixture
def vary_hero(blank, hero, at_once):
    def press(**settings):
        before = set(blank.data.actions)
        names = "; ".join(f"walk_{number}.Hero" for number in (1, 2, 3))
        assert blank.ops.mocap_assist.vary(actions=names, **settings) == {"FINISHED"}
        return [action for action in blank.data.actions if action not in before]

    return press


def heads(poses, rig, frames=FRAMES):
    matrices = poses(rig, list(frames))
    return np.stack([matrices[name][:, :3, 3] for name in ENDS], axis=1)


def test_variant_with_amount_zero_equals_the_example(hero, vary_hero, poses):
    expected = heads(poses, hero)

    (copy,) = vary_hero(n_variants=1, amount=0.0, timing=0.0, base=1, plant_feet=False)

    assert hero.animation_data.action == copy
    np.testing.assert_allclose(heads(poses, hero), expected, atol=0.01)


def test_variants_differ_slightly_and_key_the_controls(hero, vary_hero, poses, keys_of):
    example = heads(poses, hero)

    made = vary_hero(n_variants=3)

    shown = []
    for action in made:
        play(hero, action)
        shown.append(heads(poses, hero))
    distances = [np.linalg.norm(one - example, axis=-1).mean() for one in shown]
    assert all(0.01 < each < 0.35 for each in distances), distances
    assert np.linalg.norm(shown[0] - shown[1], axis=-1).mean() > 0.01
    keyed = {path.split('"')[1] for _, path, _ in keys_of(made[0]) if '"' in path}
    assert not any(name.startswith(("DEF-", "ORG-", "MCH-")) for name in keyed)
    assert {"torso", "upper_arm_fk.L", "foot_fk.R"} <= keyed
    assert {row.name for row in hero.users_scene[0].mocap_assist.variants.rows} == {
        action.name for action in made
    }


def test_planted_feet_of_the_rig_do_not_slide(hero, vary_hero, poses, load, blank):
    made = vary_hero(n_variants=2)
    read = load("mocap_assist.variants.reading").read_body
    plant = load("solvers.denoising").plant_feet
    for action in made:
        play(hero, action)
        take = read(blank.context.scene, hero, (action, action.slots[0]))
        assert plant(take.parts[0].motion).slide_before < 0.05


def test_face_and_object_channels_are_constant_and_body_controls_vary(
    hero, vary_hero, blank, keys_of
):
    action = blank.data.actions["walk_1.Hero"]
    bag = action.layers[0].strips[0].channelbags[0]
    jaw, chest = (f'pose.bones["{bone}"].location' for bone in ("jaw_master", "chest"))
    for path in ('["shown"]', jaw, chest):
        curve = bag.fcurves.new(path, index=0)
        curve.keyframe_points.insert(1, 0.01)
        curve.keyframe_points.insert(40, 0.02)

    (made,) = vary_hero(n_variants=1)

    paths = {path for _, path, _ in keys_of(made)}
    assert {'["shown"]', jaw} <= paths
    assert chest not in paths


def test_rig_is_evaluated_once_for_each_press(hero, vary_hero, load, monkeypatch):
    reading, looks = load("mocap_assist.variants.reading"), []
    shown = reading.with_body_shown
    look = shown.steps
    monkeypatch.setattr(shown, "steps", lambda *given: looks.append(given) or look(*given))

    vary_hero(n_variants=1)
    assert len(looks) == 3
    vary_hero(n_variants=1)
    assert len(looks) == 6
