"""The content of a file of another program decides where its suffix is wrong."""

import pytest

from solvers.recordings import is_scene_file, suffix_by_content


@pytest.mark.parametrize(
    ("name", "content", "suffix"),
    [
        ("take.glb", b"Kaydara FBX Binary  \0", ".fbx"),
        ("take.BVH", b"; FBX 7.7.0 project file", ".fbx"),
        ("take.fbx", b"glTF\2\0\0\0", ".glb"),
        ("take.fbx", b"\xef\xbb\xbfHIERARCHY\nROOT", ".bvh"),
        ("take.FBX", b"unclear", ".fbx"),
        ("take.vrma", b"glTF\2\0\0\0", ".vrma"),
        ("take.usda", b"#usda 1.0", ".usda"),
        ("take.trc", b"PathFileType\t4", ".trc"),
    ],
)
def test_the_first_bytes_decide_where_they_are_clear(tmp_path, name, content, suffix):
    path = tmp_path / name
    path.write_bytes(content)

    assert suffix_by_content(path) == suffix
    assert is_scene_file(path) == (suffix in {".fbx", ".glb", ".usda"})


def test_the_name_decides_for_missing_files_and_folders(tmp_path):
    (tmp_path / "folder.glb").mkdir()

    assert suffix_by_content(tmp_path / "take.FBX") == ".fbx"
    assert suffix_by_content(tmp_path / "folder.glb") == ".glb"
