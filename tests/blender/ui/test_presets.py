"""Presets in panel headers: shipped ones, and the animator's own in Blender's folder."""

from pathlib import Path

import pytest

GROUPS = {
    "clean": "denoise", "reconstruct": "reconstruct", "retarget": "retarget",
    "simulate": "simulate", "vary": "vary",
}  # fmt: skip


@pytest.mark.parametrize("group", GROUPS)
def test_preset_sets_its_settings_and_resets_those_of_others(blank, load, group):
    presets = load("solvers.presets").PRESETS[GROUPS[group]]
    shown = getattr(blank.context.scene.mocap_assist, group)
    before = shown.settings()

    for name, preset in presets.items():
        assert blank.ops.mocap_assist.use_preset(group=group, preset=name) == {"FINISHED"}
        found = {}
        for each in shown.settings():
            found |= vars(each)
        assert {key: getattr(found[key], "value", found[key]) for key in preset.values} == (
            pytest.approx(preset.values)
        )

    blank.ops.mocap_assist.use_preset(group=group, preset="Normal")
    assert shown.settings() == before


def test_own_preset_is_stored_where_blender_stores_presets(blank):
    clean, ops = blank.context.scene.mocap_assist.clean, blank.ops
    clean.strength, clean.joint_limits, clean.examples = 0.25, "CONSTRAINTS", "run"
    kind = blank.types.MOCAP_PT_clean_presets

    assert ops.mocap_assist.clean_preset_add(name="Mine") == {"FINISHED"}

    folder = Path(blank.utils.user_resource("SCRIPTS", path="presets/mocap_assist/clean"))
    assert "examples" not in (folder / "Mine.py").read_text(encoding="utf-8")
    ops.mocap_assist.use_preset(group="clean", preset="Normal")
    clean.joint_limits, clean.examples = "NONE", "jump"
    ops.script.execute_preset(filepath=str(folder / "Mine.py"), menu_idname=kind.__name__)
    assert (clean.strength, clean.joint_limits, clean.examples) == (0.25, "CONSTRAINTS", "jump")
    assert ops.mocap_assist.clean_preset_add(name="Mine", remove_name=True) == {"FINISHED"}
    assert not list(folder.glob("*.py"))
