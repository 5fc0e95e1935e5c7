"""Contacts with the floor: detected, planted, retargeted, and what each goal does.

make bench-contacts                            # some minutes
make bench-contacts ARGUMENTS="--full --docs"  # all walks, into docs/benchmarks/contacts.md
make bench-contacts ARGUMENTS=--dev            # takes to tune on
make bench-contacts ARGUMENTS="--parts detection pins"
"""

import argparse
import sys
from collections.abc import Iterable, Iterator
from time import perf_counter

from solvers.feet import plant_feet
from solvers.motion import Motion
from solvers.recordings import read_acclaim, read_recording
from solvers.workflows import reconstruct_recording
from tests.fixtures.rigs import child, mixamo

from ..first_press import takes
from ..shared import clips
from ..shared.report import DOCS, Report
from ..shared.tables import Scores
from .part_ablation import planters_without, retarget_table
from .part_detection import detection_tables
from .part_pins import pin_tables
from .part_supports import support_tables
from .part_takes import Planter, take_tables
from .part_walks import PLANTERS, walk_tables

SENSORS = {"IRDS": "irds", "UI-PRMD": "ui_prmd", "MSR Action3D": "msr_action3d"}
OTHER_MAKERS = (
    "bandai_namco/dataset-1_walk_tired_001", "bandai_namco/dataset-1_byebye_happy_001",
    "bandai_namco/dataset-1_walk-left_old_001", "dme_xia/neutral_01_000",
    "mixamo_bvh_joe/Walk-In-Circle", "mixamo_bvh_joe/Salsa-Dancing-6", "xsens_mvn/test_mocap",
    "olympe_ballet/ballet", "olympe_sprint/sprint", "pybvh_test1/bvh_test1",
)  # fmt: skip
CLIMBS = ("01_02", "01_04", "01_06", "01_08", "01_10", "01_12", "01_14")
"""Playground, CMU: feet shuffle and pivot in contact. The limits were chosen on others, such as
01_01 and 01_03."""
SCORED_ACTORS = ("bk", "dg")
N_ABLATED = 8
MAX_CLIMB_FRAMES = 2400
N_OF_A_SENSOR = 8
TAKE_PLANTERS: dict[str, Planter] = {
    "planted": lambda motion, contacts: plant_feet(motion).motion,
    "the contacts keyed": PLANTERS["planted"],
} | {name: plant for name, plant in PLANTERS.items() if name != "planted"}
"""Contacts that are found may yield, those that an animator keyed may not."""
PARTS = ("detection", "supports", "walks", "takes", "pins", "ablation")


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--full", action="store_true", help="all scored walks")
    parser.add_argument("--dev", action="store_true", help="takes to tune on instead")
    parser.add_argument("--docs", action="store_true", help="rewrite the document")
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=PARTS)
    chosen = parser.parse_args()
    report = Report(chosen.docs, DOCS / "benchmarks" / "contacts.md")
    for part in chosen.parts:
        started = perf_counter()
        tables = list(_tables(part, chosen.dev, chosen.full))
        report.part(part, tables, perf_counter() - started)
        print(f"Done: {part}", file=sys.stderr, flush=True)


def _tables(part: str, dev: bool, full: bool) -> Iterable[Scores | str]:
    movements = takes.DEVELOPMENT if dev else takes.SCORED
    if part == "detection":
        return detection_tables()
    if part == "supports":
        return support_tables(clips.DEV_ACTORS if dev else SCORED_ACTORS, movements)
    if part == "walks":
        return walk_tables((clips.development if dev else clips.scored)(full))
    if part == "takes":
        return [
            one
            for title, motions in _groups(movements, dev)
            for one in take_tables(title, motions, TAKE_PLANTERS)
        ]
    some = [takes.read(take) for take in movements[:N_ABLATED]]
    if part == "pins":
        return pin_tables(some)
    return [
        *take_tables("Planting, each goal left out", some, planters_without()),
        retarget_table(
            "Retarget, each goal left out", some, {"Mixamo": mixamo, "child": child}
        ),
    ]


def _groups(movements: tuple[takes.Take, ...], dev: bool) -> Iterator[tuple[str, list[Motion]]]:
    yield "All kinds of movement", [takes.read(take) for take in movements]
    actors = sorted(clips.DEV_ACTORS) if dev else SCORED_ACTORS
    paths = [
        path
        for actor in actors
        for kind in clips.hdm05_classes()
        for path in sorted(clips.HDM05.glob(f"HDM_{actor}_{kind}_*_120.amc"))[:1]
    ]
    yield "HDM05, all classes, 120 Hz", [read_acclaim(path) for path in paths]
    if dev:
        return
    yield "Climbs", [takes.read_variety(name).slice(0, MAX_CLIMB_FRAMES) for name in CLIMBS]
    yield "Takes of other makers", [_of_corpus(name) for name in OTHER_MAKERS]
    for title, folder in SENSORS.items():
        yield f"{title}, reconstructed", list(_reconstructed(folder))


def _of_corpus(name: str) -> Motion:
    motion = read_recording(takes.CORPUS / f"{name}.bvh")
    assert isinstance(motion, Motion)
    return motion.slice(0, min(motion.n_frames, 600))


def _reconstructed(folder: str) -> Iterator[Motion]:
    """Return takes of a depth camera, reconstructed, with feet as they are then."""
    paths = sorted(
        path for path in (clips.DATA / "kinect" / folder).rglob("*") if path.is_file()
    )
    for path in paths[:: max(len(paths) // N_OF_A_SENSOR, 1)][:N_OF_A_SENSOR]:
        recording = read_recording(path)
        yield reconstruct_recording(recording, planting=None).motion


if __name__ == "__main__":
    main()
