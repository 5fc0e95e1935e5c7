"""Drop files on Blender's window, as a file manager does by the XDND protocol.

    python3 drop_files.py COLUMN ROW FILE [FILE ...]

The column and the row are pixels from the upper left corner of the screen. It runs outside of
Blender, which waits for its answer. The exit status is 0 once Blender has taken the files.
"""

import sys
import time
from pathlib import Path

from Xlib import X, display
from Xlib.protocol import event

VERSION = 5
SECONDS = 20.0
N_ANSWERS = 4
"""Answers of Blender before the files are dropped: it looks for a target meanwhile."""


class Dropped:
    """Files on their way to a window.

    Parameters
    ----------
    screen : Xlib.display.Display
    paths : list of str
    """

    def __init__(self, screen, paths):
        self.screen, self.atom = screen, screen.intern_atom
        root = screen.screen().root
        self.target = find_target(screen, root)
        self.source = root.create_window(0, 0, 1, 1, 0, screen.screen().root_depth)
        self.source.set_selection_owner(self.atom("XdndSelection"), X.CurrentTime)
        self.kind = self.atom("text/uri-list")
        self.content = "".join(f"{Path(path).as_uri()}\r\n" for path in paths).encode()
        self.n_answers, self.is_taken = 0, False

    def send(self, name, *data):
        """Send a message of the protocol to the window."""
        numbers = [self.source.id, *data, 0, 0, 0, 0][:5]
        message = event.ClientMessage(
            window=self.target, client_type=self.atom(name), data=(32, numbers)
        )
        self.target.send_event(message)
        self.screen.flush()

    def answer(self, received):
        """React to what the window sends: its requests, and what it makes of the files."""
        if received.type == X.SelectionRequest:
            self.give(received)
        name = getattr(received, "client_type", 0)
        if name == self.atom("XdndStatus"):
            self.n_answers += 1
            if self.n_answers == N_ANSWERS:
                self.send("XdndDrop")
        self.is_taken = self.is_taken or name == self.atom("XdndFinished")

    def give(self, request):
        """Answer a request for the names of the files."""
        place = request.property or request.target
        request.requestor.change_property(place, self.kind, 8, self.content)
        request.requestor.send_event(
            event.SelectionNotify(
                time=request.time, requestor=request.requestor, selection=request.selection,
                target=request.target, property=place,
            )
        )  # fmt: skip
        self.screen.flush()


def main():
    column, row = int(sys.argv[1]), int(sys.argv[2])
    screen = display.Display()
    files = Dropped(screen, sys.argv[3:])
    screen.screen().root.warp_pointer(column, row)
    files.send("XdndEnter", VERSION << 24, files.kind)
    ends_at = time.monotonic() + SECONDS
    while time.monotonic() < ends_at and not files.is_taken:
        if files.n_answers < N_ANSWERS:
            place = column << 16 | row
            files.send("XdndPosition", 0, place, 0, files.atom("XdndActionCopy"))
        time.sleep(0.2)
        while screen.pending_events():
            files.answer(screen.next_event())
    return 0 if files.is_taken else 1


def find_target(screen, window):
    """Return the window below another one that takes drops."""
    for each in window.query_tree().children:
        if each.get_property(screen.intern_atom("XdndAware"), X.AnyPropertyType, 0, 1):
            return each
        if (found := find_target(screen, each)) is not None:
            return found
    return None


sys.exit(main())
