"""The button Listen: from datagrams on a real socket to what Blender does."""

import socket
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose


@pytest.fixture
def library(load, monkeypatch):
    """Record the calls to the library; the real one is restored."""
    commands = load("mocap_assist.live.commands")
    calls = []
    library = commands.Library(
        show=lambda context: calls.append("show") or "The library.",
        page=lambda context, step: calls.append(step) or "A page.",
        search=lambda context, query: calls.append(query) or "Searched.",
        show_all=lambda context: calls.append("all") or "All clips.",
        choose=lambda context: calls.append("choose") or "Chosen.",
        news=lambda: "Found." if "choose" in calls else "",
    )
    monkeypatch.setattr(commands, "LIBRARY", library)
    return calls


def test_listening_is_off_until_the_button_is_pressed(load, blank):
    assert load("mocap_assist.live.listening").current() is None


def test_button_is_disabled_without_a_window(blank):
    assert not blank.ops.mocap_assist.listen.poll()


def test_press_listens_on_loopback_only_and_second_press_stops(listen, load, window, port):
    button = listen()

    current = load("mocap_assist.live.listening").current()
    assert button.outcome == {"RUNNING_MODAL"} and window.modals == [button]
    assert current.listener.receiver.address == ("127.0.0.1", port)
    assert "No data yet" in window.status[-1] and "Esc" in window.status[-1]

    again = listen()

    assert again.outcome == {"FINISHED"} and window.modals == [button]
    assert load("mocap_assist.live.listening").current() is None
    assert window.timers == [] and window.status[-1] is None
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", port))


def test_first_operator_ends_after_the_second_stopped_listening(listen, window, event):
    button = listen()
    listen()

    assert button.modal(window.context, event("TIMER")) == {"CANCELLED"}


def test_esc_stops_listening_and_other_keys_pass(listen, load, window, event):
    button = listen()

    assert button.modal(window.context, event("A", "PRESS")) == {"PASS_THROUGH"}
    assert button.modal(window.context, event("ESC", "RELEASE")) == {"PASS_THROUGH"}
    assert button.modal(window.context, event("ESC", "PRESS")) == {"FINISHED"}
    assert load("mocap_assist.live.listening").current() is None and window.timers == []


def test_opening_another_file_stops_listening(listen, load, blank, window, event):
    button = listen()
    listening = load("mocap_assist.live.listening")

    for each in list(blank.app.handlers.load_pre):
        if each.__module__ == listening.__name__:
            with pytest.MonkeyPatch.context() as patched:
                patched.setattr(listening.bpy, "context", window.context, raising=False)
                each()

    assert listening.current() is None
    assert button.modal(window.context, event("TIMER")) == {"CANCELLED"}


def test_a_port_in_use_is_reported(listen, load, window, port):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("127.0.0.1", port))

        button = listen()

    assert button.outcome == {"CANCELLED"}
    ((kind, message),) = window.reports
    assert kind == {"ERROR"} and f"Port {port} cannot be opened: another program" in message
    press = load("mocap_assist.blender.last_press").last_press()
    assert press.button == "Button" and press.ending != "done"
    assert load("mocap_assist.live.listening").current() is None and window.timers == []


def test_gestures_reach_the_library_and_a_performance_starts_a_search(
    listen, act, library, window
):
    button = listen()

    outcomes = act(
        button, "hand up", "rest", "wave right", "wave left", "clap", "wave right", "clap"
    )

    assert outcomes == {"PASS_THROUGH"}
    assert library[:3] == ["show", 1, -1]
    (query,) = library[3:]
    assert query.n_frames > 30 and query.frame_rate == 30.0
    assert window.status[-1].startswith("Searched.")

    library.append("choose")
    act(button, "rest")
    assert window.status[-1].startswith("Found.")


def test_missing_library_is_reported(listen, act, window):
    button = listen()

    act(button, "hand up", "clap", "rest", "clap")

    assert "There is no library yet" in window.status[-1]


def test_zoom_and_turn_gestures_move_the_view(listen, act, view):
    act(listen(), "zoom in")
    assert view.view_distance == pytest.approx(10.0 / (1.27 / 0.57), rel=0.2)
    view.view_distance = 10.0
    listen()

    act(listen(), "turn")

    swung = np.pi / 2 - np.arctan2(0.66, 0.7)
    assert view.view_distance == 10.0
    assert view.view_rotation.to_euler().z == pytest.approx(-swung, abs=0.1)


def test_camera_view_does_not_move(listen, act, view, window):
    view.view_perspective = "CAMERA"

    act(listen(), "zoom in")

    assert view.view_distance == 10.0
    assert "no 3D View" in window.status[-1]


def test_invalid_datagrams_are_counted_only(listen, load, window, port, event):
    button = listen()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        for junk in (b"", b"\xff" * 1000, b'{"format": "mocap-assist-live"}', b"x" * 60_000):
            sender.sendto(junk, ("127.0.0.1", port))

    assert button.modal(window.context, event("TIMER")) == {"PASS_THROUGH"}

    statistics = load("mocap_assist.live.listening").current().stream_state
    assert (statistics.counts.frames, statistics.counts.unreadable) == (0, 3)


def test_a_followed_person_who_left_is_reported(load):
    texts, streams = load("mocap_assist.live.stream_state"), load("solvers.recordings.streams")
    protocol, counts = streams.StreamProtocol.JSON, streams.StreamCounts(frames=9)
    state = streams.ListenerState("tracker", protocol, 30.0, counts, "", 0, False, 2, 1, True)
    gone = state._replace(is_present=False)

    assert texts.state_text("", state).endswith("2 people; person 1 is followed.")
    assert texts.state_text("", gone).endswith("0 dropped. Person 1 is not in the stream.")


def test_figure_stands_on_the_ground_at_the_origin(listen, act, load):
    act(listen(), "rest")

    lines = load("mocap_assist.live.listening").current().figure.lines()

    assert lines.shape == (19, 2, 3)
    assert 0.0 < lines[..., 2].min() < 0.1 and 1.5 < lines[..., 2].max() < 1.8
    assert np.abs(lines[..., :2]).max() < 0.5


def test_missing_and_unreliable_bones_are_not_drawn(load):
    figure = load("mocap_assist.overlays.live_figure").LiveFigure((1, 1, 1, 1), 2.0)
    frames, motion = load("solvers.recordings.streams"), load("solvers.motion")
    names = motion.SENSOR_JOINTS[motion.Sensor.KINECT_V1]
    positions, confidence = np.ones((20, 3)), np.ones(20)
    positions[7], confidence[11] = np.nan, 0.1

    assert figure.lines().shape == (0, 2, 3)
    figure.show(frames.LiveFrame(0.0, 0, names, positions, confidence))

    assert figure.lines().shape == (17, 2, 3)
    figure.remove()
    figure.remove()


def test_view_rotates_about_the_vertical_and_zoom_is_limited(load, view):
    control = load("mocap_assist.overlays.view_control")
    area = SimpleNamespace(
        type="VIEW_3D",
        spaces=SimpleNamespace(active=SimpleNamespace(region_3d=view)),
        tag_redraw=lambda: None,
    )
    window = SimpleNamespace(screen=SimpleNamespace(areas=[area]))

    for _ in range(4):
        control.rotate_views(window, np.pi / 2)
    for _ in range(100):
        control.zoom_views(window, 100.0)

    assert_allclose(np.abs(view.view_rotation), (1, 0, 0, 0), atol=1e-6)
    assert view.view_distance == pytest.approx(1e-3)
    assert control.zoom_views(None, 2.0).startswith("This window has no 3D View")
