"""Scene files that are damaged, lack something or want other files read are refused."""

import json
import struct

import pytest

GLB_JSON = 0x4E4F534A


@pytest.mark.parametrize(
    ("file", "sentence"),
    [
        ("vrm/example_vrm/Example.vrm", "has a skeleton but no animation"),
        ("fbx/ue4_mannequin/SK_Mannequin.FBX", "has a skeleton but no animation"),
    ],
)
def test_missing_content_is_reported(bring, recordings, file, sentence):
    armatures, message = bring(recordings / "corpus" / file)

    assert not armatures
    assert sentence in message


@pytest.mark.parametrize("content", [b"<html></html>", b"", b"\0" * 64])
@pytest.mark.parametrize("suffix", ["glb", "gltf", "fbx", "usda", "vrm"])
def test_what_is_no_such_file_is_refused_in_a_sentence(bring, tmp_path, content, suffix):
    path = tmp_path / f"take.{suffix}"
    path.write_bytes(content)

    armatures, message = bring(path)

    assert not armatures
    assert "take." in message and "Traceback" not in message


@pytest.mark.parametrize(
    ("suffix", "content", "sentence"),
    [
        ("glb", b"<!DOCTYPE html><html></html>", "is a web page"),
        ("fbx", b"version https://git-lfs.github.com/spec/v1\n", "git lfs pull"),
    ],
)
def test_what_stands_where_a_file_should_be_is_named(
    bring, tmp_path, suffix, content, sentence
):
    (tmp_path / f"take.{suffix}").write_bytes(content)

    armatures, message = bring(tmp_path / f"take.{suffix}")

    assert not armatures
    assert sentence in message


def test_a_lying_header_of_a_glb_costs_no_memory(bring, tmp_path):
    path = tmp_path / "take.glb"
    path.write_bytes(struct.pack("<IIIII", 0x46546C67, 2, 100, 0xFFFFFFFF, 0x4E4F534A))

    _, message = bring(path)

    assert "is damaged or incomplete. Export it again." in message


@pytest.mark.parametrize(
    ("source", "n_bytes"),
    [
        ("fbx/mixamo_web/Walking.fbx", 0),
        ("fbx/mixamo_web/Walking.fbx", 90_000),
        ("glb/khronos_cesiumman/CesiumMan.glb", 0),
        ("glb/khronos_cesiumman/CesiumMan.glb", 400),
        ("glb/khronos_cesiumman/CesiumMan.glb", 90_000),
    ],
)
def test_a_file_that_was_cut_off_has_to_be_exported_again(
    bring, recordings, tmp_path, source, n_bytes
):
    path = (tmp_path / "take").with_suffix(source[-4:])
    path.write_bytes((recordings / "corpus" / source).read_bytes()[:n_bytes])

    armatures, message = bring(path)

    assert not armatures
    assert "is damaged or incomplete. Export it again." in message


def test_odd_samplers_do_not_stop_a_file(bring, tmp_path):
    content = {
        "asset": {"version": "2.0"},
        "accessors": [{"count": "x", "min": 3, "max": []}, None],
        "animations": [{"samplers": [{"input": 0}, {"input": 1}, {"input": 99}, 5]}, 7],
    }
    (tmp_path / "take.gltf").write_text(json.dumps(content))

    armatures, message = bring(tmp_path / "take.gltf")

    assert not armatures
    assert "take.gltf" in message


def test_a_failure_of_an_importer_is_one_line(bring, tmp_path):
    nodes = [{"children": [1]}, {"children": [0]}]
    content = {"asset": {"version": "2.0"}, "nodes": nodes, "scenes": [{"nodes": [0]}]}
    (tmp_path / "take.gltf").write_text(json.dumps(content))

    armatures, message = bring(tmp_path / "take.gltf")

    assert not armatures
    assert "take.gltf cannot be read: Blender's importer failed with RecursionError." in message


@pytest.mark.parametrize(
    "uri", ["../secret.bin", "/dev/zero", "..%2Fsecret.bin", "//server/share/x", "gone.bin"]
)
def test_a_file_that_wants_others_read_is_refused(bring, tmp_path, uri):
    (tmp_path / "secret.bin").write_bytes(bytes(64))
    (tmp_path / "in").mkdir()
    content = {"asset": {"version": "2.0"}, "buffers": [{"uri": uri, "byteLength": 64}]}
    (tmp_path / "in" / "take.gltf").write_text(json.dumps(content))

    armatures, message = bring(tmp_path / "in" / "take.gltf")

    assert not armatures
    assert "is not a file in its folder" in message
