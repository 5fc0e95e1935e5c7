"""Mixed rigs, nearly nothing, newer files, and two who index at once."""

import sqlite3
import subprocess
import sys
from contextlib import closing

import pytest

INDEX = """
import os, sys
import bpy
from addon_utils import enable
enable({package!r}, default_set=True)
from importlib import import_module
indexing = import_module({package!r} + ".mocap_assist.library.solve_indexing")
sources = tuple(indexing.Source(path) for path in sys.argv[2:])
blender = indexing.BackgroundBlender("")
done = indexing.index_sources(indexing.IndexProblem(sys.argv[1], sources, (), blender))
print("READ", done.n_added, flush=True)
os._exit(0)
"""


def test_index_accepts_mixed_rigs(
    blank, index, entries, find, newcomer, make_armature, animate, tmp_path, recordings
):
    animate(make_armature(name="Plain"))
    blank.ops.wm.save_as_mainfile(filepath=str(tmp_path / "plain.blend"), copy=True)
    index(
        tmp_path / "plain.blend",
        recordings / "mocap" / "05_13.amc",
        recordings / "mocap" / "cmu_walk" / "07_01.bvh",
        recordings / "kinect" / "irds" / "215_18_5_8_1_stand.txt",
    )
    assert {"plain/walk", "05_13", "07_01", "215_18_5_8_1_stand"} <= set(entries())

    newcomer("walk")
    rows = find()

    assert len(rows) == 10 and rows[0].name.startswith("walk_")


@pytest.mark.parametrize("n_frames", [1, 2])
def test_clips_of_one_to_three_frames_are_indexed(
    find, newcomer, blank, index, clip_motions, load, tmp_path, n_frames
):
    short = tmp_path / "short.bvh"
    load("solvers.recordings").write_bvh(clip_motions("squat").slice(0, n_frames), short)
    armature = newcomer("squat")
    index(short)
    find()
    listed = blank.context.window_manager.mocap_assist_matches
    listed.active = [row.name for row in listed.rows].index("short")

    assert blank.ops.mocap_assist.load_match(result_as="NLA_TRACK") == {"FINISHED"}

    strip = armature.animation_data.nla_tracks[-1].strips[0]
    assert strip.frame_end > strip.frame_start
    assert load("mocap_assist.find_similar.ghost_drawing").ghost_now(blank.context) is not None


def test_find_accepts_a_query_of_one_frame(find, newcomer, blank):
    newcomer("squat")
    scene = blank.context.scene
    scene.use_preview_range, scene.frame_preview_start, scene.frame_preview_end = True, 30, 30

    assert find(frame_range="PREVIEW")
    assert blank.ops.mocap_assist.load_match() == {"FINISHED"}


def test_every_button_refuses_a_library_of_a_newer_version(find, newcomer, blank, tmp_path):
    newcomer("walk")
    path = tmp_path / "clips.library"
    with closing(sqlite3.connect(path)) as database, database:
        database.execute("PRAGMA user_version = 99")
    database.close()
    before = path.read_bytes()
    blank.context.scene.mocap_assist.library.sources = str(tmp_path)

    for press in (blank.ops.mocap_assist.find_similar, blank.ops.mocap_assist.index_library):
        with pytest.raises(RuntimeError, match="newer version"):
            press()

    assert path.read_bytes() == before


def test_two_blenders_can_index_one_library_at_once(
    load, clip_files, blend_file, entries, tmp_path
):
    package = load("solvers").__name__.removesuffix(".solvers")
    script = tmp_path / "index.py"
    script.write_text(INDEX.format(package=package))
    others = tmp_path / "others"
    others.mkdir()
    for path in clip_files.iterdir():
        (others / f"other_{path.name}").write_bytes(path.read_bytes())
    calls = [
        [sys.executable, str(script), str(tmp_path / "clips.library"), str(source), more]
        for source, more in ((clip_files, str(blend_file)), (others, str(blend_file.parent)))
    ]

    running = [
        subprocess.Popen(each, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        for each in calls
    ]
    outputs = [each.communicate(timeout=500) for each in running]

    assert all("READ" in out for out, _ in outputs), outputs
    found = entries()
    assert {f"{kind}_{n}" for kind in ("walk", "wave", "squat") for n in (0, 1)} <= set(found)
    assert {"other_walk_0", "other_squat_1", "shot/walk_0"} <= set(found)
