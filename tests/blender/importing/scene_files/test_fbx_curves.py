"""FBX files whose curves Blender 4.5 drops are found, if another importer reads them."""

import pytest


@pytest.mark.parametrize(
    ("axes", "is_text", "is_missing"),
    [("Z", False, True), ("XYZ", False, False), ("Z", True, True), ("XYZ", True, False)],
)
def test_lost_curves_are_read_by_the_other_importer_or_reported(
    load, tmp_path, monkeypatch, axes, is_text, is_missing
):
    module = load("mocap_assist.blender.fbx_curves")
    monkeypatch.setattr(module, "FIRST_COMPLETE", (99, 0, 0))
    path = tmp_path / "take.fbx"
    path.write_bytes(b"Connections" + b"".join(link(axis, is_text) for axis in axes))

    assert module.loses_curves(str(path)) is (is_missing and not is_text)
    assert ("this FBX file is text" in module.describe_missing_curves(str(path))) is (
        is_missing and is_text
    )


def link(axis, is_text):
    """Return the connection of a curve to its channel, as FBX stores it."""
    if is_text:
        return f'C: "OP",11,7, "d|{axis}"\n'.encode()
    numbers = [b"L" + number.to_bytes(8, "little") for number in (11, 7)]
    return b"".join([b"S\x02\0\0\0OP", *numbers, b"S\x03\0\0\0d|", axis.encode()])
