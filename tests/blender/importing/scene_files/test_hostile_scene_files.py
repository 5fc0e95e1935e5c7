"""Files of strangers wait for no pipe, ask no server and fill no memory, on the way in."""

import os
import struct
import threading
import zlib
from pathlib import Path

import pytest

PICTURE = "picture.png"
NAMED = "pipe123.png"  # of the same length, for binary files


@pytest.fixture
def pipe(tmp_path):
    """A pipe, and a list that is not empty once someone opened it, who gets nothing."""
    os.mkfifo(tmp_path / NAMED)
    ended, opened = threading.Event(), []

    def serve():
        while not ended.wait(0.02):
            try:
                os.close(os.open(tmp_path / NAMED, os.O_WRONLY | os.O_NONBLOCK))
            except OSError:
                continue
            opened.append(True)

    server = threading.Thread(target=serve)
    server.start()
    yield opened
    ended.set()
    server.join()


@pytest.fixture
def textured(blank, make_armature, animate, tmp_path):
    """An animated armature with a mesh whose picture is a file."""
    actor = make_armature()
    animate(actor, range(1, 12))
    image = blank.data.images.new("picture", 4, 4)
    image.filepath_raw, image.file_format = str(tmp_path / PICTURE), "PNG"
    image.save()
    image = blank.data.images.load(str(tmp_path / PICTURE))
    mesh = blank.data.meshes.new("skin")
    mesh.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [], [(0, 1, 2)])
    mesh.uv_layers.new()
    material = blank.data.materials.new("skin")
    if blank.app.version < (5, 0):
        material.use_nodes = True
    mesh.materials.append(material)
    nodes = material.node_tree.nodes
    texture = nodes.new("ShaderNodeTexImage")
    texture.image = image
    material.node_tree.links.new(texture.outputs[0], nodes["Principled BSDF"].inputs[0])
    skin = blank.data.objects.new("skin", mesh)
    blank.context.scene.collection.objects.link(skin)
    skin.parent = actor
    return actor


def test_no_importer_of_fbx_opens_a_picture(textured, blank, load, bring, pipe, tmp_path):
    path = tmp_path / "take.fbx"
    blank.ops.export_scene.fbx(filepath=str(path), path_mode="ABSOLUTE")
    named = path.read_bytes().replace(PICTURE.encode(), NAMED.encode())
    assert named.count(NAMED.encode()) >= 2
    path.write_bytes(named)
    before = len(blank.data.objects)

    bring(path)

    assert not pipe
    assert len(blank.data.objects) > before


@pytest.mark.parametrize(
    ("content", "left"),
    [
        (
            b'; FBX 7.4\nTexture: { FileName: "/dev/zero"\nRelativeFilename : "a.png" }',
            b"a.png",
        ),
        (b'; FBX 7.4\nP: "Path", "KString", "", "", "/dev/zero"\nVideo: {}', b"KString"),
    ],
)
def test_text_names_no_picture(load, tmp_path, content, left):
    path = tmp_path / "take.dae"
    path.write_bytes(content)

    with load("mocap_assist.blender.picture_paths").without_pictures(str(path)) as opened:
        kept, name = Path(opened).read_bytes(), Path(opened).name

    assert opened != str(path) and name == path.name
    assert left in kept
    assert not any(name in kept for name in (b"FileName", b"RelativeF", b'"Path"'))


def test_a_file_without_pictures_is_read_where_it_is(load, tmp_path):
    (tmp_path / "take.fbx").write_bytes(b"; FBX 7.4\nModel: {}\n")
    path = str(tmp_path / "take.fbx")

    with load("mocap_assist.blender.picture_paths").without_pictures(path) as opened:
        assert opened == path


@pytest.mark.parametrize(
    "named",
    [
        f"./{NAMED}",
        "/dev/zero",
        "//127.0.0.1/share/x.usda",
        "http://127.0.0.1/x.usda",
        "`'${SHOW}/x.usda'`",
    ],
)
@pytest.mark.parametrize("way", ["sublayer", "reference", "clip", "next"])
def test_usd_reads_files_of_this_computer_only(load, tmp_path, named, way):
    os.mkfifo(tmp_path / NAMED)
    layer = f"#usda 1.0\n(subLayers = [@{named}@])\n"
    if way == "reference":
        layer = f'#usda 1.0\ndef Xform "a" (payload = @{named}@</a>) {{}}\n'
    if way == "clip":
        clips = f"dictionary one = {{ asset[] assetPaths = [@{named}@] }}"
        layer = f'#usda 1.0\ndef Xform "a" (clips = {{ {clips} }}) {{}}\n'
    if way == "next":
        (tmp_path / "next.usda").write_text(layer)
        layer = "#usda 1.0\n(subLayers = [@next.usda@, @gone.usda@])\n"
    path = tmp_path / "take.usda"
    path.write_text(layer)
    invalid = load("solvers.errors").InvalidFileError

    with pytest.raises(invalid, match=r"take\.usda refers to .* not a file on this computer"):
        load("mocap_assist.blender.usd_layers").refuse_other_sources(str(path))


def test_usd_of_several_files_is_read(load, tmp_path):
    picture = "asset picture = @//server/share/x.png@"
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "take.usda").write_text(
        "#usda 1.0\n(subLayers = [@../other.usda@, @gone.usda@, @take.usda@])\n"
        f'def Xform "a" {{ {picture} }}\n'
    )
    (tmp_path / "other.usda").write_text("#usda 1.0\n")

    path = str(tmp_path / "in" / "take.usda")
    load("mocap_assist.blender.usd_layers").refuse_other_sources(path)


