"""Times of tables are read or refused; no frame is lost, and none gets a time of its own."""

import numpy as np
import pytest

from solvers.errors import InvalidFileError
from solvers.motion import Tracks

F, RATE_HZ = 130, 50.0
NAMES = [f"Ball{number}m" for number in range(9)]


def table(columns, n_frames=F):
    """Return a table with columns of times, by title, before those of points."""
    titles = [*columns, *(f"{name}_{axis}" for name in NAMES for axis in "xyz")]
    positions = np.random.default_rng(2).normal(size=(n_frames, 3 * len(NAMES)))
    rows = [[*(cell(k) for cell in columns.values()), *(f"{x:.4f}" for x in row)]
            for k, row in enumerate(positions)]  # fmt: skip
    return "\n".join(";".join(row) for row in [titles, *rows]) + "\n"


def seconds(frame):
    return f"{frame / RATE_HZ:.3f}"


def assert_has_all_frames(recording, rate=RATE_HZ, n_frames=F):
    assert isinstance(recording, Tracks)
    assert recording.frame_rate == pytest.approx(rate)
    assert recording.n_frames == n_frames


@pytest.mark.parametrize("known", [range(10), range(20, 30), {*range(5), F - 1}])
def test_frames_without_times_are_kept(read_any, known):
    """Their times follow from the others: the rate is the same, not an assumed one."""
    recording = read_any(table({"time": lambda k: seconds(k) if k in known else ""}))

    assert_has_all_frames(recording)


@pytest.mark.parametrize(
    ("number", "rate", "n_frames"),
    [
        (lambda k: k, 30.0, F),
        (lambda k: 2 * k, 15.0, F),
        (lambda k: k + 10 * (k > 20), 30.0, F + 10),
        (lambda k: k % 50, 30.0, F),
        (lambda k: 20 * k, 30.0, F),
    ],
    ids=["all", "each second", "a gap", "restarting", "milliseconds"],
)
def test_numbers_of_frames_tell_which_are_there(
    make_reader, collected_messages, number, rate, n_frames
):
    messages, progress = collected_messages
    content = table({"frame": lambda k: str(number(k))})

    assert_has_all_frames(make_reader("a.csv")(content, progress=progress), rate, n_frames)

    assert "The file has no times; 30 Hz is assumed" in messages


def test_one_time_is_no_rate(read_any):
    recording = read_any(table({"time": lambda k: seconds(k) if k == 3 else ""}))

    assert_has_all_frames(recording, 30.0)


@pytest.mark.parametrize("cell", ["{k}/50", "{ms} ms", "{ms}ms", "{s} s", "{s} sec", "{us} µs"])
def test_times_may_have_units_or_be_fractions(read_any, cell):
    for title in ("time", "Time (ms)"):
        recording = read_any(
            table({title: lambda k: cell.format(k=k, ms=20 * k, s=k / RATE_HZ, us=20000 * k)})
        )

        assert_has_all_frames(recording)


@pytest.mark.parametrize(("unit", "time"), [("ft", "s"), ("mm", ""), ("(cm)", "(ms)")])
def test_a_line_of_units_below_the_titles_is_read(read_any, unit, time):
    """Its words do not make the file `damaged`."""
    second = 1000.0 if "m" in time else 1.0
    stamps = {"time": lambda k: f"{second * k / RATE_HZ:.4f}"}
    titles, _, rows = table(stamps).partition("\n")
    units = ";".join([time, *[unit] * (3 * len(NAMES))])

    recording = read_any(f"{titles}\n{units}\n{rows}")

    assert_has_all_frames(recording)
    meters = {"ft": 0.3048, "mm": 0.001, "(cm)": 0.01}[unit]
    assert recording.conventions.unit == meters


@pytest.mark.parametrize("at", [0, 40, F - 1])
def test_a_blank_time_is_between_its_neighbors(read_any, at):
    recording = read_any(table({"time": lambda k: "" if k == at else seconds(k)}))

    assert_has_all_frames(recording)


@pytest.mark.parametrize("cell", ["1,000.5", "mean", "01:00:00:12", "1 5"])
def test_a_cell_that_is_no_time_is_refused(read_any, cell):
    with pytest.raises(InvalidFileError, match=r"line 1[23]: .* is not a number"):
        read_any(table({"time": lambda k: cell if k == 10 else seconds(k)}))


def test_words_below_the_frames_are_no_frames(read_any):
    below = "".join(f"{word};0.5\n" for word in ("mean", "std", "", "# end of file"))

    assert_has_all_frames(read_any(table({"time": seconds}) + below))


def test_last_frames_without_times_are_kept_above_words(read_any):
    content = table({"time": lambda k: "" if k > F - 3 else seconds(k)}) + "mean;0.5\n"

    assert_has_all_frames(read_any(content))


def test_a_short_line_below_words_is_no_frame(read_any):
    content = table({"number": str, "time": seconds}) + ";mean;0.5\nEND\n"

    assert_has_all_frames(read_any(content))


def test_many_words_are_refused(read_any):
    with pytest.raises(InvalidFileError, match="'lost' is not a number"):
        read_any(table({"time": lambda k: "lost" if k > 100 else seconds(k)}))


def test_timecode_is_refused(read_any):
    with pytest.raises(InvalidFileError, match="line 2: '01:00:00:00' is not a number"):
        read_any(table({"time": lambda k: f"01:00:{k // 25:02d}:{k % 25:02d}"}))


def clock(frame):
    """Return a time of day, two seconds before midnight in the first frame."""
    time = (86398.0 + frame / RATE_HZ) % 86400.0
    return f"{time // 3600:02.0f}:{time // 60 % 60:02.0f}:{time % 60:06.3f}"


def test_times_of_day_continue_after_midnight(read_any):
    assert_has_all_frames(read_any(table({"time": clock})))


@pytest.mark.parametrize("by_marker", [False, True])
def test_lines_of_markers_continue_after_midnight(read_any, by_marker):
    """Sorted by time of day, the new day comes first, and the gap of a day is refused."""
    lines = [(k, number) for k in range(F) for number in range(len(NAMES))]
    if by_marker:
        lines.sort(key=lambda line: line[1])
    rows = [f"{clock(k)};{NAMES[number]};{k};{number};0.5" for k, number in lines]

    recording = read_any("\n".join(["time;marker;x;y;z", *rows]))

    assert_has_all_frames(recording)
    steps = np.linalg.norm(np.diff(recording.positions, axis=0), axis=2)
    assert steps == pytest.approx(steps[0, 0])


@pytest.mark.parametrize(("columns", "rate"), [
    ({"time": seconds, "seconds": lambda k: f"{k // 50}"}, RATE_HZ),
    ({"hour": lambda k: "1", "minute": lambda k: "2", "second": lambda k: f"{k // 50}"}, 30.0),
    ({"secs": lambda k: f"{k // 50}", "nsecs": lambda k: f"{k % 50 * 20000000}"}, 30.0),
    ({"time (s)": lambda k: f"{k // 50}", "time (ms)": lambda k: f"{20 * k}"}, RATE_HZ),
    ({"seconds": seconds}, RATE_HZ),
])  # fmt: skip
def test_times_increase_from_frame_to_frame(read_any, columns, rate):
    assert_has_all_frames(read_any(table(columns)), rate)
