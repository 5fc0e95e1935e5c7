"""Matroska files that claim more than any camera writes."""

from mkv_files import block, cluster, ebml_header, element

from solvers.progress import unwatched
from solvers.recordings.containers.matroska import MAX_TRACKS, index_matroska


def test_many_tracks_are_bounded(tmp_path):
    tracks = element(0xAE, element(0xD7, 2)) + element(0xAE, b"") * 300_000
    blocks = [block(2, 0, b"x")] * 3000
    path = tmp_path / "take.mkv"
    path.write_bytes(
        ebml_header() + element(0x18538067, element(0x1654AE6B, tracks) + cluster(0, blocks))
    )

    found = index_matroska(path, lambda track: True, unwatched)

    assert len(found.tracks) <= MAX_TRACKS
    assert len(found.tracks[2].offsets) == 3000
