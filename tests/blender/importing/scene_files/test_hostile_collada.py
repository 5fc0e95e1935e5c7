"""Collada of strangers names no other file, however the name is hidden."""

from pathlib import Path

import pytest


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be"])
@pytest.mark.parametrize(
    "named",
    [
        "<image><init_from>\n{}</init_from></image>",
        "<!-- </library_images> --><image><!-- </image> --><init_from>{}</init_from></image>",
        "<image><init_from><![CDATA[{}]]></init_from></image>",
        "<image><init_from><ref>{}</ref></init_from></image>",
        '<instance_geometry url="{}#a"/>',
        '<input source="file://{}#a"/>',
        '<instance_material target="{}#a"/>',
        "<skeleton>{}#a</skeleton>",
    ],
)
def test_collada_names_no_other_file(load, tmp_path, named, encoding):
    """The importer waited forever where one of them was a pipe."""
    kept = '<channel target="a/b.X"/><input source="#é"/><init_from>id</init_from>'
    text = f'<?xml version="1.0"?>\n<a>{kept}<l>{named.format("/tmp/pipe")}</l>&lt;</a>'
    path = tmp_path / "take.dae"
    path.write_bytes(text.encode(encoding))

    with load("mocap_assist.blender.picture_paths").without_pictures(str(path)) as opened:
        read = Path(opened).read_text(encoding="utf-8")

    empty = kept.replace('"/>', '"></{}>').format("channel", "input")
    assert read.startswith(f"<a>{empty}<l>") and read.endswith("</l>&lt;</a>")
    assert "pipe" not in read


@pytest.mark.parametrize("content", [b"", b"<COLLADA><a>", b"\0\0\0", b"<a>\xff</a>"])
def test_damaged_collada_is_refused(load, tmp_path, content):
    (tmp_path / "take.dae").write_bytes(content)
    reader = load("mocap_assist.blender.picture_paths")

    with (
        pytest.raises(
            load("solvers.errors").InvalidFileError, match="is damaged or incomplete"
        ),
        reader.without_pictures(str(tmp_path / "take.dae")),
    ):
        pass


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_collada_with_a_document_type_is_refused(load, bring, tmp_path, encoding):
    text = '<?xml version="1.0"?><!DOCTYPE COLLADA [<!ENTITY a "b">]><COLLADA>&a;</COLLADA>'
    (tmp_path / "take.dae").write_text(text, encoding=encoding)
    reader = load("mocap_assist.blender.picture_paths")
    invalid = load("solvers.errors").InvalidFileError

    with (
        pytest.raises(invalid, match="has a document type"),
        reader.without_pictures(str(tmp_path / "take.dae")),
    ):
        pass
