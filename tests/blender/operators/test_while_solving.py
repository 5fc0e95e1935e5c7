"""While a solve runs: what reaches the window, how long it takes yet, and Cancel."""

from types import SimpleNamespace

import pytest

EDITORS = {"VIEW_3D": (0, 300), "DOPESHEET_EDITOR": (0, 100), "OUTLINER": (500, 100)}
"""Lower left corner of each editor of 500 x 200 pixels, above a status bar of 100."""


@pytest.fixture
def context():
    areas = [
        SimpleNamespace(
            type=kind, x=x, y=y, width=500, height=200,
            regions=[
                SimpleNamespace(type="WINDOW", x=x, y=y, width=500, height=200),
                SimpleNamespace(type="UI", x=x + 400, y=y, width=100, height=200),
            ],
        )
        for kind, (x, y) in EDITORS.items()
    ]  # fmt: skip
    return SimpleNamespace(
        screen=SimpleNamespace(areas=areas),
        preferences=SimpleNamespace(system=SimpleNamespace(ui_scale=1.0)),
    )


def event(kind, x, y, **held):
    keys = dict.fromkeys(("ctrl", "alt", "oskey", "shift"), False) | held
    return SimpleNamespace(type=kind, mouse_x=x, mouse_y=y, **keys)


@pytest.mark.parametrize(
    ("kind", "where", "held", "passes"),
    [
        ("MIDDLEMOUSE", (100, 400), {}, True),
        ("MIDDLEMOUSE", (100, 400), {"ctrl": True}, True),
        ("WHEELUPMOUSE", (600, 200), {}, True),
        ("WHEELUPMOUSE", (600, 200), {"ctrl": True}, False),  # changes the value below it
        ("NUMPAD_1", (100, 400), {}, True),
        ("NUMPAD_0", (100, 400), {"ctrl": True, "alt": True}, False),  # moves the camera
        ("RIGHT_ARROW", (100, 200), {}, True),
        ("RIGHT_ARROW", (450, 400), {}, False),  # a list in the sidebar
        ("LEFTMOUSE", (100, 290), {"shift": True}, False),  # selects keys
        ("DOWN_ARROW", (600, 200), {}, False),  # selects the next object of the list
        ("LEFTMOUSE", (100, 400), {}, False),
        ("LEFTMOUSE", (100, 290), {}, True),  # the frame numbers
        ("LEFTMOUSE", (100, 270), {}, False),  # the keys below them
        ("LEFTMOUSE", (600, 290), {}, False),
        ("LEFTMOUSE", (100, 50), {}, True),  # the status bar
        ("G", (100, 400), {}, False),
        ("Z", (100, 400), {"ctrl": True}, False),
        ("SPACE", (100, 400), {}, False),
    ],
)
def test_only_what_looks_and_scrubs_reaches_the_window(
    load, context, kind, where, held, passes
):
    may_pass = load("mocap_assist.runtime.navigation").may_pass

    assert may_pass(context, event(kind, *where, **held)) is passes


def test_time_left_is_in_minutes_or_seconds(load):
    time_left = load("mocap_assist.runtime.watch").time_left

    assert time_left(0.25, 10.0) == "30 s left"
    assert time_left(0.1, 60.0) == "9 min left"
    assert time_left(0.999, 10.0) == "1 s left"
    assert time_left(0.04, 100.0) == ""
    assert time_left(0.5, 1.9) == ""


def test_work_that_esc_ends_has_no_percentage(load):
    percentage = load("mocap_assist.runtime.watch").percentage

    assert percentage(0.25) == "25%"
    assert percentage(1.0) == ""


def test_cancel_needs_a_running_solve(blank):
    with pytest.raises(RuntimeError, match="No solve is running"):
        blank.ops.mocap_assist.cancel_solve()
