"""What an action of a stranger has curves for is put back as it was, or left."""

import pytest

PATHS = (
    '["group"]', '["list"]', '["pointer"]', "data", 'pose.bones["Hips"]',
    "animation_data.action", 'pose.bones["',
)  # fmt: skip


@pytest.mark.parametrize("path", PATHS)
def test_curve_of_what_has_no_number_changes_nothing(actor, load, path):
    actor["group"], actor["list"], actor["pointer"] = {"a": 1}, [{"a": 2}], actor.data
    (bag,) = actor.animation_data.action.layers[0].strips[0].channelbags
    bag.fcurves.new(path, index=0).keyframe_points.insert(1, 1.0)

    with load("mocap_assist.rigs.animated_values").values_kept(actor):
        pass

    assert actor["group"].to_dict() == {"a": 1}
    assert [each.to_dict() for each in actor["list"]] == [{"a": 2}]
    assert actor["pointer"] == actor.data


def test_numbers_and_choices_are_put_back(actor, load):
    actor["number"], actor["array"] = 3, [1.0, 2.0]
    (bag,) = actor.animation_data.action.layers[0].strips[0].channelbags
    for path in ('["number"]', '["array"]', "location", "rotation_mode", "hide_viewport"):
        bag.fcurves.new(path, index=0).keyframe_points.insert(1, 1.0)

    with load("mocap_assist.rigs.animated_values").values_kept(actor):
        actor["number"], actor["array"], actor.location = 7, [0.0, 0.0], (5.0, 5.0, 5.0)
        actor.rotation_mode, actor.hide_viewport = "QUATERNION", True
        actor.animation_data.action = None

    assert (actor["number"], [*actor["array"]]) == (3, [1.0, 2.0])
    assert tuple(actor.location) == (0.0, 0.0, 0.0)
    assert (actor.rotation_mode, actor.hide_viewport) == ("XYZ", False)
