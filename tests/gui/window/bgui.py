"""Press buttons in Blender's window from inside, and take pictures: `bgui.run(steps)`.

`steps` is a generator function; each `yield seconds` lets Blender's event loop run that long.
The pointer and the keys are those of X, by xdotool, and so are the pictures, by maim: Blender's
own screenshot is black here. Coordinates are pixels from the lower left corner of the window.

The tool blender-gui.sh brings a module of this name, which takes precedence.
"""

import os
import subprocess
import sys
import time
import traceback
from pathlib import Path

import bpy

OUT = Path(os.environ["BGUI_OUT"])
SHOT = Path(os.environ["BGUI_SHOT"])
TABS = 30
"""Pixels that the tabs take at the right of the sidebar."""

found = []
"""Of the last scan: x, y and what is there."""


def window():
    return bpy.context.window_manager.windows[0]


def area(kind="VIEW_3D"):
    """Return the largest area of a kind."""
    areas = [each for each in window().screen.areas if each.type == kind]
    return max(areas, key=lambda each: each.width * each.height)


def region(kind="UI", area_type="VIEW_3D"):
    return next(each for each in area(area_type).regions if each.type == kind)


def override(kind="UI", area_type="VIEW_3D"):
    """Give operators the window, the area and the region that a timer's context lacks."""
    view = area(area_type)
    return bpy.context.temp_override(
        window=window(), screen=window().screen, area=view,
        region=region(kind, area_type), space_data=view.spaces.active,
    )  # fmt: skip


def redraw():
    for each in window().screen.areas:
        each.tag_redraw()


def x(*arguments):
    subprocess.run(["xdotool", *map(str, arguments)], check=True, capture_output=True)


def move(column, row):
    """Move the pointer; twice, since Blender acts on motion."""
    line = window().height - 1 - int(row)
    x("mousemove", int(column) - 1, line, "mousemove", int(column), line)


def click(column, row, button=1):
    move(column, row)
    yield 0.15
    x("mousedown", button)
    yield 0.1
    x("mouseup", button)
    yield 0.3


def hover(column, row, wait=1.2):
    """Rest on a button until its tooltip shows; after a click it needs small moves."""
    for step in (-4, 0, 3, 1):
        move(column + step, row)
        yield 0.15
    yield wait


def key(*names):
    x("key", "--clearmodifiers", *names)
    yield 0.2


def dismiss():
    """Close a popup, which may cover buttons."""
    x("key", "Escape")
    yield 0.4


def shot(name=None):
    """Take a picture of the screen, the pointer included."""
    path = OUT / name if name else SHOT
    subprocess.run(["maim", str(path)], check=True)
    print("bgui: shot", path, flush=True)


def open_sidebar(category, width=None):
    """Show a tab of the sidebar of the 3D View; the tabs exist once they have been drawn."""
    area().spaces.active.show_region_ui = True
    for _ in range(40):
        redraw()
        yield 0.1
        try:
            region().active_panel_category = category
            break
        except (AttributeError, TypeError):
            continue
    redraw()
    yield 0.5
    assert region().active_panel_category == category


def hovered():
    """Return the command or the data path of the button under the pointer."""
    manager = bpy.context.window_manager
    with override():
        manager.clipboard = ""
        for copy, options in (
            (bpy.ops.ui.copy_python_command_button, {}),
            (bpy.ops.ui.copy_data_path_button, {"full_path": True}),
        ):
            try:
                if copy.poll() and copy(**options) == {"FINISHED"} and manager.clipboard:
                    return manager.clipboard
            except RuntimeError:
                continue
    return None


def scan(step=6, columns=(0.5,)):
    """Find the buttons of the open tab: Blender cannot tell where they are, so try."""
    sidebar = region()
    found.clear()
    for fraction in columns:
        column, last = sidebar.x + int((sidebar.width - TABS) * fraction), None
        rows = []
        for row in range(sidebar.y + sidebar.height - 5, sidebar.y + 5, -step):
            move(column, row)
            yield 0.04
            what = hovered()
            if what and what == last:
                rows.append(row)
                found[-1] = (column, sum(rows) // len(rows), what)
            elif what:
                rows = [row]
                found.append((column, row, what))
            last = what


def at(text):
    """Return where the button is whose command or data path holds `text`."""
    for column, row, what in found:
        if text in what:
            return column, row
    raise RuntimeError(f"no button {text!r} among {[what for *_, what in found]}")


def run(steps, timeout=200):
    """Drive Blender, and quit it; the extension is unregistered then, which the log shows."""
    started, going = time.monotonic(), None

    def tick():
        nonlocal going
        try:
            if going is None:
                x("search", "--sync", "--onlyvisible", "--class", "blender", "windowfocus")
                going = steps()
            if time.monotonic() - started > timeout:
                raise TimeoutError(f"the driver ran past {timeout} s")
            return next(going)
        except StopIteration:
            if not SHOT.exists():
                shot()
            print("bgui: PASS", flush=True)
            bpy.ops.wm.quit_blender()
        except BaseException:
            traceback.print_exc()
            shot("failed.png")
            sys.stdout.flush()
            os._exit(1)

    bpy.app.timers.register(tick, first_interval=1.0, persistent=True)
