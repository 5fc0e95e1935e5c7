"""FBX and GLB serve wherever recordings do: in batches, as examples, in the library."""

import json
import shutil

import pytest

TAKES = {
    "Walking": "fbx/mixamo_web/Walking.fbx",
    "Jump": "fbx/mixamo_web/Jump.fbx",
    "run": "glb/mixamo_blender/walking.glb",
}


@pytest.fixture
def takes(recordings, tmp_path):
    """A folder with files of Mixamo as FBX and GLB."""
    folder = tmp_path / "takes"
    folder.mkdir()
    for name, file in TAKES.items():
        path = recordings / "corpus" / file
        shutil.copy(path, folder / f"{name}{path.suffix}")
    return folder


def result_of(out: str) -> dict:
    return json.loads(next(line for line in out.splitlines() if line[:1] == "{"))


def test_each_imports_and_cleans_them(blank, command, takes, tmp_path):
    raw, clean = tmp_path / "raw", tmp_path / "clean"

    status, _, err = command("each", takes, "--output-folder", raw, "--report", "--", "import")

    assert (status, err) == (0, "")
    assert {path.stem for path in raw.glob("*.blend")} == set(TAKES)

    status, _, err = command("each", raw, "--output-folder", clean, "--report", "--", "denoise")

    assert (status, err) == (0, "")
    report = json.loads((clean / "report.json").read_text())
    assert (report["done"], report["failed"]) == (3, 0)


def test_clean_learns_from_an_fbx(blank, command, takes, tmp_path):
    command("import", takes / "Walking.fbx", "--output", tmp_path / "walk.blend")
    blank.ops.wm.open_mainfile(filepath=str(tmp_path / "walk.blend"))

    status, out, err = command(
        "denoise", "--output", tmp_path / "clean.blend", "--json",
        "--train", takes / "Walking.fbx", takes / "Jump.fbx",
    )  # fmt: skip

    assert (status, err) == (0, "")
    assert result_of(out)["settings"]["prior"] == "examples"


def test_the_library_lists_them(blank, command, takes, tmp_path):
    status, out, err = command("index", takes, "--library", tmp_path / "takes.clips", "--json")

    assert (status, err) == (0, "")
    result = result_of(out)
    assert (result["n_clips"], result["refused"]) == (4, [])  # the GLB has two takes
