"""Contact keys: what was detected is detected again, and what was edited stays."""

import hashlib

import numpy as np
import pytest


def contact_curve(action):
    bag = action.layers[0].strips[0].channelbag(action.slots[0])
    return bag.fcurves.find('["mocap_contact_left"]', index=0)


def frames_of(action):
    return np.arange(1.0, action.frame_range[1] + 1.0)


def move(curve, index, frame):
    """Move a key, as in the Dope Sheet."""
    curve.keyframe_points[index].co.x = frame
    curve.update()


def test_edited_key_holds_and_all_others_are_detected_again(walker, clean, load):
    contacts = load("mocap_assist.actions.contact_keys")
    result = clean(plant_feet=True)
    frames, source = frames_of(result), (result, result.slots[0])
    keys = contact_curve(result).keyframe_points
    assert len(keys) > 4 and {key.type for key in keys} == {"GENERATED"}
    assert contacts.animators_contacts(source, frames) is None
    assert contacts.read_contacts(*source, frames).any()

    second = clean(plant_feet=True)
    assert contacts.animators_contacts((second, second.slots[0]), frames) is None
    curve = contact_curve(second)
    start, stop, after = (round(curve.keyframe_points[index].co.x) for index in (2, 3, 4))
    held = curve.keyframe_points[2].co.y
    move(curve, 3, stop + 4)
    mine = contacts.animators_contacts((second, second.slots[0]), frames)
    expected = np.full((len(frames), 7), np.nan)
    expected[start - 1 : stop + 3, 0], expected[stop + 3 : after - 1, 0] = held, 1.0 - held
    np.testing.assert_array_equal(mine, expected)

    third = clean(plant_feet=True)
    source = third, third.slots[0]
    np.testing.assert_array_equal(contacts.animators_contacts(source, frames), expected)
    is_mine, written = np.isfinite(mine[:, 0]), contacts.read_contacts(*source, frames)
    assert (written[is_mine, 0] == mine[is_mine, 0]).all()
    types = {round(key.co.x): key.type for key in contact_curve(third).keyframe_points}
    assert types[start] == types[stop + 4] == "KEYFRAME"
    assert types[1] == types[after] == "GENERATED"


def test_contacts_that_were_detected_before_hips_had_keys_are_detected_again(walker, load):
    contacts = load("mocap_assist.actions.contact_keys")
    action, frames = walker.animation_data.action, np.arange(1.0, 31.0)
    source = (action, action.slots[0])
    found = np.zeros((30, 7), bool)
    found[:10, 0] = found[5:20, 2] = True
    contacts.write_contacts(walker, *source, frames, found, detected=True)
    bag = action.layers[0].strips[0].channelbag(action.slots[0])
    bag.fcurves.remove(bag.fcurves.find('["mocap_contact_hips"]', index=0))
    feet_hands_knees = [each.ravel().tolist() for each in contacts.contact_keys(*source)][:6]
    former = hashlib.sha256(repr(feet_hands_knees).encode()).hexdigest()
    action["mocap_assist_detected_contacts"] = former

    assert contacts.animators_contacts(source, frames) is None


@pytest.fixture
def planted(walker, blank):
    """The walk as Plant Feet wrote it."""
    assert blank.ops.mocap_assist.plant_feet() == {"FINISHED"}
    return walker.animation_data.action


def all_curves(action):
    return list(action.layers[0].strips[0].channelbag(action.slots[0]).fcurves)


def test_shifted_action_keeps_what_was_detected_and_what_was_edited(planted, load, blank):
    contacts = load("mocap_assist.actions.contact_keys")
    frames, source = frames_of(planted), (planted, planted.slots[0])
    move(contact_curve(planted), 1, contact_curve(planted).keyframe_points[1].co.x + 2)
    mine = contacts.animators_contacts(source, frames)

    for curve in all_curves(planted):
        for key in curve.keyframe_points:
            key.co.x += 100.0
        curve.update()

    np.testing.assert_array_equal(contacts.animators_contacts(source, frames + 100.0), mine)


def test_all_contact_keys_moved_without_the_motion_are_edited(planted, load):
    contacts = load("mocap_assist.actions.contact_keys")
    frames, source = frames_of(planted), (planted, planted.slots[0])

    for key in contact_curve(planted).keyframe_points:
        key.co.x += 2.0
    contact_curve(planted).update()

    mine = contacts.animators_contacts(source, frames)
    assert np.isfinite(mine[2:, 0]).all() and np.isnan(mine[:, 1]).all()


@pytest.mark.parametrize("keeps_range", [(21, 90), (1, 70), (30, 60)])
def test_trimmed_action_is_detected_again(planted, load, keeps_range):
    contacts = load("mocap_assist.actions.contact_keys")
    first, last = keeps_range

    for curve in all_curves(planted):
        for key in reversed(list(curve.keyframe_points)):
            if not first <= key.co.x <= last:
                curve.keyframe_points.remove(key)
        curve.update()

    trimmed = np.arange(first, last + 1.0)
    assert contacts.animators_contacts((planted, planted.slots[0]), trimmed) is None


