"""Files that move joints below the root, too: rigid bones say it as well as they can."""

from numpy.testing import assert_allclose

from solvers.motion import forward_kinematics

SIX = "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"
ARM = f"""HIERARCHY
ROOT shoulder
{{
  OFFSET 0 140 0
  {SIX}
  JOINT elbow
  {{
    OFFSET 30 0 0
    {SIX}
    End Site
    {{
      OFFSET 25 0 0
    }}
  }}
}}
MOTION
Frame Time: 0.01
"""
LEGS = f"""HIERARCHY
ROOT hips
{{
  OFFSET 0 90 0
  {SIX}
  JOINT knee
  {{
    OFFSET 0 -45 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    JOINT foot
    {{
      OFFSET 0 -40 0
      {SIX}
      End Site
      {{
        OFFSET 15 0 0
      }}
    }}
  }}
  JOINT other
  {{
    OFFSET 10 0 0
    CHANNELS 1 Zrotation
  }}
}}
MOTION
Frame Time: 0.01
"""


def test_position_channels_replace_the_offset(read):
    """So it is in Blender. Of a bone whose length changes, the median counts."""
    frame = "0 140 0  0 0 0   {} 0 0  0 0 0\n"

    arm = read(ARM + "".join(frame.format(length) for length in (33, 33, 34)))

    elbow = forward_kinematics(arm).positions[0, 1]
    assert_allclose(elbow, [0.33, 0, 1.4], atol=1e-9)


def test_positions_of_an_only_child_move_the_root(read):
    """Some exporters put a fixed `reference` above the hips, and move those."""
    frame = "0 140 0  90 0 0   {}  0 0 0\n"

    arm = read(ARM + "".join(map(frame.format, ["30 0 0", "30 500 7", "30 1000 9"])))

    # By hand: Rz(90) takes (30, 500, 7) to (-500, 30, 7).
    elbow = forward_kinematics(arm).positions[:, 1]
    assert_allclose(elbow, [[0, 0, 1.7], [-5, -0.07, 1.7], [-10, -0.09, 1.7]], atol=1e-9)


def test_bone_rotates_towards_its_displaced_child(read):
    """Perception Neuron moves feet about the end of the shank; our shank follows."""
    frame = "0 90 0  0 0 0   0 0 0   {}  0 0 0   0\n"

    legs = read(LEGS + "".join(map(frame.format, ["0 -40 0", "24 -32 0", "0 -40 0"])))

    indices = dict(zip(legs.skeleton.names, forward_kinematics(legs).positions[1], strict=True))
    assert_allclose(indices["foot"] - indices["knee"], [0.24, 0, -0.32], atol=1e-9)
    # The foot itself does not turn.
    assert_allclose(indices["foot_end"] - indices["foot"], [0.15, 0, 0], atol=1e-9)


def test_channels_near_zero_are_relative_to_the_offset(read):
    """If they stood for places, the skeleton would shrink to a point."""
    arm = read(ARM + "0 1 0  0 0 0   1 0 0  0 0 0\n")

    positions = forward_kinematics(arm).positions
    assert_allclose(positions[0, :2], [[0, 0, 1.41], [0.31, 0, 1.41]], atol=1e-9)
