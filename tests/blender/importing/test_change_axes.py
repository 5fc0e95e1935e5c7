"""Axes, unit and scale are set on import, and changed again on what was imported."""

from math import pi
from types import SimpleNamespace

import numpy as np
import pytest
from mathutils import Matrix, Vector
from numpy.testing import assert_allclose

TOLERANCE_M = 2e-4  # meters; bones and keys are 32-bit numbers
FRAMES = (1, 20, 40)


@pytest.fixture
def walk(recordings):
    return recordings / "mocap" / "cmu_walk" / "07_01.bvh"


@pytest.fixture
def shown(blank):
    """World positions of all bones, or of all markers, in a few frames."""

    def read(owner):
        positions = []
        for frame in FRAMES:
            blank.context.scene.frame_set(frame)
            world = owner.matrix_world
            if owner.type == "ARMATURE":
                positions.append([world @ bone.head for bone in owner.pose.bones])
            else:
                positions.append([child.matrix_world.translation for child in owner.children])
        return np.array(positions)

    return read


def change(blank, **settings):
    assert blank.ops.mocap_assist.change_axes(**settings) == {"FINISHED"}


@pytest.mark.parametrize(
    "axes",
    [{"up": "Z"}, {"up": "MINUS_Y"}, {"forward": "X"}, {"up": "X", "forward": "MINUS_Y"}],
)
def test_a_change_shows_what_an_import_with_it_would(walk, bring, shown, blank, axes):
    expected = shown(bring(walk, **axes))
    armature = bring(walk)
    action = armature.animation_data.action

    change(blank, **axes)

    assert_allclose(shown(armature), expected, atol=TOLERANCE_M)
    assert armature.animation_data.action == action


def test_back_and_forth_leaves_it_as_it_was(walk, bring, shown, blank):
    armature = bring(walk)
    armature.location = (3.0, 1.0, 0.0)
    before = shown(armature)

    change(blank, up="Z", global_scale=2.0)
    rotated = shown(armature)
    change(blank, up="Y", global_scale=1.0)

    assert np.abs(rotated - before).max() > 0.5
    assert_allclose(shown(armature), before, atol=TOLERANCE_M)


def test_view_follows_the_actor(load, blank):
    """A rotated take had left the view, which then showed nothing."""
    shows = load("mocap_assist.importing.show_actor")
    region = SimpleNamespace(
        view_location=Vector((0.0, 0.0, 1.0)), view_distance=4.0, view_perspective="PERSP"
    )
    spaces = SimpleNamespace(active=SimpleNamespace(region_3d=region))
    screen = SimpleNamespace(areas=[SimpleNamespace(type="VIEW_3D", spaces=spaces)])
    context = SimpleNamespace(window=SimpleNamespace(screen=screen))
    positions = shows.positions_of_views(context)
    change = Matrix.Rotation(-pi / 2, 4, "X") @ Matrix.Scale(2.0, 4)

    for _ in range(2):  # the redo panel changes it again
        shows.follow_actor(context, positions, change)

    assert_allclose(region.view_location, (0.0, 2.0, 0.0), atol=1e-6)
    assert region.view_distance == pytest.approx(8.0)


def test_scale_and_unit_change_the_size(walk, bring, shown, blank):
    armature = bring(walk)
    before = shown(armature)

    change(blank, global_scale=2.0)
    assert_allclose(shown(armature), 2.0 * before, rtol=1e-4, atol=TOLERANCE_M)

    change(blank, unit="METRES")
    assert np.ptp(shown(armature)[..., 2]) > 10.0 * np.ptp(before[..., 2])


def test_panel_and_message_report_the_estimated_axes(walk, bring, load, capfd):
    armature = bring(walk)

    origin = load("mocap_assist.scene.origin")
    noted = origin.noted_conventions(origin.origin_of(armature))
    sentence = "Y is up, Z is forward, lengths are in units of 0.05644 m"
    assert noted.sentence() == sentence
    assert f"{sentence}." in capfd.readouterr().out


def test_a_take_without_a_floor_stays_on_it(recordings, bring, shown, blank):
    """The hips of this dancer are the origin."""
    dancer = bring(recordings / "corpus/bvh/olympe_ballet/ballet.bvh")
    assert shown(dancer)[..., 2].min() == pytest.approx(0.0, abs=0.1)

    change(blank, up="Z")
    assert np.ptp(shown(dancer)[..., 2]) < 1.0
    change(blank, up="Y")
    assert shown(dancer)[..., 2].min() == pytest.approx(0.0, abs=0.1)


def test_markers_are_turned_too(recordings, bring, shown, blank):
    path = recordings / "formats/trc/walk_free_01.trc"
    expected = shown(bring(path, up="Z"))
    holder = bring(path)
    if holder.parent:
        holder = holder.parent

    change(blank, up="Z")

    assert_allclose(shown(holder), expected, atol=TOLERANCE_M)


def test_equal_axes_are_refused(walk, bring, blank):
    bring(walk)
    with pytest.raises(RuntimeError, match="Up is Y and Forward is -Y; they must be different"):
        blank.ops.mocap_assist.change_axes(up="Y", forward="MINUS_Y")


def test_an_animated_armature_is_not_turned(walk, bring, blank):
    armature = bring(walk)
    armature.keyframe_insert("location", frame=1)
    with pytest.raises(RuntimeError, match="is itself animated"):
        blank.ops.mocap_assist.change_axes(up="Z")


def test_the_button_is_gray_without_an_import(blank):
    with pytest.raises(RuntimeError, match="Select an armature or markers"):
        blank.ops.mocap_assist.change_axes(up="Z")


def test_a_unit_counts_for_files_of_other_programs(recordings, bring, shown, blank):
    """The file says centimeters; the user knows better."""
    path = recordings / "corpus/fbx/mixamo_web/Idle.fbx"
    before = np.ptp(shown(bring(path))[..., 2])

    assert np.ptp(shown(bring(path, unit="CENTIMETRES"))[..., 2]) == pytest.approx(before)
    larger = np.ptp(shown(bring(path, unit="INCHES"))[..., 2])
    assert larger == pytest.approx(2.54 * before, rel=1e-3)
    lying = shown(bring(path, up="Z"))
    assert np.ptp(lying[..., 2]) < 0.5 * before


def test_only_what_fits_is_shown(recordings, load):
    kinds = load("mocap_assist.importing.dialog.file_kinds")
    names = ("target", "unit", "height", "up", "rotate_mode", "held")

    def of(*paths):
        return kinds.fitting(names, kinds.kinds_of(recordings / path for path in paths).split())

    walk = "mocap/cmu_walk/07_01.bvh"
    assert of(walk) == ["unit", "up", "rotate_mode"]
    assert of("formats/trc/walk_free_01.trc") == ["unit", "up"]
    assert of("corpus/fbx/mixamo_web/Idle.fbx") == ["unit", "up", "rotate_mode"]
    assert of("corpus/fbx/mixamo_web/Idle.fbx", walk) == ["unit", "up", "rotate_mode"]
    assert kinds.fitting(names, []) == list(names)
