"""Tables with a line for each joint are read whatever their columns are called."""

import numpy as np
import pytest
from exports.camera_bodies import mediapipe

from solvers.errors import InvalidFileError
from solvers.motion import (
    JointRecording,
    Sensor,
    Tracks,
    find_humanoid_map,
    forward_kinematics,
)
from solvers.motion.skeletons import BODY_POINTS
from solvers.recordings import list_bodies, read_recording
from solvers.samples import walking_gait

F = 40
POINTS = mediapipe(F)
WORLD = np.stack([POINTS[..., 0], POINTS[..., 2], -POINTS[..., 1]], axis=-1)
"""By definition of MediaPipe: x right, y down, z away from the camera."""


def walk() -> dict[str, np.ndarray]:
    """Return the positions of joints by role, meters, Z up."""
    motion = walking_gait()
    roles = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    positions = forward_kinematics(motion).positions[:F]
    return {role: positions[:, at] for role, at in roles.items()}


def lines(points, form="{frame},{name},{x:.6f},{y:.6f},{z:.6f}", step=1):
    """Return a line for each joint of each frame, by names or roles."""
    return [
        form.format(
            frame=k,
            number=step * k,
            t=k / 25.0,
            name=name,
            **dict(zip("xyz", path[k], strict=False)),
        )
        for k in range(F)
        for name, path in points.items()
    ]


@pytest.fixture
def save(tmp_path):
    def write(titles, rows):
        path = tmp_path / "take.csv"
        path.write_text("\n".join([titles, *rows]) + "\n")
        return path

    return write


def landmarks(moved=0.0):
    return {name: POINTS[:, at, :3] + moved for at, name in enumerate(BODY_POINTS)}


@pytest.mark.parametrize("title", ["person", "Player ID", "user_id", "who"])
def test_landmarks_of_two_people_are_two_bodies(save, title):
    """A `person` next to landmarks is not ignored, nor the table refused."""
    rows = lines(landmarks(), "{frame},anna,{name},{x},{y},{z},0.9")
    rows += lines(landmarks(), "{frame},ben,{name},{x},{y},{z},0.5")

    path = save(f"frame,{title},landmark,x,y,z,visibility", rows)

    assert [body.name for body in list_bodies(path)] == ["anna", "ben"]
    recording = read_recording(path, body="ben")
    assert recording.sensor is Sensor.MEDIAPIPE
    assert np.allclose(recording.tracks.positions[:, :33], WORLD, atol=1e-6)
    assert np.nanmax(recording.tracks.confidence) == pytest.approx(0.5)


def test_landmarks_of_the_world_come_before_those_of_the_picture(save):
    """With x, y and z the table is refused as one of a picture."""
    rows = lines(landmarks(), "{frame},{name},0.5,0.5,-0.1,{x},{y},{z}")

    recording = read_recording(save("frame,landmark,x,y,z,world_x,world_y,world_z", rows))

    assert np.allclose(recording.tracks.positions[:, :33], WORLD, atol=1e-6)


def test_landmarks_without_depth_are_refused(save):
    rows = lines(landmarks(), "{frame},{name},{x},{y}")

    with pytest.raises(InvalidFileError, match="Save the pose_world_landmarks"):
        read_recording(save("frame,landmark,x,y", rows))


@pytest.mark.parametrize(
    ("titles", "form"),
    [
        ("frame,bone_name,loc_x,loc_y,loc_z,rot_x", "{frame},{name},{x},{y},{z},0.5"),
        ("frame,qx,qy,qz,px,py,pz,bone", "{frame},.1,.2,.3,{x},{y},{z},{name}"),
        ("time,joint,pos_x,pos_y,poz_z", "{t},{name},{x},{y},{z}"),
        ("FrameNumber,Key Point,coord x,coord y,coord z", "{frame},{name},{x},{y},{z}"),
        ("t,tracker,bodyX,bodyY,bodyZ,state", "{t},{name},{x},{y},{z},ok"),
    ],
)
def test_columns_are_recognized_by_the_axes_at_the_end_of_their_titles(save, titles, form):
    """Titles need not be listed; a misspelled one is read, too."""
    recording = read_recording(save(titles, lines(walk(), form)))

    assert isinstance(recording, JointRecording)
    hips = recording.tracks.positions[:, recording.names.index("pelvis")]
    assert np.linalg.norm(np.diff(hips, axis=0), axis=1) == pytest.approx(
        np.linalg.norm(np.diff(walk()["hips"], axis=0), axis=1), abs=1e-4
    )


