"""Reconstruct with files of your own: postures, and how your sensor errs."""

import json
from dataclasses import replace

import numpy as np
import pytest

HISTORY = "mocap_assist_history"


@pytest.fixture
def postures_file(load, tmp_path):
    samples, reconstruction = load("solvers.samples"), load("solvers.reconstruction")
    clip = samples.walking_gait(samples.GaitSettings(duration=2.0, frame_rate=30.0))
    path = tmp_path / "postures.npz"
    reconstruction.build_posture_library([clip], trained_on="Anna's walk").save(path)
    return path


@pytest.fixture
def residuals_file(load, tmp_path):
    shipped = load("solvers.reconstruction.reconstruct").shipped_residual_prior()
    path = tmp_path / "sensor.npz"
    replace(shipped, source="my own sensor").save(path)
    return path


@pytest.fixture
def refused(blank):
    """Press Reconstruct and return the sentence; check that no action was added."""

    def press(**settings):
        actions = set(blank.data.actions)
        with pytest.raises(RuntimeError) as error:
            blank.ops.mocap_assist.reconstruct(**settings)
        assert set(blank.data.actions) == actions
        return str(error.value)

    return press


def entry_of(action):
    return json.loads(action[HISTORY])[-1]


def test_posture_file_replaces_the_shipped_library(walk, reconstruct, postures_file):
    entry = entry_of(reconstruct(postures="LEARNED", postures_file=str(postures_file)))

    assert "Anna's walk" in entry["method"] and "CMU" not in entry["method"]
    assert entry["settings"]["postures_file"] == str(postures_file)


def test_residual_file_corrects_the_sensor_errors(walk, reconstruct, residuals_file):
    default = reconstruct()
    own = reconstruct(residuals_file=str(residuals_file))

    assert "my own sensor" not in entry_of(default)["method"]
    assert "my own sensor" in entry_of(own)["method"]
    first, second = (
        np.array([
            key.co.y
            for curve in action.layers[0].strips[0].channelbags[0].fcurves
            if "KneeRight" in curve.data_path and "mocap" not in curve.data_path
            for key in curve.keyframe_points
        ])
        for action in (default, own)
    )
    assert np.abs(first - second).max() > 1e-3


def test_updated_posture_file_is_read_again(walk, reconstruct, postures_file, load):
    reconstruction = load("solvers.reconstruction")
    choice = {"postures": "LEARNED", "postures_file": str(postures_file)}
    reconstruct(**choice)
    library = reconstruction.load_posture_library(postures_file)
    replace(library, trained_on="Bob's walk").save(postures_file)

    assert "Bob's walk" in entry_of(reconstruct(**choice))["method"]


@pytest.mark.parametrize("setting", ["postures_file", "residuals_file"])
def test_a_damaged_model_file_gives_one_message(
    walk, refused, setting, postures_file, residuals_file, tmp_path
):
    other = {"postures_file": residuals_file, "residuals_file": postures_file}[setting]
    (tmp_path / "text.npz").write_text("No postures.")
    postures = {"postures": "LEARNED"} if setting == "postures_file" else {}

    for path, sentence in (
        (tmp_path / "gone.npz", "There is no file"),
        (tmp_path / "text.npz", "is not a readable archive"),
        (other, "holds "),
    ):
        message = refused(**postures, **{setting: str(path)})
        assert sentence in message and path.name in message
        assert message.strip().count("\n") == 0


def test_missing_posture_file_is_reported(walk, refused):
    assert "Choose a pose file" in refused(postures="LEARNED")


def test_panel_has_fields_for_both_files(blank, draw, actor):
    settings = blank.context.scene.mocap_assist.reconstruct
    shown = draw("MOCAP_PT_reconstruct")
    assert "residuals_file" in shown and "postures_file" not in shown

    settings.postures = "LEARNED"

    assert "postures_file" in draw("MOCAP_PT_reconstruct")