FLOATS = {"componentType": 5126, "type": "VEC4"}
MILLIONS = [*({"sampler": 0} for _ in range(300))]


@pytest.mark.parametrize(
    "content",
    [
        {"accessors": [{**FLOATS, "count": 5 * 10**8}], "skins": [{"inverseBindMatrices": 0}]},
        {
            "accessors": [{**FLOATS, "count": 10**8}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        },
        {
            "accessors": [{**FLOATS, "count": 10**6, "bufferView": 0}],
            "animations": [{"samplers": [{"input": 0, "output": 0}], "channels": MILLIONS}],
        },
    ],
    ids=["matrices", "mesh", "shared"],
)
def test_numbers_that_a_gltf_file_does_not_hold_are_refused(load, content):
    sizes = load("mocap_assist.blender.gltf_sizes")
    invalid = load("solvers.errors").InvalidFileError

    with pytest.raises(invalid, match=r"take\.glb states \d+(\.\d+)? GB of numbers"):
        sizes.refuse_inflated("take.glb", content, 20 * 10**6)


def test_parts_of_a_mesh_may_share_their_vertices(load):
    """As avatars do, whose face has a part for each material and all shapes in each of them."""
    shapes = [{"POSITION": 2 * n + 2, "NORMAL": 2 * n + 3} for n in range(57)]
    part = {"attributes": {"POSITION": 0}, "indices": 1, "targets": shapes}
    vertices = {**FLOATS, "type": "VEC3", "count": 80_000}
    corners = {"componentType": 5125, "type": "SCALAR", "count": 12_000}
    content = {
        "accessors": [vertices, corners, *([vertices] * 114)],
        "meshes": [{"primitives": [part] * 20}],
    }
    sizes = load("mocap_assist.blender.gltf_sizes")

    sizes.refuse_inflated("take.glb", content, 20 * 10**6)

    del part["indices"]
    with pytest.raises(load("solvers.errors").InvalidFileError, match=r"states 2\.32 GB of"):
        sizes.refuse_inflated("take.glb", content, 20 * 10**6)


def test_odd_numbers_of_a_gltf_file_are_left_to_the_importer(load):
    odd = [{"count": "x"}, None, {**FLOATS, "count": -1}, {"count": 9, "type": []}]
    samplers = [{"input": 0, "output": 3}, 7, {"input": [], "output": 99}]
    channels = [{"sampler": each} for each in (0, 1, 2, "x", -1)]
    content = {
        "accessors": odd,
        "animations": [{"samplers": samplers, "channels": channels}, None],
        "meshes": [{"primitives": [{"attributes": 3, "targets": [4, {"POSITION": 1}]}]}],
    }

    load("mocap_assist.blender.gltf_sizes").refuse_inflated("take.glb", content, 0)


def fbx(nodes, version):
    """Return a binary FBX file of nodes: name, arrays of zeros by their count, and children."""
    header = struct.Struct("<QQQB" if version >= 7500 else "<IIIB")

    def write(nodes, offset):
        content = b""
        for name, counts, children in nodes:
            packed = zlib.compress(b"")
            arrays = b"".join(
                b"S\x01\0\0\0xd" + struct.pack("<III", count, 1, len(packed)) + packed
                for count in counts
            )
            start = offset + len(content) + header.size + len(name)
            below = write(children, start + len(arrays)) if children else b""
            end = start + len(arrays) + len(below)
            fields = header.pack(end, 2 * len(counts), len(arrays), len(name))
            content += fields + name + arrays + below
        return content + bytes(header.size)

    head = b"Kaydara FBX Binary  \0\x1a\0" + struct.pack("<I", version)
    return head + write(nodes, len(head)) + bytes(99)


@pytest.mark.parametrize("version", [7400, 7700])
@pytest.mark.parametrize("n_curves", [3, 4])
def test_packed_arrays_of_fbx_are_bounded(load, tmp_path, version, n_curves):
    curves = [(b"AnimationCurve", [4 * 10**7], [(b"Key", [], [])])] * n_curves
    nodes = [(b"Header", [1], []), (b"Objects", [], curves), (b"Takes", [], [])]
    path = tmp_path / "take.fbx"
    path.write_bytes(fbx(nodes, version))
    refuse = load("mocap_assist.blender.fbx_sizes").refuse_inflated_fbx

    if n_curves == 3:
        refuse(str(path))
        return
    with pytest.raises(load("solvers.errors").InvalidFileError, match=r"states 1\.28 GB of"):
        refuse(str(path))


def test_a_real_fbx_is_measured(load, recordings):
    content = (recordings / "corpus/fbx/mixamo_web/Idle.fbx").read_bytes()

    total = load("mocap_assist.blender.fbx_sizes")._unfolded_bytes(content)

    assert len(content) / 4 < total < 8 * len(content)


def test_a_crash_of_an_importer_names_the_file(load, tmp_path, monkeypatch):
    scenes = load("mocap_assist.importing.solve_scenes")
    died = load("mocap_assist.jobs.job").ProcessDied
    paths = [tmp_path / name for name in ("good.fbx", "bad.dae", "fine.fbx")]

    def read_blends(blender, names, **_):
        if str(paths[1]) in names:
            raise died("signal SIGSEGV", "Collada import")
        return list(names)

    monkeypatch.setattr(scenes, "read_blends", read_blends)

    first, error, last = scenes.read_scenes(paths, None)

    assert [first, last] == [str(paths[0]), str(paths[2])]
    assert str(error).startswith(f"Reading {paths[1]} crashed Blender: signal SIGSEGV. Export")
