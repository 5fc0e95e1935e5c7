"""Files that are no recordings are refused with what would serve, and nothing else is."""

import gzip
import io
import json
import pickle
import re
import zlib

import numpy as np
import pytest
from joint_files import npz
from odd_files import archive

from solvers.errors import InvalidFileError

FLAT = "2D keypoints of images, without depth"
OPENSIM = "results of OpenSim, which need its model"
PICKLE = "is a pickle, which is never opened"


def torch_file() -> bytes:
    name = "hmr4d_results_of_a_video_with_a_long_name/data.pkl"
    return archive(name, b"\x80\x02}q\x00.")


def object_array() -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, {"pred_rotmat": 1})
    return buffer.getvalue()


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (json.dumps({"version": 1.3, "people": []}), FLAT),
        (json.dumps({"version": 1.3, "people": [{"pose_keypoints_2d": [1, 2, 0.5]}]}), FLAT),
        (json.dumps([{"image_id": "1.jpg", "category_id": 1, "keypoints": [1, 2, 0.9]}]), FLAT),
        (json.dumps({"annotations": [{"image_id": 1, "num_keypoints": 17}]}), FLAT),
        (json.dumps({"info": {}, "images": [{"license": 1, "file_name": "a.jpg"}]}), FLAT),
        (
            "scorer,DLC,DLC,DLC\nbodyparts,nose,nose,nose\ncoords,x,y\n",
            FLAT,
        ),
        (
            "Coordinates\nversion=1\nnRows=9\nnColumns=3\ninDegrees=yes\nendheader\n",
            OPENSIM,
        ),
        ("grf\r\nversion=1\r\nnRows=9\r\nnColumns=3\r\nendheader\r\ntime\tFx\r\n", OPENSIM),
        ("name grf.mot\ndatacolumns 3\ndatarows 9\nendheader\ntime Fx Fy\n", OPENSIM),
        (
            "# times, pelvis_x, pelvis_y, pelvis_z, pelvis_rotx\n0,1\n",
            OPENSIM,
        ),
        (pickle.dumps({"smpl_poses": 1}), PICKLE),
        (pickle.dumps({"smpl_poses": 1}, protocol=2), PICKLE),
        (torch_file(), PICKLE),
        (object_array(), PICKLE),
        (zlib.compress(pickle.dumps({"smpl_poses": 1})), "a compressed pickle has to be"),
        (gzip.compress(b"HIERARCHY"), "is compressed. Unpack it"),
        (b"PK\x03\x04" + bytes(26) + b"take.bvh" + bytes(60), "is compressed. Unpack it"),
        ("<!DOCTYPE html><html><body>Sign in</body></html>", "is a web page"),
        ("\n<!-- saved -->\n<HTML lang='en'>", "is a web page"),
        (json.dumps({"frames": [{"keypoints": [[412.5, 3.1], [4, 5]]}]}), FLAT),
        ("", "is empty"),
        (" \n\n", "is empty"),
        (b"\x00\x00\x00\x18ftypmp42" + bytes(40), "Run a video model on it"),
        (b"RIFF\x24\x00\x00\x00AVI LIST" + bytes(40), "Run a video model on it"),
        (b"\x23\x00\x00\x00head\x12\x00\x00\x00ftypsony motion format", "mocopi sent"),
        (pickle.dumps({"smpl_poses": 1}, protocol=0), PICKLE),
        (pickle.dumps({"smpl_poses": 1}, protocol=1), PICKLE),
        (b"Vocaloid Motion Data 0002" + bytes(60), "with MMD Tools"),
        ('// made by hand\nversion 1\nnodes\n0 "root" -1\nend\n', "Blender Source Tools"),
        ('MD5Version 10\ncommandline ""\n', "add-on for MD5"),
        ("xof 0303txt 0032\n", "FBX or GLB, with its animation"),
        (b"INTERQUAKEMODEL\0" + bytes(60), "FBX or GLB, with its animation"),
        (
            json.dumps({
                "Version": 3,
                "Curves": [{"Target": "Parameter", "Id": "ParamAngleX"}],
            }),
            "motion of Live2D",
        ),
        ('{\n"Loop": "wrap",\n"Frames":\n[\n[ 0.033, 0, 0.84, 0]]}', "without its skeleton"),
        ("File_Type:\tAnalog R/C ASCII\tGeneration#:\t2\n", "force plates"),
        (bytes(4) + b"\xff" * 4 + b"\0\0\x40\2\1\1\1\0" + bytes(60), "Export TRC or C3D there"),
        (
            "Test Name:,One,,\nSample Rate:,128,Hz,\nTime,Arm/Acceleration/X,"
            "Arm/Acceleration/Y,Arm/Acceleration/Z\n0,1,2,3\n",
            "readings of sensors",
        ),
        (
            "// Update Rate: 100.0Hz\nPacketCounter\tAcc_X\tAcc_Y\tAcc_Z\n1\t2\t3\t4\n",
            "readings of",
        ),
        ("t,acc_x,acc_x,acc_x,b,c,d\n1,2,3,4,5,6,7\n", "unknown format"),
        (b"BLENDER17-01v0500" + bytes(60), "append the action"),
        ('//Maya ASCII 2026 scene\nrequires maya "2026";\n', "as FBX"),
        ("%YAML 1.1\n%TAG !u! tag:unity3d.com,2011:\n", "FBX Exporter"),
        ("[Header]\n# of a\n\n#b\nFileType htr\nFileVersion 1\n", "BVH, FBX or C3D"),
        (f"[Header]\n{'#' * 60}\na note on the take", "unknown format"),
        ("Joint 0: Position(265.7, -156.6, 2424.5), Orientation(", "of one frame of the Azure"),
        ("PELVIS Joint info: \n\tposition: [265.7,-156.6]\n", "of its offline_processor"),
        (b"\x89HDF\r\n\x1a\n" + bytes(60), "with numpy.save"),
        (b"PK\x03\x04" + bytes(26) + b"[Content_Types].xml" + bytes(60), "as CSV"),
        (b"PK\x03\x04" + bytes(26) + b"take.usdc" + bytes(60), "Import it in Blender"),
        (
            ",".join(f"Bone{n}_{axis}rotation" for n in range(9) for axis in "ZXY")
            + "\n"
            + ",".join(["1.5"] * 27)
            + "\n",
            "rotations of bones without their positions",
        ),
        (
            json.dumps(
                [
                    {f"bone{n}": {"localRotation": [0, 0, 0, 1]} for n in range(9)}
                    | {"hips": {"position": [0, 1, 0]}}
                ]
                * 3
            ),
            "rotations of bones without their positions",
        ),
        (
            "time,Waist_PosX,Waist_PosY,Waist_PosZ,Head_PosX,Head_PosY,Head_PosZ\n"
            + ",".join(["1.5"] * 7)
            + "\n",
            r"has too few points for a body \(2\)",
        ),
        (
            "Timecode,BlendshapeCount,EyeBlinkLeft,EyeLookDownLeft,JawOpen,MouthSmileLeft\n"
            "12:00:00:01,61,0.1,0.2,0.3,0.4\n",
            "holds values of a face",
        ),
        ("\n".join([",".join(["0.25"] * 50)] * 4), "is a table without titles"),
        (
            npz(pred_joint_coords=np.ones((3, 127, 3)), pred_cam_t=np.ones((3, 3))),
            "NumPy archive without joints of a known name .*pred_cam_t",
        ),
        (b"PAR1" + bytes(99), "Save it as CSV where it was made"),
        (b"\xcd\xf3\x00\x01" + bytes(99), "CDF file.*NumPy array"),
        (
            '{"name": "Walk", "tracks": [{"name": "Hips.position", "times": [0]}]}',
            "animation of three.js",
        ),
        (
            '{"animations": [{"tracks": [{"type": "quaternion", "name": "a.quaternion",'
            ' "times": [0, 1]}]}]}',
            "animation of three.js",
        ),
        (
            npz(keypoints=np.random.default_rng(0).uniform(0.2, 0.9, (20, 17, 3))),
            "holds 2D points of images",
        ),
        ("a note on the take", "unknown format. Export it as BVH, FBX, GLB"),
        ("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n", "git lfs pull"),
    ],
)
def test_refusal_names_a_usable_file(read_any, content, sentence):
    with pytest.raises(InvalidFileError, match=sentence):
        read_any(content)


