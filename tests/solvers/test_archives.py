"""Whatever an archive says of itself: what fits is loaded, all else is one sentence."""

import importlib
import io
import os
import pkgutil
import struct
import tracemalloc
import zipfile

import numpy as np
import pytest
from learned_files import LEARNED, SHIPPED, arrays_of, npz
from numpy.testing import assert_array_equal

import solvers
from solvers.archives import ArchiveLayout
from solvers.errors import InvalidFileError
from solvers.npz_members import LEARNED as BOUND
from solvers.npz_members import integers, numbers, read_members, words

OF_EACH = [
    (kind, name)
    for kind, one in LEARNED.items()
    for name in one.members
    if name in one.arrays and one.arrays[name].size
]
CHANGES = [
    (kind, name, change)
    for kind, name in OF_EACH
    for change in ("missing", "axis", "single", "objects", "text or numbers")
    if change != "missing" or not LEARNED[kind].members[name].optional
]
ODD_NUMBERS = [
    (kind, name, number)
    for kind, name in OF_EACH
    for number in (np.nan, np.inf, -1, 2**31 - 1, -(2**31))
    if LEARNED[kind].arrays[name].dtype.kind in ("fiub" if np.isfinite(number) else "f")
]
MEMBERS = {"a": numbers("n", 3), "b": integers("n", minimum=0), "c": words(optional=True)}
LAYOUT = ArchiveLayout("tests", 4, MEMBERS, holds="a damaged test", remedy="Make it again.")
GOOD = {"a": np.zeros((2, 3)), "b": np.arange(2)}


@pytest.fixture
def refused(tmp_path):
    """Load a thing of a kind from these bytes; return the one sentence that refuses it."""

    def load(kind: str, content: bytes, most_memory: float = 8e6) -> str:
        path = tmp_path / "odd.npz"
        path.write_bytes(content)
        tracemalloc.start()
        try:
            with pytest.raises(InvalidFileError) as error:
                LEARNED[kind].load(path)
            assert tracemalloc.get_traced_memory()[1] < most_memory
        finally:
            tracemalloc.stop()
        sentence = str(error.value)
        assert str(path) in sentence and sentence.endswith(".") and "\n" not in sentence
        return sentence

    return load


def test_every_layout_of_an_archive_is_tested():
    modules = [
        importlib.import_module(found.name)
        for found in pkgutil.walk_packages(solvers.__path__, "solvers.")
        if not found.name.endswith("__main__")
    ]
    layouts = [
        each for module in modules for each in vars(module).values()
        if isinstance(each, ArchiveLayout)
    ]  # fmt: skip
    tested = [one.members for one in LEARNED.values()]

    assert len(layouts) >= 10
    assert [
        each.kind for each in layouts if not any(each.members is one for one in tested)
    ] == []


@pytest.mark.parametrize("kind", LEARNED)
def test_saved_archive_is_loaded(kind, tmp_path):
    (tmp_path / "whole.npz").write_bytes(npz(LEARNED[kind].arrays))

    LEARNED[kind].load(tmp_path / "whole.npz")


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_shipped_models_equal_those_read_by_numpy(path):
    layouts = {
        str(one.arrays["kind"]): one for one in LEARNED.values() if one.version is not None
    }
    expected = arrays_of(path)
    with zipfile.ZipFile(path) as archive:
        found = read_members(archive, layouts[str(expected["kind"])].members)

    assert set(found) == set(expected) - {"kind", "version"}
    for name, array in found.items():
        assert_array_equal(array, expected[name])
        assert array.dtype == expected[name].dtype
        assert array.flags.f_contiguous == expected[name].flags.f_contiguous
        assert array.flags.writeable


@pytest.mark.parametrize("kind", [kind for kind, one in LEARNED.items() if one.version])
@pytest.mark.parametrize(
    "version",
    ["text", np.nan, np.inf, [1, 2], 99, -1, True, 1.5, np.array({"a": 1}, object), None],
    ids=repr,
)
def test_other_versions_are_reported_for_any_stored_type(refused, kind, version):
    arrays = dict(LEARNED[kind].arrays)
    del arrays["version"]
    if version is not None:
        arrays["version"] = np.array(version)

    assert "was saved as version " in refused(kind, npz(arrays))


@pytest.mark.parametrize(("kind", "name", "change"), CHANGES)
def test_member_of_another_shape_or_type_is_refused(refused, kind, name, change):
    arrays = dict(LEARNED[kind].arrays)
    array = arrays[name]
    if change == "missing":
        del arrays[name]
    elif change == "axis":
        arrays[name] = array[np.newaxis, ..., np.newaxis]
    elif change == "single":
        arrays[name] = np.zeros((3, 3, 3), array.dtype) if array.ndim == 0 else array.ravel()[0]
    elif change == "objects":
        arrays[name] = array.astype(object)
    else:
        arrays[name] = np.zeros(array.shape) if array.dtype.kind == "U" else array.astype("U9")

    refused(kind, npz(arrays))


@pytest.mark.parametrize(("kind", "name", "number"), ODD_NUMBERS)
def test_invalid_number_is_refused_or_harmless(tmp_path, kind, name, number):
    arrays, path = dict(LEARNED[kind].arrays), tmp_path / "odd.npz"
    array = arrays[name]
    wide = array.astype(np.float64 if array.dtype.kind == "f" else np.int64)
    arrays[name] = np.full_like(wide, number)
    path.write_bytes(npz(arrays))
    must_be_finite = LEARNED[kind].members[name].finite and not np.isfinite(number)

    try:
        LEARNED[kind].load(path)
    except InvalidFileError as error:
        assert "odd.npz" in str(error)
    else:
        assert not must_be_finite


