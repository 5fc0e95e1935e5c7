"""Recordings of depth become points that play with the timeline, and survive save and load."""

import numpy as np
import pytest
from depth_files import depth_npz
from depth_folders import open3d, save_png
from depth_views import points_of

TOLERANCE_M = 1e-4  # meters: 32-bit numbers


def expected(depth: np.ndarray, focal: float = 90.0) -> np.ndarray:
    """Points in the world of a level camera at the origin that looks along +Y."""
    rows, columns = np.mgrid[:60, :80]
    z = depth * 0.001
    x, y = (columns - 39.5) / focal * z, (rows - 29.5) / focal * z
    return np.stack([x, z, -y], axis=-1).reshape(-1, 3)


@pytest.mark.parametrize("picture", [0, 3, 7])
def test_points_are_where_the_pixels_saw_them(archive, depth, bring, blank, picture):
    made = bring(archive, frame_rate="ONE", frame_start=5)

    blank.context.scene.frame_set(5 + picture)

    np.testing.assert_allclose(
        points_of(made),
        expected(depth[picture])[depth[picture].ravel() > 0],
        atol=TOLERANCE_M,
    )


def test_only_observed_points_are_drawn(archive, depth, bring, blank):
    made = bring(archive)

    evaluated = made.evaluated_get(blank.context.evaluated_depsgraph_get())

    cloud = next(
        instance.object.data
        for instance in blank.context.evaluated_depsgraph_get().object_instances
        if instance.object.type == "POINTCLOUD"
    )
    assert evaluated.name == made.name
    assert len(cloud.points) == (depth[0] > 0).sum()


def test_it_plays_in_seconds_at_the_rate_of_the_scene(archive, bring, blank):
    blank.context.scene.render.fps = 60
    made = bring(archive, frame_rate="SCALE", update_scene_duration=True)

    distances = []
    for frame in (1, 3, 4, 5, 15, 400):
        blank.context.scene.frame_set(frame)
        distances.append(round(float(points_of(made)[-1, 1]), 3))

    # Two frames of the scene to a picture; beyond the last it stays.
    assert distances == [3.0, 2.9, 2.8, 2.8, 2.3, 2.3]


def test_it_survives_save_and_load(archive, depth, bring, blank, tmp_path):
    bring(archive, frame_rate="ONE")
    blank.context.scene.frame_set(4)
    blank.ops.wm.save_as_mainfile(filepath=str(tmp_path / "saved.blend"))

    blank.ops.wm.open_mainfile(filepath=str(tmp_path / "saved.blend"))

    made = blank.data.objects["wall"]
    assert points_of(made)[-1, 1] == pytest.approx(2.7, abs=TOLERANCE_M)
    blank.context.scene.frame_set(7)
    assert points_of(made)[-1, 1] == pytest.approx(2.4, abs=TOLERANCE_M)


def test_missing_file_shows_nothing_and_the_panel_gives_a_reason(archive, bring, blank, draw):
    made = bring(archive, frame_rate="ONE")
    moved = archive.rename(archive.with_name("elsewhere.npz"))

    blank.ops.wm.save_as_mainfile(filepath=str(archive.with_suffix(".blend")))
    blank.ops.wm.open_mainfile(filepath=str(archive.with_suffix(".blend")))

    made = blank.data.objects["wall"]
    assert not len(points_of(made))
    assert any("There is no file" in line for line in draw("MOCAP_PT_import"))
    moved.rename(archive)
    blank.context.scene.frame_set(2)
    assert len(points_of(made))
    assert not any("There is no file" in line for line in draw("MOCAP_PT_import"))


def test_a_large_picture_has_no_more_points_than_are_cheap(recordings, bring, load, blank):
    path = recordings / "depth" / "truth" / "walk_front.npz"
    recording = load("solvers.recordings").read_depth(path)

    made = bring(path, frame_rate="ONE")

    assert len(made.data.vertices) == 20_000
    blank.context.scene.frame_set(20)
    seen = points_of(made)
    depth = recording.frame(19)
    assert len(seen) == (depth > 0).sum()  # No pixel is left out: they are few.
    assert seen[:, 1].min() == pytest.approx(depth[depth > 0].min(), abs=0.1)
    assert np.ptp(seen[:, 2]) == pytest.approx(1.75, abs=0.25)  # A human stands upright.


def test_observed_floor_is_at_zero(tmp_path, bring, rng):
    """A camera 1.2 m up that looks down by 20 degrees."""
    focal, tilt = 90.0, np.radians(20.0)
    rows, columns = np.mgrid[:60, :80]
    rays = np.stack([(columns - 39.5) / focal, (rows - 29.5) / focal, np.ones((60, 80))], -1)
    down = rays @ (0.0, np.cos(tilt), np.sin(tilt))
    z = np.where(down > 0.15, 1.2 / np.maximum(down, 0.15), 0.0) * 1000.0
    pictures = (z + rng.normal(size=(4, 60, 80))).round().clip(0).astype(np.uint16)
    path = tmp_path / "room.npz"
    path.write_bytes(depth_npz(pictures, fx=focal, fy=focal, cx=39.5, cy=29.5))

    made = bring(path)

    heights = points_of(made)[:, 2]
    assert np.abs(np.median(heights)) < 0.005
    assert made.matrix_world.translation.z == pytest.approx(1.2, abs=0.01)


