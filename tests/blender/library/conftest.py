"""Clips, a library of them, and .blend files that hold some."""

import shutil
import time
from pathlib import Path

import numpy as np
import pytest

KINDS = ("walk", "wave", "squat")


@pytest.fixture(scope="session")
def clip_motions(load):
    """Motions of three kinds of one figure, 2.5 s at 30 Hz: `clip_motions("walk", seed)`."""
    samples = load("solvers.samples")
    rotations = load("solvers.rotations.representations")

    def make(kind, seed=0, seconds=2.5):
        rng = np.random.default_rng(seed)
        speed = rng.uniform(0.9, 1.1)
        gait = samples.GaitSettings(
            duration=seconds, frame_rate=30.0, cadence=100.0 * speed, speed=1.2 * speed
        )
        walk = samples.walking_gait(gait)
        if kind == "walk":
            return walk
        shape = (walk.n_frames, len(walk.skeleton.names), 3)
        sway = np.cumsum(rng.normal(scale=0.01, size=shape), axis=0)
        still = rotations.quaternion_from_rotation_vector(sway)
        root_positions = np.tile(walk.root_positions[0], (walk.n_frames, 1))
        time = np.arange(walk.n_frames) / 30.0
        swing = np.sin(2.0 * np.pi * 0.8 * speed * time + rng.uniform(0, 1))
        names = walk.skeleton.names
        swings = WAVE if kind == "wave" else SQUAT
        for joint, (axis, middle, reach) in swings.items():
            angles = middle + reach * swing
            still[:, names.index(joint)] = rotations.quaternion_from_rotation_vector(
                angles[:, None] * np.array(axis)
            )
        if kind == "squat":
            root_positions[:, 2] -= 0.15 * (1.0 + swing)
        return walk.with_poses(still, root_positions)

    return make


WAVE = {"RightArm": ((0, 1, 0), 1.2, 0.3), "RightForeArm": ((0, 1, 0), 0.6, 0.6)}
SQUAT = {
    "LeftUpLeg": ((1, 0, 0), -0.5, -0.5),
    "RightUpLeg": ((1, 0, 0), -0.5, -0.5),
    "LeftLeg": ((1, 0, 0), 1.0, 1.0),
    "RightLeg": ((1, 0, 0), 1.0, 1.0),
}


@pytest.fixture(scope="session")
def written_clips(clip_motions, load, tmp_path_factory):
    """The recordings that tests get copies of."""
    folder = tmp_path_factory.mktemp("clips")
    write_bvh = load("solvers.recordings").write_bvh
    for kind in KINDS:
        for seed in (0, 1):
            write_bvh(clip_motions(kind, seed), folder / f"{kind}_{seed}.bvh")
    return folder


@pytest.fixture
def clip_files(written_clips, tmp_path):
    """A folder of six recordings: walk_0.bvh, walk_1.bvh, wave_0.bvh ..."""
    return Path(shutil.copytree(written_clips, tmp_path / "clips"))


@pytest.fixture
def bring(blank):
    """Import recordings, each as an armature whose action has the file's name."""

    def press(*paths):
        for path in paths:
            status = blank.ops.mocap_assist.import_recording(filepath=str(path))
            assert status == {"FINISHED"}
        return blank.context.object

    return press


@pytest.fixture
def blend_file(blank, bring, clip_files, tmp_path):
    """A .blend with the actions walk_0, wave_0 and squat_0; wave_0 is an asset."""
    blank.context.scene.render.fps = 30
    bring(*(clip_files / f"{kind}_0.bvh" for kind in KINDS))
    asset = blank.data.actions["wave_0"]
    asset.asset_mark()
    asset.asset_data.tags.new("greeting")
    folder = tmp_path / "shots"
    folder.mkdir()
    number = "11111111-2222-3333-4444-555555555555"
    (folder / "blender_assets.cats.txt").write_text(
        f"# ours\nVERSION 1\n\n{number}:Gestures/Hello:Gestures-Hello\n"
    )
    asset.asset_data.catalog_id = number
    path = folder / "shot.blend"
    blank.ops.wm.save_as_mainfile(filepath=str(path), copy=True)
    blank.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return path


@pytest.fixture
def index(load, tmp_path):
    """Index sources into a library: `index(folder, ...)`; return what became of it."""
    indexing = load("mocap_assist.library.solve_indexing")

    def do(*sources, tags=(), assets_only=False, library=tmp_path / "clips.library", rig=""):
        found = tuple(indexing.Source(str(source), assets_only) for source in sources)
        blender = indexing.BackgroundBlender("", str(rig))
        return indexing.index_sources(
            indexing.IndexProblem(str(library), found, tuple(tags), blender)
        )

    return do


@pytest.fixture
def entries(load, tmp_path):
    """What the library holds, by name."""

    def listed(library=tmp_path / "clips.library"):
        with load("solvers.retrieval").load_clip_library(library) as opened:
            return {entry.name: entry for entry in opened.entries}

    return listed


@pytest.fixture
def find(blank, index, clip_files, tmp_path):
    """Index the six recordings and press Find Similar; return the rows of the list."""
    index(clip_files)
    blank.context.scene.mocap_assist.library.library_file = str(tmp_path / "clips.library")

    def press(**settings):
        assert blank.ops.mocap_assist.find_similar(**settings) == {"FINISHED"}
        return list(blank.context.window_manager.mocap_assist_matches.rows)

    return press


@pytest.fixture
def newcomer(bring, clip_motions, load, tmp_path, blank):
    """An armature that moves as no recording of the library does: `newcomer("wave")`."""
    blank.context.scene.render.fps = 30

    def make(kind, seed=7, **more):
        path = tmp_path / f"new_{kind}.bvh"
        load("solvers.recordings").write_bvh(clip_motions(kind, seed, **more), path)
        return bring(path)

    return make


@pytest.fixture
def permissions(load, tmp_path, monkeypatch):
    """Permissions of this test alone."""
    module = load("mocap_assist.blender.permissions")
    monkeypatch.setattr(module, "_file", lambda: tmp_path / "permissions.json")
    return module


@pytest.fixture
def library(blank, clip_files):
    """Settings of a library in this scene, whose file lies among the sources."""
    settings = blank.context.scene.mocap_assist.library
    settings.sources, settings.library_file = str(clip_files), str(clip_files / "my.clips")
    return settings


@pytest.fixture
def keep(blank):
    """Press Keep Current."""

    def press():
        assert blank.ops.mocap_assist.keep_current() == {"FINISHED"}

    return press


@pytest.fixture
def poll(load, monkeypatch):
    """Let so many looks pass, each until its end; return how often something was indexed."""
    auto_update = load("mocap_assist.library.auto_update")
    started = []
    begin = auto_update.Indexing.__init__
    monkeypatch.setattr(
        auto_update.Indexing, "__init__",
        lambda *given: started.append("Index") or begin(*given),
    )  # fmt: skip

    def poll(times):
        started.clear()
        for _ in range(times):
            auto_update.update_libraries()
            while auto_update._running:
                time.sleep(0.02)
                auto_update.update_libraries()
            for watcher in auto_update._watchers.values():
                watcher._scan.result(timeout=500)
        return len(started)

    yield poll
    auto_update.unregister()
    auto_update.register()


@pytest.fixture
def choose(blank):
    """Choose a match by the clip's name."""

    def click(name):
        listed = blank.context.window_manager.mocap_assist_matches
        listed.active = [row.name for row in listed.rows].index(name)

    return click
