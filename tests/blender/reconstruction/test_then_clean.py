"""Clean after Reconstruct cleans what was reconstructed, however often it is pressed."""

import numpy as np
import pytest
from kinect_walks import OCCLUDED_FRAMES


@pytest.fixture
def elbows(load, blank):
    """Positions of the left elbow and wrist in an action while they are occluded."""

    def arm_positions(armature, action):
        read = load("mocap_assist.actions.armature_read").read_take
        take = read(armature, blank.context.scene, source=(action, action.slots[0]))
        motion = take.parts[0].motion
        found = load("solvers.motion.skeletons.kinematics").forward_kinematics(motion).positions
        return found[OCCLUDED_FRAMES][
            :, [motion.skeleton.index(n) for n in ("ElbowLeft", "WristLeft")]
        ]

    return arm_positions


def off(one, other):
    return float(np.nanmean(np.linalg.norm(one - other, axis=-1)))


def test_clean_starts_from_the_reconstruction(walk, reconstruct, blank, elbows, load):
    history = load("mocap_assist.scene.history")
    raw = walk.animation_data.action
    rebuilt = reconstruct()
    for _ in range(2):
        assert blank.ops.mocap_assist.denoise(plant_feet=False) == {"FINISHED"}
        cleaned = walk.animation_data.action
        assert cleaned not in {raw, rebuilt}
        assert off(elbows(walk, cleaned), elbows(walk, rebuilt)) < 0.02
        assert off(elbows(walk, cleaned), elbows(walk, raw)) > 0.05
    assert history.history(cleaned)[0]["operation"] == "reconstruct"
    assert blank.ops.mocap_assist.revert_to_raw() == {"FINISHED"}
    assert walk.animation_data.action == raw


def test_clean_starts_from_the_recording_without_the_reconstruction(
    walk, reconstruct, blank, load
):
    rebuilt = reconstruct()
    blank.ops.mocap_assist.denoise(plant_feet=False)
    blank.data.actions.remove(rebuilt)
    played = load("mocap_assist.runtime.selection").played_source(walk)
    history = load("mocap_assist.scene.history")
    assert history.cleaned_from(played) == history.raw_of(played[0])
