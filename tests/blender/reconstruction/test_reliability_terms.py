"""The three reliability terms: stored with the action, shown one by one."""

import numpy as np
import pytest
from kinect_walks import OCCLUDED_FRAMES

INSIDE = OCCLUDED_FRAMES.start + 15
TERMS = {"COMBINED", "BEHAVIOR", "KINEMATICS", "TRACKING"}


@pytest.fixture
def curves(load):
    return load("mocap_assist.actions.reliability_curves")


@pytest.fixture
def colors(load):
    return load("mocap_assist.overlays.confidence_colors")


@pytest.fixture
def switch(blank):
    """The switch of the colors, on."""
    manager = blank.context.window_manager
    manager.mocap_assist_confidence = True
    yield manager
    manager.mocap_assist_confidence, manager.mocap_assist_confidence_term = False, "COMBINED"


def names(terms):
    return {term.name for term in terms}


def test_each_term_is_low_for_the_hidden_hand(walk, reconstruct, curves):
    source = (reconstruct(), walk.animation_data.action_slot)

    def reliability(term, frame):
        bone = ["WristLeft"]
        return curves.reliability_at(source, bone, frame, curves.Term[term])["WristLeft"]

    assert reliability("TRACKING", INSIDE) == pytest.approx(0.5)
    assert reliability("TRACKING", 10) == 1.0
    inside = range(OCCLUDED_FRAMES.start + 3, OCCLUDED_FRAMES.stop - 3)
    assert np.mean([reliability("BEHAVIOR", frame) for frame in inside]) < 0.7
    assert np.mean([reliability("KINEMATICS", frame) for frame in inside]) < 0.8
    assert (
        np.mean([
            reliability("KINEMATICS", frame) for frame in range(1, OCCLUDED_FRAMES.start - 3)
        ])
        > 0.85
    )


def test_colors_follow_the_chosen_term(walk, reconstruct, colors, curves):
    reconstruct()
    wrist = [bone.name for bone in walk.pose.bones].index("WristLeft")

    shown = {
        term: colors.colored_bones_at(walk, INSIDE, curves.Term[term]).colors[wrist, 0]
        for term in TERMS
    }

    assert np.allclose(shown["TRACKING"], colors.color_from_reliability(0.5), atol=1e-6)
    assert not np.allclose(shown["COMBINED"], shown["TRACKING"], atol=0.05)
    assert names(colors.available_terms(walk)) == TERMS


def test_length_term_needs_the_source_file(walk, walk_file, reconstruct, colors, curves):
    walk_file.unlink()

    reconstruct()

    assert names(colors.available_terms(walk)) == TERMS - {"KINEMATICS"}
    assert colors.colored_bones_at(walk, INSIDE, curves.Term.KINEMATICS) is None


def test_panel_shows_terms_and_missing_ones(walk, walk_file, reconstruct, draw, switch):
    assert "No confidence data in this action." in " ".join(draw("MOCAP_PT_reconstruct"))
    reconstruct()
    shown = draw("MOCAP_PT_reconstruct")
    assert set(shown) >= TERMS
    assert "Lengths:" not in " ".join(shown)

    walk_file.unlink()
    reconstruct()

    assert "Lengths: needs the imported file" in " ".join(draw("MOCAP_PT_reconstruct"))


def test_panel_reports_a_sensor_without_states(make_armature, animate, reconstruct, draw,
                                                switch, blank):  # fmt: skip
    animate(make_armature())
    blank.context.scene.render.fps = 30

    reconstruct()

    assert "Sensor: the recording" in " ".join(draw("MOCAP_PT_reconstruct"))


def test_results_of_earlier_versions_are_reported(walk, reconstruct, draw, switch, curves):
    bag = reconstruct().layers[0].strips[0].channelbags[0]
    for curve in list(bag.fcurves):
        if "mocap_reliability_" in curve.data_path:
            bag.fcurves.remove(curve)

    assert "earlier version" in " ".join(draw("MOCAP_PT_reconstruct"))
