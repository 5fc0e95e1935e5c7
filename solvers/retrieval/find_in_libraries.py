"""Find similar clips in several libraries with one vocabulary, as if they were one library."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..errors import InvalidSettingError
from ..progress import Progress, unwatched, within
from .find_similar import ClipAligner, build_matches, find_similar, settings_for
from .index import (
    CLIP_RATE_HZ,
    ClipEntry,
    Match,
    Vocabulary,
    default_distances,
    may_cache_distances,
)
from .library import load_clip_library
from .postures import ClipPostures, Recording, clip_postures
from .search import (
    DEFAULT_FIND_SETTINGS,
    Candidates,
    DescribedQuery,
    FindMethod,
    FindSettings,
    collect_candidates,
    describe_query,
    merge_candidates,
    rank_candidates,
)


@dataclass(frozen=True, eq=False)
class FoundClip:
    """A similar clip of one of several libraries."""

    library: Path
    """The file of its library."""
    entry: ClipEntry
    match: Match


@dataclass(frozen=True, eq=False)
class _Shard:
    """What a search keeps of a library that it has closed again."""

    path: Path
    vocabulary: Vocabulary
    query: DescribedQuery
    candidates: Candidates
    entries: tuple[ClipEntry, ...]
    """Those of the candidates."""


def find_in_libraries(
    query: Recording,
    libraries: Sequence[Path],
    *,
    settings: FindSettings = DEFAULT_FIND_SETTINGS,
    ignore: Collection[str] = (),
    progress: Progress = unwatched,
) -> tuple[FoundClip, ...]:
    """Rank the clips of several libraries by similarity to the query, as `find_similar` does.

    The ranking is that of one library with all clips and the same vocabulary. One library at a
    time is in memory.

    Parameters
    ----------
    query : Motion, Tracks or JointRecording
    libraries : sequence of Path
        Files of libraries. Clips with equal scores are in the order of their libraries.
    settings : FindSettings
    ignore : collection of str, optional
        Names of clips to leave out, in all libraries.
    progress : Progress

    Returns
    -------
    tuple of FoundClip
        Best first; empty if no library has clips.

    Raises
    ------
    InvalidFileError
        A file is missing or not a library.
    InvalidMotionError
        The query shows no body, or none of the compared parts was tracked.
    InvalidSettingError
        Two libraries have different vocabularies, or the method searches only one library.
    """
    if settings.method is FindMethod.PUBLISHED:
        if len(libraries) > 1:
            raise InvalidSettingError("The published method searches only one library.")
        return _find_as_published(query, libraries[0], settings, ignore, progress)
    settings = settings_for(query, settings)
    postures = clip_postures(query, CLIP_RATE_HZ)
    shards = list[_Shard]()
    for index, path in enumerate(libraries):
        progress(0.9 * index / len(libraries), f"Searching {path.name}")
        shard = _search(path, postures, shards[0] if shards else None, settings, ignore)
        shards += [] if shard is None else [shard]
    return _merge(query, shards, settings, within(progress, 0.9, 1.0)) if shards else ()


def _find_as_published(
    query: Recording,
    path: Path,
    settings: FindSettings,
    ignore: Collection[str],
    progress: Progress,
) -> tuple[FoundClip, ...]:
    with load_clip_library(path) as library:
        matches = find_similar(
            query, library, settings=settings, ignore=ignore, progress=progress
        )
        entries = {entry.name: entry for entry in library.entries}
        return tuple(FoundClip(path, entries[match.clip], match) for match in matches)


def _search(
    path: Path,
    postures: ClipPostures,
    first: _Shard | None,
    settings: FindSettings,
    ignore: Collection[str],
) -> _Shard | None:
    """Return the candidates of a library; None if it has no clips."""
    with load_clip_library(path) as library:
        vocabulary, entries = library.vocabulary, library.numbered()
        if vocabulary is None or not entries:
            return None
        if first is not None and not vocabulary.describes_like(first.vocabulary):
            raise InvalidSettingError(
                f"{first.path} and {path} have different vocabularies, so their clips cannot"
                f" be ranked together. Index {path} again with --vocabulary {first.path}."
            )
        described = first.query if first else describe_query(postures, vocabulary, settings)
        candidates = collect_candidates(
            described.segments,
            described.weights,
            library.search_index,
            settings,
            library.numbers_of(ignore),
        )
        kept = tuple(entries[number] for number in candidates.clips.tolist())
        return _Shard(path, vocabulary, described, candidates, kept)


def _merge(
    query: Recording, shards: Sequence[_Shard], settings: FindSettings, progress: Progress
) -> tuple[FoundClip, ...]:
    """Rank the candidates of all libraries, and align the best ones."""
    described, vocabulary = shards[0].query, shards[0].vocabulary
    merged = merge_candidates([shard.candidates for shard in shards], settings)
    is_small = may_cache_distances(merged.n_segments)
    ranking = rank_candidates(
        described.segments, described.weights, merged, settings,
        lambda: default_distances(merged.summaries) if is_small else None,
    )  # fmt: skip
    homes = [
        (shard, number, entry)
        for shard in shards
        for number, entry in zip(shard.candidates.clips.tolist(), shard.entries, strict=True)
    ]
    entries = {index: entry for index, (_, _, entry) in enumerate(homes)}
    matches = build_matches(ranking, entries, settings)
    aligner = ClipAligner(query, described, vocabulary)
    for rank in range(min(settings.n_aligned, len(matches))):
        progress(rank / settings.n_aligned, "Aligning")
        shard, number, entry = homes[int(ranking.clips[rank])]
        segment = ranking.frames[rank]
        with load_clip_library(shard.path) as library:
            postures = library.postures(number, int(segment[1]))
        matches[rank] = aligner.match(matches[rank], entry, postures, segment)
    progress(1.0)
    return tuple(
        FoundClip(homes[clip][0].path, homes[clip][2], match)
        for clip, match in zip(ranking.clips.tolist(), matches, strict=False)
    )