def test_edited_contact_holds_in_a_trimmed_action(planted, load, blank, walker):
    contacts = load("mocap_assist.actions.contact_keys")
    curve = contact_curve(planted)
    move(curve, 2, curve.keyframe_points[2].co.x + 2)
    start, stop = (round(curve.keyframe_points[index].co.x) for index in (2, 3))
    for each in all_curves(planted):
        for key in reversed(list(each.keyframe_points)):
            if key.co.x < start:
                each.keyframe_points.remove(key)
        each.update()
    frames = np.arange(float(start), planted.frame_range[1] + 1.0)

    assert blank.ops.mocap_assist.plant_feet() == {"FINISHED"}

    result = walker.animation_data.action
    mine = contacts.animators_contacts((result, result.slots[0]), frames)
    assert np.isfinite(mine[: stop - start, 0]).all()
    assert np.isnan(mine[stop - start :]).all() and np.isnan(mine[:, 1]).all()


def test_deleted_contact_stays_deleted(planted, load, blank, walker):
    contacts = load("mocap_assist.actions.contact_keys")
    frames, curve = frames_of(planted), contact_curve(planted)
    index = next(i for i, key in enumerate(curve.keyframe_points) if i and key.co.y == 1.0)
    start, stop = (round(curve.keyframe_points[index + each].co.x) for each in (0, 1))
    for each in (index + 1, index):
        curve.keyframe_points.remove(curve.keyframe_points[each])
    curve.update()

    blank.ops.mocap_assist.plant_feet()

    result = walker.animation_data.action
    found = contacts.read_contacts(result, result.slots[0], frames)
    assert not found[start - 1 : stop - 1, 0].any() and found[:, 0].any()
    mine = contacts.animators_contacts((result, result.slots[0]), frames)
    assert np.isnan(mine[:, 1]).all()


def test_part_without_keys_is_detected_again(planted, load):
    contacts = load("mocap_assist.actions.contact_keys")
    move(contact_curve(planted), 1, contact_curve(planted).keyframe_points[1].co.x + 2)
    bag = planted.layers[0].strips[0].channelbag(planted.slots[0])
    bag.fcurves.remove(contact_curve(planted))

    assert contacts.animators_contacts((planted, planted.slots[0]), frames_of(planted)) is None


def test_key_that_confirms_a_contact_makes_it_the_animators(planted, load, walker):
    contacts = load("mocap_assist.actions.contact_keys")
    curve = contact_curve(planted)
    index = next(i for i, key in enumerate(curve.keyframe_points) if i and key.co.y == 1.0)
    start, stop = (round(curve.keyframe_points[index + each].co.x) for each in (0, 1))
    walker["mocap_contact_left"] = 1
    walker.keyframe_insert('["mocap_contact_left"]', frame=(start + stop) // 2)

    mine = contacts.animators_contacts((planted, planted.slots[0]), frames_of(planted))

    assert np.flatnonzero(np.isfinite(mine[:, 0])).tolist() == [*range(start - 1, stop - 1)]
    assert (mine[start - 1 : stop - 1, 0] == 1.0).all()


def test_undo_takes_back_an_edit(planted, load, blank, walker):
    contacts = load("mocap_assist.actions.contact_keys")
    frames, name = frames_of(planted), walker.name
    blank.ops.ed.undo_push(message="Planted")
    curve = contact_curve(planted)
    move(curve, 1, curve.keyframe_points[1].co.x + 2)
    blank.ops.ed.undo_push(message="Moved a key")
    blank.ops.mocap_assist.plant_feet()
    blank.ops.ed.undo_push(message="Planted again")

    def mine():
        data = blank.data.objects[name].animation_data
        return contacts.animators_contacts((data.action, data.action_slot), frames)

    edited = mine()
    assert edited is not None
    blank.ops.ed.undo()  # the second press
    np.testing.assert_array_equal(mine(), edited)
    blank.ops.ed.undo()  # the edit

    assert mine() is None


def test_file_keeps_which_contacts_were_edited(planted, load, blank, walker, tmp_path):
    contacts = load("mocap_assist.actions.contact_keys")
    frames, name = frames_of(planted), walker.name
    move(contact_curve(planted), 1, contact_curve(planted).keyframe_points[1].co.x + 2)
    mine = contacts.animators_contacts((planted, planted.slots[0]), frames)
    blank.ops.wm.save_as_mainfile(filepath=str(tmp_path / "shot.blend"))
    blank.ops.wm.open_mainfile(filepath=str(tmp_path / "shot.blend"))

    data = blank.data.objects[name].animation_data
    again = contacts.animators_contacts((data.action, data.action_slot), frames)

    np.testing.assert_array_equal(again, mine)


@pytest.mark.parametrize(
    "damaged",
    [None, 7, "", "{", "[]", '{"1": 3}', '{"HANDLE": [3]}', '{"HANDLE": {"range": "x"}}',
     '{"HANDLE": {"mocap_contact_left": [[1], ["a", 2, 3], 4]}}', "0" * 64],
)  # fmt: skip
def test_without_stored_detection_all_contacts_are_the_animators(planted, load, damaged):
    """As in files of earlier versions whose keys were edited, or a damaged property."""
    contacts = load("mocap_assist.actions.contact_keys")
    detected = load("mocap_assist.actions.detected_contacts").DETECTED
    frames, slot = frames_of(planted), planted.slots[0]
    if isinstance(damaged, str):
        damaged = damaged.replace("HANDLE", str(slot.handle))
    if damaged is None:
        del planted[detected]
    else:
        planted[detected] = damaged

    mine = contacts.animators_contacts((planted, slot), frames)

    keyed = contacts.read_contacts(planted, slot, frames)
    assert keyed.any() and (mine[:, :2] == keyed[:, :2]).all()
