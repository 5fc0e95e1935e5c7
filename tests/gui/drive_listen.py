"""Press Listen in a Blender with a window, and let the made actor give commands; take pictures.

    make test-gui DRIVERS=listen

Runs inside that Blender; `bgui` comes with the tool and moves a real pointer. The actor's
frames go over a real socket, each at its time.
"""

import socket
import time
from dataclasses import replace

import bgui
import bpy
import numpy as np
from driver_scene import empty_scene, load, ours, settle, unfold_alone

SENDER = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
ASIDE = np.array((2.0, 0.0, 0.0))
"""From one person to the other, in meters."""
MAX_REPEATS = 6
"""Number of performances in which the solver starts, on a busy machine too."""


def perform(*gestures):
    """Send the frames of the made actor at their times."""
    samples = load("solvers.samples")
    made = samples.perform_gestures(gestures, samples.PerformanceSettings(noise=0.004))
    yield from send(made.recording(), "JSON")
    yield 0.3


def send(recording, protocol):
    """Send a recording in real time."""
    streams = load("solvers.recordings.streams")
    port = streams.PORT
    start = time.monotonic()
    for packets in streams.encode_recording(recording, streams.StreamProtocol[protocol]):
        while time.monotonic() - start < packets.time:
            yield 0.01
        for datagram in packets.datagrams:
            SENDER.sendto(datagram, ("127.0.0.1", port))


def steps():
    empty_scene()
    unfold_alone("perform")
    yield from bgui.open_sidebar("Mocap")
    view = bgui.area().spaces.active.region_3d
    view.view_location, view.view_distance = (0.0, 0.0, 0.9), 5.0
    listening = load("mocap_assist.live.listening")
    yield 0.5
    yield from bgui.scan()
    bgui.shot("1-off.png")
    yield from bgui.click(*bgui.at("mocap_assist.listen"))
    assert listening.current() is not None
    yield 0.5
    bgui.shot("2-no-actor.png")
    yield from perform("hand up", "wave right")
    assert "No search yet" in listening.current().message
    bgui.shot("3-wave.png")
    yield from perform("zoom in", "turn")
    assert view.view_distance < 4.0
    bgui.shot("4-zoomed-and-turned.png")
    yield from follow_the_second_person(listening)
    yield from capture()
    bgui.move(*middle_of_view())
    yield from bgui.key("Escape")
    yield 0.5
    assert listening.current() is None
    yield from record_live()
    yield from record_bones()
    bgui.shot()


def capture():
    """What is performed between two claps is searched for."""
    commands, queries = load("mocap_assist.live.commands"), []
    library = commands.LIBRARY
    commands.LIBRARY = replace(library, search=lambda _, query: queries.append(query) or "")
    yield from perform("clap", "wave left", "clap", "hand up")
    commands.LIBRARY = library
    assert queries[0].n_frames > 30
    bgui.shot("5-captured.png")


def follow_the_second_person(listening):
    """Two people in one stream: the panel shows which one is followed."""
    live = bpy.context.scene.mocap_assist.live
    yield from press_listen()
    assert listening.current() is None
    live.live_person = 2
    yield from settle(pointer=middle_of_view())
    bgui.shot("4b-person.png")
    yield from press_listen()
    streams, samples = load("solvers.recordings.streams"), load("solvers.samples")
    made = samples.perform_gestures(("hand up",), samples.PerformanceSettings()).recording()
    start = time.monotonic()
    for frame in streams.frames_from_recording(made, body=1):
        while time.monotonic() - start < frame.time:
            yield 0.01
        other = replace(frame, body=2, positions=frame.positions + ASIDE)
        for each in (frame, other):
            SENDER.sendto(streams.encode_frame(each), ("127.0.0.1", streams.PORT))
    yield 0.2
    state = listening.current().stream_state
    assert (state.n_people, state.person) == (2, 2), state
    bgui.shot("4c-second-of-two.png")
    yield from press_listen()
    live.live_person = 0
    yield 1.5  # the last sender is followed for a second
    yield from press_listen()


def press_listen():
    yield from settle(pointer=middle_of_view())  # off the button, which the scan would find
    yield from bgui.scan()
    yield from bgui.click(*bgui.at("mocap_assist.listen"))
    yield 0.5


def record_live():
    """The sample's armature follows the made actor; Esc makes an action of it."""
    bpy.ops.mocap_assist.load_sample()
    armature = bpy.context.view_layer.objects.active
    sample = armature.animation_data.action
    yield from settle(pointer=middle_of_view())
    yield from bgui.scan()
    bgui.shot("6-armature.png")
    yield from bgui.click(*bgui.at("mocap_assist.record_live"))
    bgui.move(*middle_of_view())
    job = bpy.context.window_manager.mocap_assist_job
    assert job.running
    for _ in range(MAX_REPEATS):
        yield from perform("hand up", "wave right", "wave left")
        if job.message.startswith("Recording"):
            break
    assert job.message.startswith("Recording the actor. JSON from 127.0.0.1:"), job.message
    bgui.shot("7-recording.png")
    yield from perform("hand up")
    bgui.shot("8-hand-up.png")
    yield from bgui.key("Escape")
    yield 1.0
    assert not job.running
    action = armature.animation_data.action
    assert action != sample and action.frame_range[1] - action.frame_range[0] > 60
    yield from settle()


def record_bones():
    """The armature follows a walk that comes as VMC."""
    samples = load("solvers.samples")
    walk = samples.walking_gait(samples.GaitSettings(duration=8.0, frame_rate=30.0))
    armature = bpy.context.view_layer.objects.active
    before = armature.animation_data.action
    yield 1.5  # the last sender is followed for a second
    yield from bgui.scan()
    yield from bgui.click(*bgui.at("mocap_assist.record_live"))
    bgui.move(*middle_of_view())
    job = bpy.context.window_manager.mocap_assist_job
    for _ in range(MAX_REPEATS):
        yield from send(walk, "VMC")
        if job.message.startswith("Recording"):
            break
    yield from send(walk, "VMC")
    assert job.message.startswith("Recording the actor. VMC from 127.0.0.1:"), job.message
    bgui.shot("9-bones.png")
    yield from bgui.key("Escape")
    yield 1.0
    action, slot = armature.animation_data.action, armature.animation_data.action_slot
    assert action != before and action.frame_range[1] - action.frame_range[0] > 60
    assert bpy.context.scene.mocap_assist.live.hold_feet
    contacts = ours("actions.contact_keys").contact_keys(action, slot)
    assert all(len(keys) > 1 for keys in contacts[:2]), contacts  # both feet step
    bpy.context.scene.frame_set(round(action.frame_range[1] - 30.0))
    yield from settle()
    bgui.shot("10-held-feet.png")


def middle_of_view():
    region = bgui.region("WINDOW")
    return region.x + region.width // 3, region.y + region.height // 2


bgui.run(steps, timeout=1500)