@pytest.mark.parametrize("chosen", ["folder", "picture", "intrinsic.json", "looked at"])
def test_a_folder_is_chosen_by_itself_or_by_what_is_in_it(tmp_path, depth, blank, chosen):
    folder = open3d(tmp_path / "hall", depth)
    given = {
        "folder": {"filepath": str(folder)},
        "picture": {
            "directory": str(folder / "depth"),
            "files": [{"name": "00001.png"}, {"name": "00002.png"}],
        },
        "intrinsic.json": {"filepath": str(folder / "intrinsic.json")},
        "looked at": {"directory": str(folder), "files": [{"name": ""}]},
    }[chosen]

    assert blank.ops.mocap_assist.import_recording(**given) == {"FINISHED"}

    made = blank.context.object
    assert (made.name, len(blank.data.objects)) == ("hall", 1)
    assert len(made.data.vertices) == 60 * 80


def test_a_plain_folder_needs_unit_and_focal_length(tmp_path, depth, blank):
    for number, picture in enumerate(depth):
        save_png(tmp_path / "plain" / f"{number:03}.png", picture)
    path = str(tmp_path / "plain")

    with pytest.raises(RuntimeError, match=r"set its scale .* and the camera's focal lengths"):
        blank.ops.mocap_assist.import_recording(filepath=path)
    assert not blank.data.objects
    assert not blank.data.node_groups
    blank.ops.mocap_assist.import_recording(
        filepath=path, unit="MILLIMETRES", focal_length=90.0, mirrored=True
    )

    made = blank.context.object
    seen = points_of(made)
    mirrored = expected(depth[0])[depth[0].ravel() > 0] * (-1.0, 1.0, 1.0)
    order = np.lexsort(seen.round(3).T), np.lexsort(mirrored.round(3).T)
    np.testing.assert_allclose(seen[order[0]], mirrored[order[1]], atol=TOLERANCE_M)


def test_a_preview_that_was_copied_plays_on_and_removed_ones_are_gone(archive, bring, blank):
    made = bring(archive, frame_rate="ONE")
    twin = made.copy()
    twin.data = made.data.copy()
    blank.context.collection.objects.link(twin)

    blank.data.meshes.remove(made.data)
    blank.context.scene.frame_set(6)

    assert points_of(twin)[-1, 1] == pytest.approx(2.5, abs=TOLERANCE_M)


def test_of_a_room_only_so_many_points_are_shown_as_are_cheap(tmp_path, bring, rng):
    room = rng.integers(1000, 3000, (3, 240, 320)).astype(np.uint16)
    path = tmp_path / "room.npz"
    path.write_bytes(depth_npz(room, fx=285.0, fy=285.0, cx=159.5, cy=119.5))

    made = bring(path, global_scale=10.0)

    assert len(points_of(made)) == 120 * 160
    assert points_of(made)[:, 1].min() == pytest.approx(10.0, abs=0.05)


@pytest.mark.parametrize("result", ["nonsense", "{}", '{"path": 3, "every": null}'])
def test_an_edited_preview_is_hidden_with_a_message(archive, bring, blank, result):
    made = bring(archive)

    made.data["mocap_assist_depth"] = result
    blank.context.scene.frame_set(3)

    assert not len(points_of(made))
    assert "shows no depth recording" in made.data["mocap_assist_depth_problem"]


def test_all_four_numbers_of_the_camera_can_be_given(archive, depth, bring):
    made = bring(archive, focal_length=80.0, focal_length_y=70.0, center_x=30.0, center_y=20.0)

    rows, columns = np.mgrid[:60, :80]
    z = depth[0] * 0.001
    points = np.stack([(columns - 30.0) / 80.0 * z, z, -(rows - 20.0) / 70.0 * z], axis=-1)
    np.testing.assert_allclose(points_of(made), points[depth[0] > 0], atol=TOLERANCE_M)


def test_import_warns_of_implausible_intrinsics(archive, blank, load):
    choices = load("mocap_assist.importing.button_settings").ImportChoices(focal_length=900.0)
    result = load("mocap_assist.importing.importing").import_files(
        blank.context, [archive], choices
    )
    assert "The field of view would be 5 degrees" in result.sentence


def test_points_in_edit_mode_wait_and_let_others_play(archive, bring, blank):
    edited, other = bring(archive, frame_rate="ONE"), bring(archive, frame_rate="ONE")
    other.select_set(False)
    blank.context.view_layer.objects.active = edited
    blank.ops.object.mode_set(mode="EDIT")
    blank.context.scene.frame_set(6)
    assert points_of(other)[-1, 1] == pytest.approx(2.5, abs=TOLERANCE_M)
    blank.ops.object.mode_set(mode="OBJECT")
    blank.context.scene.frame_set(7)
    assert points_of(edited)[-1, 1] == pytest.approx(2.4, abs=TOLERANCE_M)
