"""A foreign take, from the file to a Rigify rig: upright, cleaned, on the right limbs."""

import numpy as np
import pytest

pytestmark = pytest.mark.timeout(900)
MAX_ANGLE_DEG = 15.0
"""Mean angle between bones of source and rig in world space; a wrong bone is off by 30 or more.
Rigs keep the rest angle of spine and feet, and hands are placed by length."""
FOOT = ("foot", "toe")
MAX_FOOT_HEIGHT_M = 0.12
"""Height of the lowest joint of the rig's feet in the frame in which it is lowest."""
LIMBS = {
    "UpperArm": ("LowerArm", "upper_arm", "forearm"), "LowerArm": ("Hand", "forearm", "hand"),
    "UpperLeg": ("LowerLeg", "thigh", "shin"), "LowerLeg": ("Foot", "shin", "foot"),
}  # fmt: skip


@pytest.fixture
def smplx(tmp_path):
    """A body that bows and bends a knee, as AMASS stores it: Z up, 60 Hz."""
    n_frames = 60
    progress = np.linspace(0.0, 1.0, n_frames)
    poses = np.zeros((n_frames, 55, 3))
    poses[:, 0, 0] = np.pi / 2
    poses[:, 3, 0] = 0.5 * progress
    poses[:, 6, 0] = 0.5 * progress
    poses[:, 1, 0] = -0.6 * progress
    poses[:, 4, 0] = 1.0 * progress
    poses[:, 16, 2] = -1.0
    poses[:, 17, 2] = 1.0
    path = tmp_path / "bow.npz"
    np.savez(
        path, poses=poses.reshape(n_frames, -1), trans=np.tile((0.0, 0.0, 0.9), (n_frames, 1)),
        mocap_frame_rate=60.0, gender=np.array(b"neutral"), surface_model_type="smplx",
    )  # fmt: skip
    return path


@pytest.fixture
def take(request, recordings, smplx):
    corpus = recordings / "corpus"
    return {
        "Bandai-Namco": corpus / "bvh/bandai_namco/dataset-1_bow_active_001.bvh",
        "Mixamo FBX": corpus / "fbx/mixamo_web/Walking.fbx",
        "Mixamo GLB": corpus / "glb/mixamo_blender/walking.glb",
        "SMPL-X": smplx,
    }[request.param]


@pytest.mark.parametrize(
    "take", ["Bandai-Namco", "Mixamo FBX", "Mixamo GLB", "SMPL-X"], indirect=True
)
def test_retargeted_rig_follows_the_take(take, blank, hero, give, poses, load):
    blank.ops.mocap_assist.import_recording(filepath=str(take))
    source = blank.context.object
    assert source.type == "ARMATURE"
    recorded = source.animation_data.action
    assert blank.ops.mocap_assist.denoise() == {"FINISHED"}
    assert source.animation_data.action != recorded

    give(source, hero)

    names = [bone.name for bone in source.data.bones]
    parents = [
        names.index(bone.parent.name) if bone.parent else -1 for bone in source.data.bones
    ]
    motion = load("solvers.motion")
    heads = np.array([bone.head_local for bone in source.data.bones])
    offsets = heads - np.where(np.array(parents)[:, None] >= 0, heads[parents], 0.0)
    roles = motion.find_humanoid_map(motion.Skeleton(tuple(names), tuple(parents), offsets))
    last = int(source.animation_data.action.frame_range[1])
    frames = range(1, last + 1, max(1, last // 12))
    theirs, ours = poses(source, frames), poses(hero, frames)
    for side, letter in (("left", "L"), ("right", "R")):
        for role, (end, upper, lower) in LIMBS.items():
            limb = direction(theirs, roles.joint(side + role), roles.joint(side + end))
            bone = direction(ours, f"DEF-{upper}.{letter}", f"DEF-{lower}.{letter}")
            angle = np.degrees(np.arccos(np.clip((limb * bone).sum(axis=1), -1.0, 1.0)))
            assert angle.mean() < MAX_ANGLE_DEG, (side + role, angle.mean())
    trunk = direction(theirs, roles.joint("hips"), roles.joint("neck"))
    spine = direction(ours, "DEF-spine", "DEF-spine.004")
    angle = np.degrees(np.arccos(np.clip((trunk * spine).sum(axis=1), -1.0, 1.0)))
    assert angle.mean() < MAX_ANGLE_DEG, angle.mean()
    assert np.median(trunk[0, 2]) > 0.8  # it stands
    lowest = min(ours[f"DEF-{part}.{side}"][:, 2, 3].min() for part in FOOT for side in "LR")
    assert -0.05 < lowest < MAX_FOOT_HEIGHT_M, lowest


def direction(found, start, end):
    """Return unit vectors between the heads of two bones, shape (n_frames, 3)."""
    vectors = found[end][:, :3, 3] - found[start][:, :3, 3]
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
