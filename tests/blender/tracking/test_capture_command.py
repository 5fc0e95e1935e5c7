"""`blender --command mocap_assist capture`: from depth to a .blend with an armature."""

import json

import numpy as np

QUICK = ["--no-backward", "--no-refine", "--no-plant-feet"]


def test_takes_become_armatures_and_what_fails_is_named(truth, blank, load, tmp_path, capsys):
    run = load("mocap_assist.batch.command").run
    good, wrong, target = (tmp_path / name for name in ("walk.npz", "no.npz", "out.blend"))
    np.savez_compressed(good, **truth)
    wrong.write_bytes(b"nothing")
    words = ["capture", str(good), str(wrong), "--output", str(target), *QUICK]

    status = run([*words, "--json", str(tmp_path / "told.json")])

    told = json.loads((tmp_path / "told.json").read_text())
    said = capsys.readouterr()
    assert status == 2 and "no.npz" in said.err
    assert told["objects"] == ["walk tracked"] and len(told["failed"]) == 1
    blank.ops.wm.open_mainfile(filepath=str(target))
    armature = blank.data.objects["walk tracked"]
    assert armature.animation_data.action is not None
