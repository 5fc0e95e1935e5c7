"""How well clips of a class are found: clean, damaged and recorded by a Kinect."""

import pickle
import re
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass, field
from multiprocessing import get_context
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time

import numpy as np

from ..shared.report import BENCHMARK_PICTURES, show
from ..shared.tables import number, table
from .retrieval_clips import MISFILED, TRAINING, LabeledClip, library
from .retrieval_damage import DAMAGES
from .retrieval_default import DefaultLibrary
from .retrieval_fusion import FusedLibrary
from .retrieval_kinect import kinect_queries
from .retrieval_methods import METHODS, OURS, PUBLISHED
from .retrieval_pictures import draw_confusion, draw_curves
from .retrieval_protocol import (
    Answer,
    Prepared,
    Query,
    answer,
    mean_precision,
    mean_true_positives,
    queries,
)

Say = Callable[[str], None]
OTHERS = "other actors"
CACHE = Path("build") / "retrieval"
QUERY_STEP = 4
"""Clips of the test classes from one damaged query to the next."""


@dataclass
class Found:
    """All answers of one method."""

    seconds: float
    """That it took to prepare the library."""
    megabytes: float
    answers: dict[str, list[Answer]] = field(default_factory=dict)
    """By damage; with `OTHERS` those where all clips of the same actor are left out."""
    kinect: list[Answer] = field(default_factory=list)

    def tested(self, kind: str) -> list[Answer]:
        """Return answers to queries of classes that nothing was chosen on."""
        return [each for each in self.answers[kind] if each.label not in TRAINING]

    def well_filed(self) -> list[Answer]:
        """Return answers to clean queries of test classes that are of the class they have."""
        return [
            each
            for clip, each in zip(library(), self.answers["clean"], strict=True)
            if clip.name not in MISFILED and each.label not in TRAINING
        ]

    def damaged(self, kind: str) -> list[Answer]:
        """Return answers to the same clips for each kind of damage."""
        return self.tested(kind)[:: QUERY_STEP if kind == "clean" else 1]


def find_all(names: Sequence[str], n_jobs: int, say: Say) -> None:
    """Ask these methods everything, `n_jobs` at a time, and keep what they answer."""
    CACHE.mkdir(parents=True, exist_ok=True)
    with ProcessPoolExecutor(n_jobs, get_context("spawn")) as pool:
        pending = {pool.submit(found_by, name): name for name in names}
        for each in as_completed(pending):
            found = each.result()
            _cache_file(pending[each]).write_bytes(pickle.dumps(found))
            say(f"{pending[each]}: MAP {mean_precision(found.tested('clean')):.3f}")


def cached_results() -> dict[str, Found]:
    """Return what was found by this run and those before."""
    return {
        name: pickle.loads(_cache_file(name).read_bytes())
        for name in METHODS
        if _cache_file(name).exists()
    }


def _cache_file(name: str) -> Path:
    return CACHE / f"{re.sub('[^a-zA-Z0-9]+', '_', name)}.pickle"


def found_by(name: str) -> Found:
    """Ask one method everything; damaged queries are of the test classes only."""
    clips = library()
    pending = [clip for clip in clips if clip.label not in TRAINING]
    started = process_time()
    prepared = METHODS[name].prepare([clip.tracks for clip in clips])
    found = Found(process_time() - started, megabytes(prepared))
    for kind, damage in DAMAGES.items():
        of = clips if kind == "clean" else pending[::QUERY_STEP]
        found.answers[kind] = answer(prepared, clips, queries(clips, of, damage))
    others = queries(clips, pending, DAMAGES["clean"], other_actors=True)
    found.answers[OTHERS] = answer(prepared, clips, others)
    found.kinect = answer(prepared, clips, _kinect(clips))
    return found


def _kinect(clips: Sequence[LabeledClip]) -> list[Query]:
    return list(queries(clips, kinect_queries(), DAMAGES["clean"], other_actors=True))


