"""Matroska files that claim more than any camera writes."""

from time import process_time

from mkv_files import block, cluster, ebml_header, element

from solvers.progress import unwatched
from solvers.recordings.containers.matroska import MAX_TRACKS, index_matroska


def test_many_tracks_are_bounded_and_cost_no_time(tmp_path):
    tracks = element(0xAE, element(0xD7, 2)) + element(0xAE, b"") * 300_000
    blocks = [block(2, 0, b"x")] * 3000
    path = tmp_path / "take.mkv"
    path.write_bytes(
        ebml_header() + element(0x18538067, element(0x1654AE6B, tracks) + cluster(0, blocks))
    )

    started = process_time()
    found = index_matroska(path, lambda track: True, unwatched)

    assert process_time() - started < 5.0
    assert len(found.tracks) <= MAX_TRACKS
    assert len(found.tracks[2].offsets) == 3000