@pytest.mark.parametrize(
    "file",
    [
        "pose2sim/Demo_MultiPerson_P1_0-100_filt_butterworth.csv",
        "pose2sim/BalancingTrial_LSTM.mot",
        "openpose_json/cam01.0000.json",
    ],
)
def test_files_of_labs_are_refused_with_what_would_serve(recordings, read_any, file):
    content = (recordings / "corpus/lab" / file).read_bytes()

    with pytest.raises(InvalidFileError, match=r"Import the (TRC of|triangulated)"):
        read_any(content)


def test_an_array_of_numbers_is_no_pickle(read_any):
    buffer = io.BytesIO()
    np.save(buffer, np.ones((4, 5, 3)))

    assert read_any(buffer.getvalue()).n_frames == 4


def test_the_arrays_that_a_pickle_should_be_saved_as_are_read(read_any):
    with pytest.raises(InvalidFileError) as refused:
        read_any(pickle.dumps({"smpl_poses": 1}))
    names = re.findall(r"(\w+)=\.\.\.", str(refused.value))
    widths = {"global_orient": 3, "body_pose": 69, "transl": 3}
    buffer = io.BytesIO()
    np.savez(buffer, **{name: np.full((4, widths[name]), 0.1) for name in names})

    assert set(names) == set(widths)
    assert read_any(buffer.getvalue()).n_frames == 4
