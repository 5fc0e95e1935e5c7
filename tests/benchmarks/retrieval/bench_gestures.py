"""Detected, missed and false gestures, and delays.

    make bench-gestures                     # half a minute
    make bench-gestures ARGUMENTS=--docs    # into docs/benchmarks/retrieval.md

Thresholds were set on subjects 1 and 2 of MSR Action3D, 1, 3 and 5 of UTD-MHAD, 1, 2, 5 of
UI-PRMD and 215 of IRDS, which have columns and rows of their own. The others were not used.
"""

import argparse
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from time import perf_counter

import numpy as np

from solvers.gestures.events import Gesture, GestureEvent
from solvers.gestures.settings import GestureSettings
from solvers.recordings.streams import StreamReader
from solvers.recordings.streams.frames.joint_frames import (
    decode_frame,
    encode_frame,
    frames_from_recording,
)
from solvers.samples import PerformanceSettings, perform_gestures
from solvers.workflows.live.live_session import LiveSession

from ..shared.report import DOCS, Report
from ..shared.tables import table
from .gesture_streams import (
    ALWAYS,
    KINECT,
    UTD,
    Stream,
    counted,
    ours,
    read_stream,
    read_utd,
    thresholds,
)

WAVES = {Gesture.PAGE_NEXT, Gesture.PAGE_BACK}
HANDS_UP = {Gesture.HAND_UP, Gesture.HAND_UP_AGAIN, Gesture.LEFT_HAND_UP}
MEANT = {
    "a10 hand clap": {Gesture.CAPTURE_START},
    "a02 horizontal arm wave": WAVES,
    "a01 high arm wave": {*WAVES, *HANDS_UP},
}
MEANT_UTD = {
    "a4 two hand front clap": {Gesture.CAPTURE_START},
    "a1 right arm swipe to the left": {Gesture.PAGE_BACK},
    "a2 right arm swipe to the right": {Gesture.PAGE_NEXT},
    "a3 right hand wave": WAVES,
}
CLAPPING = ("a10_s0", "a4_")
OTHERS, OTHERS_UTD = "claps in the other 19 actions", "claps in the other 26 actions, UTD-MHAD"
KINDS = (HANDS_UP, WAVES, {Gesture.CAPTURE_START}, {Gesture.ZOOM}, {Gesture.TURN})
NAMES = ("hand up", "waves", "claps", "zoom", "turn")
METHODS = {"ours": ours, "simple thresholds": thresholds}
Method = Callable[[Stream, GestureSettings], tuple[GestureEvent, ...]]
EXERCISES = {
    "UI-PRMD, subjects 3, 4": "ui_prmd/*_s0[34]_*",
    "IRDS, 216, 217": "irds/21[67]_*",
    "KIMORE": "kimore/*.csv",
    "LabanotationSuite": "laban/Ges*.csv",
    "MSR Action3D, 3, 4, without claps": "msr_action3d/a*_s0[34]_*",
    "*UI-PRMD, 1, 2, 5*": "ui_prmd/*_s0[125]_*",
    "*IRDS, 215*": "irds/215_*",
    "*MSR Action3D, 1, 2, without claps*": "msr_action3d/a*_s0[12]_*",
}
MADE = (
    "hand up", "rest", "wave right", "wave right", "wave left", "rest", "zoom in", "rest",
    "zoom out", "rest", "turn", "rest", "clap", "hand up", "wave left", "clap", "rest",
)  # fmt: skip
EXPECTED = Counter({
    Gesture.HAND_UP: 1, Gesture.PAGE_NEXT: 2, Gesture.PAGE_BACK: 1, Gesture.ZOOM: 2,
    Gesture.TURN: 1, Gesture.CAPTURE_START: 2,
})  # fmt: skip
SENSORS = {
    "no noise, 30 Hz": {},
    "1 cm noise": {"noise": 0.01},
    "2 cm noise": {"noise": 0.02},
    "1 cm; each joint hidden every 2 s; 10 % of frames dropped": {
        "noise": 0.01, "hidden": 0.5, "dropped": 0.1, "lateness": 0.005,
    },
    "1 cm; every second; 30 % dropped": {
        "noise": 0.01, "hidden": 1.0, "dropped": 0.3, "lateness": 0.01,
    },
    "1 cm, 15 Hz": {"noise": 0.01, "frame_rate": 15.0},
    "1 cm, 60 Hz": {"noise": 0.01, "frame_rate": 60.0},
}  # fmt: skip
N_SEEDS = 10
DONE = {
    "hand up": {Gesture.HAND_UP},
    "wave right": WAVES,
    "wave left": WAVES,
    "clap": {Gesture.CAPTURE_START, Gesture.CAPTURE_END},
}


