"""Vary: many new actions of a few."""

import json

import numpy as np
import pytest

EXAMPLES = ["walk_1", "walk_2", "walk_3"]


@pytest.fixture
def body(blank, walker, load):
    """The motion of an action as read back, and its joint positions."""
    read = load("mocap_assist.actions.armature_read").read_take
    kinematics = load("solvers.motion").forward_kinematics

    def of(action):
        take = read(walker, blank.context.scene, source=(action, action.slots[0]))
        return take.parts[0].motion, kinematics(take.parts[0].motion).positions

    return of


def test_variants_differ_in_space_and_time(vary, walker, blank, body, keys_of):
    before = {name: keys_of(blank.data.actions[name]) for name in EXAMPLES}

    made = vary(timing=2.0, n_variants=6)

    assert [each.name for each in made] == [f"walk_1.variant 0{n}" for n in range(1, 7)]
    assert {name: keys_of(blank.data.actions[name]) for name in EXAMPLES} == before
    found = [body(action) for action in [*map(blank.data.actions.get, EXAMPLES), *made]]
    for one in range(len(found)):
        for other in range(max(one + 1, len(EXAMPLES)), len(found)):
            n_frames = min(found[one][0].n_frames, found[other][0].n_frames)
            displacements = found[one][1][:n_frames] - found[other][1][:n_frames]
            assert np.linalg.norm(displacements, axis=-1).max() > 0.03, (one, other)
    lengths = [motion.n_frames for motion, _ in found[len(EXAMPLES) :]]
    assert len(set(lengths)) > 1 and all(30 < length < 65 for length in lengths)
    assert walker.animation_data.action == made[0] and made[0].use_fake_user
    assert json.loads(made[4]["mocap_assist_variant"]) == {
        "examples": EXAMPLES, "number": 5, "seed": 0
    }  # fmt: skip


def test_variants_repeat_for_the_same_seed_only(vary, keys_of):
    def keys(**settings):
        return [list(keys_of(action).values()) for action in vary(n_variants=2, **settings)]

    first = keys(seed=5)
    assert keys(seed=5) == first
    assert keys(seed=6) != first


def test_planted_feet_do_not_slide(vary, body, load):
    planted, free = (vary(n_variants=2, plant_feet=on) for on in (True, False))

    plant = load("solvers.denoising").plant_feet

    def slides(actions):
        return [plant(body(action)[0]).slide_before for action in actions]

    assert max(slides(planted)) < 0.02
    assert sum(slides(planted)) < 0.5 * sum(slides(free))


def test_variants_start_where_the_example_starts(vary, walker, blank, poses, load):
    """Of amount 0 the variant is the example, as Blender itself plays it."""
    walker.location, walker.rotation_mode = (3.0, 1.0, 0.5), "XYZ"
    walker.rotation_euler, walker.scale = (0.0, 0.0, 2.0), (0.5, 0.5, 0.5)
    slot = blank.data.actions["walk_1"].slots[0]
    walker.animation_data.action = blank.data.actions["walk_1"]
    walker.animation_data.action_slot = slot
    frames = [1, 10, 30, 45]
    expected = poses(walker, frames)

    vary(amount=0.0, timing=0.0, base=1, n_variants=1, plant_feet=False)

    found = poses(walker, frames)
    for bone, matrices in expected.items():
        np.testing.assert_allclose(found[bone], matrices, atol=0.01, err_msg=bone)


def test_identical_variants_are_reported(vary, capfd):
    vary(n_variants=2, amount=0.0, timing=0.0, plant_feet=False)

    assert "Variants are nearly identical" in capfd.readouterr().out


def test_channels_outside_the_body_are_constant(vary, walker, blank):
    action = blank.data.actions["walk_1"]
    walker["shown"] = 3.0
    bag = action.layers[0].strips[0].channelbags[0]
    curve = bag.fcurves.new('["shown"]')
    curve.keyframe_points.insert(1, 7.0)
    curve.keyframe_points.insert(40, 9.0)

    (made,) = vary(n_variants=1)

    held = made.layers[0].strips[0].channelbags[0].fcurves.find('["shown"]')
    assert [tuple(key.co) for key in held.keyframe_points] == [(1.0, 7.0)]


def test_second_press_varies_the_examples_and_continues_the_numbers(vary, walker, blank):
    vary(n_variants=2)
    assert blank.ops.mocap_assist.vary(n_variants=2) == {"FINISHED"}

    played = walker.animation_data.action
    assert played.name == "walk_1.variant 03"
    assert json.loads(played["mocap_assist_variant"])["examples"] == EXAMPLES


def test_variant_can_be_cleaned(vary, walker, blank, body):
    (made,) = vary(n_variants=1)

    assert blank.ops.mocap_assist.denoise(plant_feet=False) == {"FINISHED"}

    cleaned = walker.animation_data.action
    assert cleaned.name == "walk_1.variant 01.clean"
    assert np.abs(body(cleaned)[1] - body(made)[1]).max() < 0.05


def test_invalid_choices_are_reported_in_one_sentence(walker, blank):
    with pytest.raises(RuntimeError, match="no action kick with keys for the bones"):
        blank.ops.mocap_assist.vary(actions="kick")
    blank.data.actions["walk_2"].layers[0].strips[0].channelbags[0].fcurves.clear()
    with pytest.raises(RuntimeError, match="no action walk_2 with keys"):
        blank.ops.mocap_assist.vary(actions="walk_1; walk_2")
    assert len(blank.data.actions) == len(EXAMPLES)


def test_take_with_gaps_is_named_before_the_solve(blank, load, monkeypatch):
    monkeypatch.setattr(load("mocap_assist.jobs.job"), "Job", None)
    blank.ops.mocap_assist.load_sample()

    with pytest.raises(RuntimeError, match=r"Sample Walk has gaps\. Press Clean first\."):
        blank.ops.mocap_assist.vary()


def test_vary_command_writes_variants_and_a_contact_sheet(
    walker, load, blank, capsys, tmp_path
):
    target, sheet = tmp_path / "crowd.blend", tmp_path / "sheet.png"
    run = load("mocap_assist.batch.command").run
    words = ["vary", "--actions", "; ".join(EXAMPLES), "--n-variants", "3", "--seed", "2"]

    status = run([*words, "--output", str(target), "--sheet", str(sheet), "--json"])

    out, err = capsys.readouterr()
    assert (status, err) == (0, "")
    result = json.loads(next(line for line in out.splitlines() if line[:1] == "{"))
    assert result["actions"] == [f"walk_1.variant 0{n}" for n in (1, 2, 3)]
    image = blank.data.images.load(str(sheet))
    assert image.size[1] > 3 * 100
    blank.ops.wm.open_mainfile(filepath=str(target))
    rows = blank.context.scene.mocap_assist.variants.rows
    assert [row.action.name for row in rows] == result["actions"]
