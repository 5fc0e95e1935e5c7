"""A window that Blender only pretends to have, and an actor who sends to it over loopback."""

import socket
from types import SimpleNamespace

import pytest


@pytest.fixture
def view():
    """What of a 3D View is moved."""
    from mathutils import Quaternion

    return SimpleNamespace(
        view_distance=10.0, view_perspective="PERSP", view_rotation=Quaternion()
    )


@pytest.fixture
def window(blank, view):
    """The context that Listen gets there, and what it does to it."""
    area = SimpleNamespace(
        type="VIEW_3D",
        spaces=SimpleNamespace(active=SimpleNamespace(region_3d=view, show_region_ui=True)),
        tag_redraw=lambda: None,
    )
    other = SimpleNamespace(type="OUTLINER", tag_redraw=lambda: None)
    screen = SimpleNamespace(areas=[other, area])
    record = SimpleNamespace(timers=[], status=[], reports=[], modals=[])
    shown = SimpleNamespace(screen=screen)
    record.context = SimpleNamespace(
        scene=blank.context.scene,
        window=shown,
        window_manager=SimpleNamespace(
            event_timer_add=lambda *_, **__: record.timers.append("timer") or "timer",
            event_timer_remove=record.timers.remove,
            modal_handler_add=record.modals.append,
            windows=[shown],
        ),
        workspace=SimpleNamespace(status_text_set=record.status.append),
    )
    return record


@pytest.fixture
def port():
    """Return a port without a listener."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        return free.getsockname()[1]


@pytest.fixture
def listen(load, window, port, monkeypatch):
    """Press Listen; return the button. All is ended afterwards."""
    button = load("mocap_assist.live.listen_button")
    listening = load("mocap_assist.live.listening")
    monkeypatch.setattr(button, "live_port", lambda: port)

    class Button(button.ListenButton):
        def report(self, kind, message):
            window.reports.append((kind, message))

    def press():
        pressed = Button()
        pressed.outcome = pressed.invoke(window.context, None)
        return pressed

    yield press
    while listening.current() is not None:
        listening.current().end(window.context)


@pytest.fixture
def act(load, window, port):
    """Let the made actor perform before a button that listens; frames arrive as sent."""
    frames, samples = load("solvers.recordings.streams"), load("solvers.samples")

    def perform(button, *gestures):
        recording = samples.perform_gestures(gestures, samples.PerformanceSettings(noise=0.003))
        outcomes = set()
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            for number, frame in enumerate(frames.frames_from_recording(recording.recording())):
                sender.sendto(frames.encode_frame(frame), ("127.0.0.1", port))
                if number % 3 == 2:
                    outcomes |= button.modal(window.context, event("TIMER"))
        outcomes |= button.modal(window.context, event("TIMER"))
        return outcomes

    return perform


def event(kind, value="NOTHING"):
    return SimpleNamespace(type=kind, value=value)


@pytest.fixture(name="event")
def make_event():
    return event