def main() -> None:
    """Print four tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument(
        "--docs", action="store_true", help="rewrite docs/benchmarks/retrieval.md"
    )
    chosen = parser.parse_args()
    started = perf_counter()
    tables = [detections(), alarms(), made_streams(), speed()]
    report = Report(chosen.docs, DOCS / "benchmarks" / "retrieval.md")
    report.part("gestures", tables, perf_counter() - started)


def detections() -> str:
    """Return how many real gestures are detected, clip by clip."""
    rows: dict[str, list[str]] = {}
    for subjects, utd_subjects in (("34", "7"), ("12", "135")):
        msr = {path.name: read_stream([path]) for path in _msr(subjects)}
        utd = {
            path.name: read_utd(path)
            for path in sorted(UTD.glob(f"a*_s[{utd_subjects}]_*_skeleton.mat"))
        }
        for streams, meanings in ((msr, MEANT), (utd, MEANT_UTD)):
            for action, meant in meanings.items():
                number = action.split()[0] + "_"
                _count_detections(
                    rows, action, [streams[n] for n in streams if n.startswith(number)], meant
                )
            others = [streams[n] for n in streams if not n.startswith(CLAPPING)]
            name = OTHERS if streams is msr else OTHERS_UTD
            _count_detections(rows, name, others, {Gesture.CAPTURE_START})
    columns = [f"{name}, {who}" for who in ("held out", "*tuned on*") for name in METHODS]
    return (
        "**Gestures of MSR Action3D** (Kinect v1, 15 Hz; subjects 3 and 4, *1 and 2*) **and of"
        " UTD-MHAD** (Kinect v1, 30 Hz; subject 7, *1, 3 and 5*): clips with a detection; waves"
        " count at any time\n\n" + table(["action", *columns], rows) + "\n"
    )


def _msr(subjects: str) -> list[Path]:
    return sorted((KINECT / "msr_action3d").glob(f"a*_s0[{subjects}]_*"))


def _count_detections(
    rows: dict[str, list[str]], name: str, clips: Sequence[Stream], meant: set[Gesture]
) -> None:
    for method in METHODS.values():
        detected = sum(
            bool(meant & {event.gesture for event in method(stream, ALWAYS)})
            for stream in clips
        )
        rows.setdefault(name, []).append(f"{detected} of {len(clips)}")


def alarms() -> str:
    """Return false alarms in recordings without gestures."""
    rows: dict[str, list[str]] = {}
    for name, pattern in EXERCISES.items():
        paths = [path for path in sorted(KINECT.glob(pattern)) if path.name[:3] != "a10"]
        stream = read_stream(paths)
        found = Counter(counted(ours(stream, GestureSettings())))
        simple = counted(thresholds(stream, GestureSettings()))
        cells = [str(sum(found[each] for each in kind)) for kind in KINDS]
        per_minute = [
            f"{len(each) / stream.minutes:.2f}" for each in (list(found.elements()), simple)
        ]
        rows[name] = [f"{stream.minutes:.1f}", *cells, *per_minute]
    columns = ["minutes", *NAMES, "per minute", "simple thresholds, per minute"]
    return (
        "**False alarms** while people exercise, all takes of a data set as one stream, as in"
        " use: waves count after a raised hand, and only a clap counts between two claps\n\n"
        + table(["data", *columns], rows)
        + "\n"
    )


def made_streams() -> str:
    """Return detections of synthetic gestures under noise and dropouts."""
    rows: dict[str, list[str]] = {}
    expected = Counter({each: N_SEEDS * number for each, number in EXPECTED.items()})
    for name, sensor in SENSORS.items():
        detected, extra, delays_by_gesture = Counter[Gesture](), 0, {each: [] for each in DONE}
        for seed in range(N_SEEDS):
            performance = perform_gestures(MADE, PerformanceSettings(**sensor, seed=seed))
            stream = Stream(performance.times, performance.positions, performance.confidence)
            events = ours(stream, GestureSettings())
            found = Counter(counted(events))
            detected += found & EXPECTED
            extra += (found - EXPECTED).total()
            for gesture, done in performance.made:
                _note_delay(delays_by_gesture, gesture, done, events)
        rates = [
            f"{sum(detected[each] for each in kind) / sum(expected[each] for each in kind):.0%}"
            for kind in KINDS
        ]
        delays = (
            [*delays_by_gesture["wave right"], *delays_by_gesture["wave left"]],
            delays_by_gesture["clap"],
            delays_by_gesture["hand up"],
        )
        shown = [f"{1000 * np.median(each):.0f}" if each else "-" for each in delays]
        rows[name] = [*rates, str(extra), *shown]
    columns = [*NAMES, "false detections", "wave, ms", "clap, ms", "hand up, ms"]
    return (
        f"**Synthetic gestures**, {N_SEEDS} streams each: detection rate, and median delay"
        " after the end of the gesture (a raised hand must be held for a second; a wave is"
        " detected before it ends)\n\n" + table(["camera", *columns], rows) + "\n"
    )


def _note_delay(
    delays_by_gesture: dict[str, list[float]],
    name: str,
    done: float,
    events: Sequence[GestureEvent],
) -> None:
    """Add the delay of a detection after the end of its gesture, if it is near."""
    if name in DONE:
        delays = [event.time - done for event in events if event.gesture in DONE[name]]
        delays_by_gesture[name] += [each for each in delays if -0.3 < each < 1.5][:1]


def speed() -> str:
    """Return the time per frame from the socket to the events."""
    recording = perform_gestures(MADE).recording()
    lines = [encode_frame(frame) for frame in frames_from_recording(recording)]
    started = perf_counter()
    for line in lines:
        decode_frame(line)
    decoded = perf_counter()
    session, reader = LiveSession(), StreamReader()
    for line in lines:
        session.add(reader.read(line))
    recognized = perf_counter()
    rows = {
        "decoding a line of 20 joints": [f"{1000 * (decoded - started) / len(lines):.2f}"],
        "complete session": [f"{1000 * (recognized - decoded) / len(lines):.2f}"],
    }
    return "**Time**\n\n" + table(["step", "ms per frame"], rows) + "\n"


if __name__ == "__main__":
    main()