def test_versions_of_a_body_are_listed(save):
    """freemocap's raw and rigid joints are not one joint twice."""
    rows = lines(walk(), "{frame},{name},{x},{y},{z},body,3d_xyz")
    rows += lines(walk(), "{frame},{name},{x},{y},{z},body,rigid_3d_xyz")

    path = save("frame,keypoint,x,y,z,model,trajectory", rows)

    assert [body.name for body in list_bodies(path)] == ["3d_xyz", "rigid_3d_xyz"]


def test_a_few_trackers_are_refused_with_what_would_serve(save):
    few = dict(list(walk().items())[:5])

    with pytest.raises(InvalidFileError, match="Export the skeleton that your program"):
        read_recording(save("timestamp,device,x,y,z", lines(few, "{t},{name},{x},{y},{z}")))


def test_velocities_are_no_positions(save):
    rows = lines(walk(), "{frame},{name},{x},{y},{z}")

    with pytest.raises(InvalidFileError, match="unknown format"):
        read_recording(save("frame,joint,vel_x,vel_y,vel_z", rows))


@pytest.mark.parametrize(
    ("titles", "form"),
    [
        ("frame,joint,local_x,local_y,local_z,x,y,z", "{frame},{name},0,1,2,{x},{y},{z}"),
        ("frame,joint,dirX,dirY,dirZ,x,y,z", "{frame},{name},0,1,2,{x},{y},{z}"),
        ("frame,joint,u_x,u_y,u_z,pos_x,pos_y,pos_z", "{frame},{name},0,1,2,{x},{y},{z}"),
        ("frame,joint,x,y,z,confidence", "{frame},{name},{x},{y},{z},High"),
    ],
)
def test_positions_come_before_other_vectors_and_words(save, titles, form):
    """The first vector need not be the position, and a confidence may be in words."""
    recording = read_recording(save(titles, lines(walk(), form)))

    hips = recording.tracks.positions[:, recording.names.index("pelvis")]
    assert np.ptp(hips, axis=0).max() == pytest.approx(
        np.ptp(walk()["hips"], axis=0).max(), abs=1e-4
    )


def test_directions_alone_are_no_positions(save):
    rows = lines(walk(), "{frame},{name},{x},{y},{z}")

    with pytest.raises(InvalidFileError, match="unknown format"):
        read_recording(save("frame,joint,dir_x,dir_y,dir_z", rows))


@pytest.mark.parametrize("name", ["{at}", "\u00b2{at}"])
def test_many_landmarks_are_not_those_of_a_pose(save, name):
    """The first 33 of a face are no pose, and a superscript ends in no traceback."""
    face = {name.format(at=at): POINTS[:, at % 33, :3] for at in range(90)}
    rows = lines(face, "{frame},{name},{x},{y},{z}")

    assert isinstance(read_recording(save("frame,landmark,x,y,z", rows)), Tracks)


@pytest.mark.parametrize(
    ("titles", "form", "rate"),
    [
        ("frame,joint,x,y,z", "{frame},{name},{x},{y},{z}", 30.0),
        ("# fps: 60\nframe,joint,x,y,z", "{frame},{name},{x},{y},{z}", 60.0),
        ("frame_rate,60\nframe,joint,x,y,z", "{frame},{name},{x},{y},{z}", 60.0),
        ("frame,joint,x,y,z,fps", "{frame},{name},{x},{y},{z},60", 60.0),
        ("frame,joint,x,y,z,Frame Rate (Hz)", "{frame},{name},{x},{y},{z},59.94", 59.94),
        ("frame,joint,x,y,z,fps", "{frame},{name},{x},{y},{z},{frame}", 30.0),
        ("frame,joint,x,y,z,fps", "{frame},{name},{x},{y},{z},1", 30.0),
        ("frame,joint,x,y,z,fps", "{frame},{name},{x},{y},{z},9999", 30.0),
        ("# fps: 60\nframe,time,joint,x,y,z", "{frame},{t},{name},{x},{y},{z}", 25.0),
    ],
)
@pytest.mark.parametrize("step", [1, 2])
def test_lines_of_joints_have_the_rate_of_the_table(
    save, collected_messages, titles, form, rate, step
):
    """A stated rate counts, and so do numbers in steps."""
    messages, progress = collected_messages
    rows = lines(walk(), form.replace("{frame}", "{number}"), step)

    recording = read_recording(save(titles, rows), progress=progress)

    in_steps = step if "time" not in titles else 1
    assert recording.frame_rate == pytest.approx(rate / in_steps, rel=1e-4)
    assert recording.n_frames == F
    assert any(f"in steps of {step}" in message for message in messages) == (in_steps > 1)
    assert any("is assumed" in message for message in messages) == (rate == 30.0)