@pytest.mark.parametrize(
    ("kind", "name"),
    [
        ("motions", "poses"), ("postures", "changes"), ("postures", "groups"),
        ("postures", "n_seen"), ("postures", "twists"), ("motions", "clips"),
        ("bases", "n_clips"), ("bases", "moving"), ("residuals", "movement_joints"),
        ("skinned body", "triangles"), ("skinned body", "parents"), ("body", "radii"),
    ],
)  # fmt: skip
def test_formerly_accepted_invalid_numbers_are_refused(refused, kind, name):
    arrays = dict(LEARNED[kind].arrays)
    kinds = arrays[name].dtype.kind
    arrays[name] = np.full(arrays[name].shape, np.nan if kinds == "f" else -1000)

    refused(kind, npz(arrays))


@pytest.mark.parametrize(("kind", "name"), OF_EACH)
def test_declared_sizes_allocate_no_memory(refused, kind, name):
    arrays = LEARNED[kind].arrays
    content = npz(arrays)
    dtype = np.lib.format.dtype_to_descr(arrays[name].dtype)
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        header, {"descr": dtype, "fortran_order": False, "shape": (10**9, 10**6)}
    )

    refused(kind, replaced(content, name, header.getvalue()))


@pytest.mark.parametrize(("kind", "name"), [("bases", "mean"), ("postures", "directions")])
def test_an_archive_that_unpacks_to_too_much_is_refused(refused, kind, name):
    array = LEARNED[kind].arrays[name]
    n_bytes = BOUND.always + 1_000_000
    shape = (n_bytes // array[0].nbytes, *array.shape[1:])
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        header, {"descr": array.dtype.str, "fortran_order": False, "shape": shape}
    )
    bomb = header.getvalue() + bytes(np.prod(shape) * array.itemsize)

    refused(kind, replaced(npz(LEARNED[kind].arrays), name, bomb))


def test_total_size_is_limited(tmp_path):
    n = BOUND.always // 32
    np.savez_compressed(tmp_path / "big.npz", kind="tests", version=4, a=np.zeros((n, 3)),
                        b=np.zeros(n, int))  # fmt: skip
    LAYOUT.read(tmp_path / "big.npz")
    np.savez_compressed(tmp_path / "big.npz", kind="tests", version=4, a=np.zeros((n + 1, 3)),
                        b=np.zeros(n + 1, int))  # fmt: skip

    with pytest.raises(InvalidFileError, match="64000032 bytes stated in a file of"):
        LAYOUT.read(tmp_path / "big.npz")


@pytest.mark.parametrize("name", ["other", "d"])
def test_unused_members_are_not_unpacked(tmp_path, name):
    path = tmp_path / "with more.npz"
    content = npz({"kind": "tests", "version": 4, **GOOD, name: np.zeros(3)})
    path.write_bytes(replaced(content, name, bytes(100_000_000)))

    tracemalloc.start()
    try:
        assert set(LAYOUT.read(path)) == {"a", "b"}
        assert tracemalloc.get_traced_memory()[1] < 1e6
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("version", [b"\1\0", b"\2\0", b"\3\0"])
def test_too_long_header_is_not_read(refused, version):
    length = struct.pack("<H" if version == b"\1\0" else "<I", 60_000)
    header = b"\x93NUMPY" + version + length + bytes(60_000)

    refused("bases", replaced(npz(LEARNED["bases"].arrays), "mean", header))


def test_other_compression_methods_are_refused(refused):
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_BZIP2) as archive:
        for name, array in LEARNED["bases"].arrays.items():
            with archive.open(f"{name}.npy", "w") as member:
                np.lib.format.write_array(member, array)

    assert "is not a readable archive (compressed by" in refused("bases", file.getvalue())


@pytest.mark.parametrize("kind", LEARNED)
def test_pipes_folders_and_missing_files_are_reported(kind, tmp_path):
    os.mkfifo(tmp_path / "pipe")

    for path in (tmp_path / "pipe", tmp_path, tmp_path / "gone.npz"):
        with pytest.raises(InvalidFileError, match=r"it is not a file|There is no file"):
            LEARNED[kind].load(path)


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"someone's notes",
        npz({"a": np.zeros(3)}),
        npz({"kind": np.zeros(2), "version": 1}),
    ],
    ids=["empty", "text", "another archive", "kind is no word"],
)
def test_file_of_another_program_is_not_overwritten(tmp_path, content):
    path = tmp_path / "precious.npz"
    path.write_bytes(content)

    with pytest.raises(InvalidFileError, match=r"precious\.npz is not a file of Mocap Assist;"):
        LAYOUT.write(path, GOOD)

    assert path.read_bytes() == content
    assert [each.name for each in tmp_path.iterdir()] == ["precious.npz"]


def test_own_archive_is_overwritten(tmp_path):
    (tmp_path / "own.npz").write_bytes(npz(LEARNED["body"].arrays))

    LAYOUT.write(tmp_path / "own.npz", GOOD)

    assert_array_equal(LAYOUT.read(tmp_path / "own.npz")["b"], GOOD["b"])


def replaced(content: bytes, name: str, member: bytes) -> bytes:
    """Return an archive with other bytes in one of its members."""
    file = io.BytesIO()
    with (
        zipfile.ZipFile(io.BytesIO(content)) as old,
        zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as new,
    ):
        for each in old.namelist():
            new.writestr(each, member if each == f"{name}.npy" else old.read(each))
    return file.getvalue()
