"""Three walks of one figure as actions of one armature, and the button Vary."""

import pytest

N_WALKS = 3


@pytest.fixture
def walker(blank, load, tmp_path):
    """An armature that plays walk_1, and the actions walk_1, walk_2 and walk_3 for it."""
    samples, recordings = load("solvers.samples"), load("solvers.recordings")
    blank.context.scene.render.fps = 30
    for seed in range(1, N_WALKS + 1):
        speed = 0.85 + 0.1 * seed
        settings = samples.GaitSettings(
            duration=1.5 / speed, frame_rate=30.0, seed=seed, cadence=100.0 * speed, speed=speed
        )
        recordings.write_bvh(samples.walking_gait(settings), tmp_path / f"walk_{seed}.bvh")
        blank.ops.mocap_assist.import_recording(filepath=str(tmp_path / f"walk_{seed}.bvh"))
    others = [
        each for each in blank.data.objects if each.animation_data.action.name != "walk_1"
    ]
    for each in others:
        blank.data.objects.remove(each)
    (armature,) = blank.data.objects
    blank.context.view_layer.objects.active = armature
    armature.select_set(True)
    return armature


@pytest.fixture
def at_once(load, monkeypatch):
    """Solve in this process, which is quicker to start than another."""
    for module in ("mocap_assist.runtime.solver_operator", "mocap_assist.variants.sheet"):
        monkeypatch.setattr(load(module), "run", lambda solve: solve())


@pytest.fixture
def vary(blank, walker, at_once):
    """Press Vary for the three walks; return the new actions."""

    def press(**settings):
        before = set(blank.data.actions)
        given = {"actions": "walk_1; walk_2; walk_3", "n_variants": 4} | settings
        assert blank.ops.mocap_assist.vary(**given) == {"FINISHED"}
        return [action for action in blank.data.actions if action not in before]

    return press
