"""The best matches become what Vary makes variants of."""

import json

import numpy as np
import pytest


@pytest.fixture
def use(blank):
    """Press Use as Examples; return the actions that are ticked in the panel Vary."""

    def press(**settings):
        assert blank.ops.mocap_assist.use_matches(**settings) == {"FINISHED"}
        ticked = blank.context.scene.mocap_assist.vary.actions.split("; ")
        return [blank.data.actions[name] for name in ticked]

    return press


@pytest.fixture
def at_once(load, monkeypatch):
    monkeypatch.setattr(
        load("mocap_assist.runtime.solver_operator"), "run", lambda solve: solve()
    )


def test_variants_are_made_from_matches(find, newcomer, use, blank, at_once, capfd):
    armature = newcomer("walk")
    query = armature.animation_data.action
    listed = [row.name for row in find()]

    examples = use(n_best=2)

    assert [each.name for each in examples] == [f"{n}.{armature.name}" for n in listed[:2]]
    assert json.loads(examples[0]["mocap_assist_clip"])["clip"] == listed[0]
    assert armature.animation_data.action == query
    assert "Vary now uses 2 library clips as examples." in capfd.readouterr().out
    assert blank.ops.mocap_assist.vary(
        actions=blank.context.scene.mocap_assist.vary.actions, n_variants=2
    ) == {"FINISHED"}
    made = armature.animation_data.action
    assert made.name.startswith(f"{listed[0]}.{armature.name}.variant 01")


def test_matches_are_retargeted_to_another_rig(
    find, newcomer, use, make_armature, blank, poses, bring, clip_files, at_once
):
    newcomer("wave")
    listed = [row.name for row in find()]
    hero = make_armature(name="Hero")
    blank.context.view_layer.objects.active = hero
    blank.context.scene.mocap_assist.load.part = "WHOLE"

    first = use(n_best=1)[0]

    assert first.name == f"{listed[0]}.Hero"
    hero.animation_data_create().action = first
    hero.animation_data.action_slot = first.slots[0]
    frames = np.arange(1, 70, 3)
    recorded = bring(clip_files / f"{listed[0]}.bvh")
    for bone in ("RightForeArm", "LeftForeArm"):
        found = poses(hero, frames)[bone][:, :3, 1]
        expected = poses(recorded, frames)[bone][:, :3, 1]
        assert (found * expected).sum(axis=-1).min() > 0.97, bone


def test_clip_without_its_file_is_skipped_and_reported(
    find, newcomer, use, clip_files, at_once, capfd
):
    newcomer("walk")
    listed = [row.name for row in find()]
    (clip_files / f"{listed[0]}.bvh").unlink()

    examples = use(n_best=3)

    assert len(examples) == 2
    message = capfd.readouterr().out
    assert (
        "1 could not be loaded" in message
        and f"{listed[0]}.bvh was moved or deleted" in message
    )


def test_vary_raises_and_writes_nothing_when_all_files_are_missing(
    find, newcomer, blank, clip_files, at_once
):
    newcomer("walk")
    find()
    for path in clip_files.iterdir():
        path.unlink()
    before = set(blank.data.actions)

    with pytest.raises(RuntimeError, match="was moved or deleted"):
        blank.ops.mocap_assist.use_matches()

    assert set(blank.data.actions) == before


def test_button_is_disabled_without_matches(blank, newcomer):
    newcomer("walk")
    assert not blank.ops.mocap_assist.use_matches.poll()