def accuracy(found: Mapping[str, Found]) -> str:
    """Return the main table."""
    rows = {
        name: [
            *_figures(each.tested("clean")), f"{mean_precision(each.well_filed()):.3f}",
            *_figures(each.tested(OTHERS)),
            *_figures(each.answers["clean"]), *_cost(each),
        ]
        for name, each in found.items()
    }  # fmt: skip
    header = ["method"]
    header += [
        f"{what} {of}" for of in ("test", "other actors", "all") for what in ("MAP", "TP@20")
    ]
    header.insert(3, "MAP test, less two misfiled")
    header += ["describe, ms", "search, ms", "prepare, s", "MB"]
    n_test = len(next(iter(found.values())).tested("clean"))
    return (
        f"**Clips of the same class** ({len(library())} clips; {n_test} queries of test"
        f" classes)\n\n{table(header, rows)}\n"
    )


def damaged(found: Mapping[str, Found]) -> str:
    """Return MAP of damaged queries of test classes."""
    rows = {
        name: [f"{mean_precision(each.damaged(kind)):.3f}" for kind in DAMAGES]
        for name, each in found.items()
    }
    title = "**Damaged queries of test classes**, each fourth clip, MAP"
    return f"{title}\n\n{table(['method', *DAMAGES], rows)}\n"


def accuracy_on_kinect(found: Mapping[str, Found]) -> str:
    """Return MAP of Kinect takes, set by set."""
    sets = np.array([clip.actor for clip in kinect_queries()])
    names = list(dict.fromkeys(sets))
    rows = {}
    for name, each in found.items():
        precisions = np.array([one.precision for one in each.kinect])
        means = [float(precisions[sets == one].mean()) for one in names]
        rows[name] = [f"{mean:.3f}" for mean in (*means, float(np.mean(means)))]
    header = ["method", *names, "mean"]
    return f"**Kinect takes as queries**, MAP\n\n{table(header, rows)}\n"


def each_class(found: Mapping[str, Found]) -> str:
    """Return MAP of clean queries, class by class."""
    labels = sorted({clip.label for clip in library()})
    rows = {}
    for name, each in found.items():
        clean = each.answers["clean"]
        by_class = [[one for one in clean if one.label == label] for label in labels]
        rows[name] = [f"{mean_precision(one):.2f}" for one in by_class]
    return f"**Class by class**, MAP, clean\n\n{table(['method', *labels], rows)}\n"


def pictures(found: Mapping[str, Found]) -> str:
    """Draw curves and confusions; return the lines that show them."""
    clean = {name: each.tested("clean") for name, each in found.items()}
    kinect = {name: each.kinect for name, each in found.items()}
    folder = BENCHMARK_PICTURES / "retrieval"
    draw_curves(clean, "Queries of test classes, clean", folder / "curves.png")
    draw_curves(kinect, "Queries by Kinect", folder / "curves_kinect.png")
    shown = ["curves", "curves_kinect"]
    for name, word in ((OURS, "ours"), (PUBLISHED, "published")):
        if name in found:
            path = folder / f"confusion_{word}.png"
            draw_confusion(found[name].answers["clean"], f"What {name} finds", path)
            shown.append(f"confusion_{word}")
    return "\n".join(f"{show(folder / f'{each}.png', each)}\n" for each in shown)


MEASURES = (mean_precision, mean_true_positives)


def _figures(answers: list[Answer]) -> list[str]:
    return [f"{measure(answers):.3f}" for measure in MEASURES]


def _cost(found: Found) -> list[str]:
    answers = found.answers["clean"]
    times = [[one.describe_ms for one in answers], [one.search_ms for one in answers]]
    return [*(number(float(np.median(each))) for each in times),
            number(found.seconds), number(found.megabytes)]  # fmt: skip


def megabytes(prepared: Prepared) -> float:
    """Return how much there is to keep: that of a file where there is one, else pickled."""
    if isinstance(prepared, DefaultLibrary):
        with TemporaryDirectory() as folder:
            path = Path(folder) / "library"
            prepared.library.save(path)
            return path.stat().st_size / 1e6
    if isinstance(prepared, FusedLibrary):
        return sum(map(megabytes, prepared.prepared)) + prepared.between.nbytes / 1e6
    return len(pickle.dumps(prepared)) / 1e6
