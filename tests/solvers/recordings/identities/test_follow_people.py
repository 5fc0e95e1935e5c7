"""People keep their identities where a tracker swaps them, and only there."""

import numpy as np
import pytest
from exports.swapped_people import RATE_HZ, line, observed, person

from solvers.recordings.identities.follow_people import follow_people

N = 90
TIMES = np.arange(N) / RATE_HZ
AS_THEY_ARE = {"anna": "1", "ben": "2"}
SWAPPED = {"anna": "2", "ben": "1"}


def two_people(distance=1.7, heading=0.0):
    return {
        "anna": person(line((-distance / 2, 0.0), (-distance / 2, 0.8), N), 0.0, 1),
        "ben": person(line((distance / 2, 0.5), (distance / 2, 0.0), N), heading, 2),
    }


def names_found(people, identities, times=TIMES):
    """Return who has each identity in each frame, once followed, and the result."""
    followed = follow_people(observed(people, identities), times)
    found = [
        {persons[identity]: name for name, identity in given.items()}
        for given, persons in zip(identities, followed.persons, strict=True)
    ]
    return found, followed


def assert_right(found, names=("anna", "ben", "cleo")):
    """Each person has one identity in all frames."""
    for name in names:
        held = {
            key for frame in found for key, found_name in frame.items() if found_name == name
        }
        assert len(held) <= 1, (name, held)


def test_positions_of_a_swap_are_those_of_the_other_person():
    """By hand: two points apart by 4 m, which change indices from frame 5 on."""
    square = np.array([[0.0, 0, 0], [1.6, 0, 0], [0, 1.6, 0]])
    one, other = square + 1.0, square + np.array([5.0, 1.0, 1.0])
    frames = [{"a": one, "b": other}] * 5 + [{"a": other, "b": one}] * 5

    followed = follow_people(frames, np.arange(10) / 10.0)

    assert followed.persons == [{"a": "a", "b": "b"}] * 5 + [{"a": "b", "b": "a"}] * 5
    assert followed.switch_times == [0.5] and followed.found_again == []


@pytest.mark.parametrize("unit", [1.0, 1e3, 39.37])
def test_a_swap_is_undone_in_any_unit(unit):
    people = {name: unit * joints for name, joints in two_people().items()}

    found, followed = names_found(people, [AS_THEY_ARE] * 40 + [SWAPPED] * 50)

    assert_right(found)
    assert followed.switch_times == [pytest.approx(40 / RATE_HZ)]


def test_two_swaps_are_undone():
    given = [AS_THEY_ARE] * 30 + [SWAPPED] * 20 + [AS_THEY_ARE] * 40

    found, followed = names_found(two_people(), given)

    assert_right(found)
    assert followed.switch_times == pytest.approx([30 / RATE_HZ, 50 / RATE_HZ])


def test_a_swap_of_people_face_to_face_shows_in_their_joints():
    """Hips are 0.3 m from each other, and joints farther."""
    found, _ = names_found(two_people(0.3, np.pi), [AS_THEY_ARE] * 40 + [SWAPPED] * 50)

    assert_right(found)


@pytest.mark.parametrize("speed", [1.0, 3.0, 8.0])
@pytest.mark.parametrize("offset", [0.0, 0.1, 0.6])
def test_people_who_cross_are_not_swapped(speed, offset):
    reach = speed * N / RATE_HZ / 2.0
    people = {
        "anna": person(line((-reach, 0.0), (reach, 0.0), N), np.pi / 2, 1),
        "ben": person(line((reach, offset), (-reach, offset), N), -np.pi / 2, 2),
    }

    found, followed = names_found(people, [AS_THEY_ARE] * N)

    assert not followed.is_changed and found[0] == found[-1] == {"1": "anna", "2": "ben"}


@pytest.mark.parametrize("offset", [0.0, 0.1, 0.4])
def test_people_who_cross_in_a_file_of_few_frames_are_not_swapped(offset):
    """At 5 Hz runners pass each other between two frames."""
    people = {
        "anna": person(line((-5.0, 0.0), (5.0, 0.0), 12), np.pi / 2, 1),
        "ben": person(line((5.0, offset), (-5.0, offset), 12), -np.pi / 2, 2),
    }

    _, followed = names_found(people, [AS_THEY_ARE] * 12, np.arange(12) / 5.0)

    assert not followed.is_changed


def test_a_swap_while_people_cross_is_undone():
    people = {
        "anna": person(line((-1.5, 0.0), (1.5, 0.0), N), np.pi / 2, 1),
        "ben": person(line((1.5, 0.5), (-1.5, 0.5), N), -np.pi / 2, 2),
    }

    found, _ = names_found(people, [AS_THEY_ARE] * 45 + [SWAPPED] * 45)

    assert_right(found)


def test_three_people_rotate_their_identities():
    people = two_people() | {"cleo": person(line((0.0, 2.5), (0.3, 2.0), N), 1.0, 3)}
    first = {"anna": "1", "ben": "2", "cleo": "3"}
    then = {"anna": "2", "ben": "3", "cleo": "1"}

    found, followed = names_found(people, [first] * 40 + [then] * 50)

    assert_right(found)
    assert len(followed.switch_times) == 1


def test_the_third_person_keeps_the_identity_while_two_are_swapped():
    people = two_people() | {"cleo": person(line((0.0, 2.5), (0.3, 2.0), N), 1.0, 3)}
    first = AS_THEY_ARE | {"cleo": "3"}

    found, _ = names_found(people, [first] * 40 + [SWAPPED | {"cleo": "3"}] * 50)

    assert_right(found)
    assert all(frame["3"] == "cleo" for frame in found)


@pytest.mark.parametrize("absent", [1, 10, 60])
def test_a_list_closes_up_while_someone_is_missing(absent):
    """The second place becomes the first one, and back."""
    indices = {"anna": "0", "ben": "1"}
    alone = {"ben": "0"}
    given = [indices] * 20 + [alone] * absent + [indices] * (N - 20 - absent)

    found, followed = names_found(two_people(), given)

    assert_right(found)
    assert len(followed.switch_times) == 2


def test_a_person_who_enters_first_in_the_list_is_new():
    given = [{"ben": "0"}] * 30 + [{"anna": "0", "ben": "1"}] * 60

    found, _ = names_found(two_people(), given)

    assert_right(found)
    assert found[0] == {"0": "ben"} and found[-1] == {"1": "anna", "0": "ben"}


def test_a_list_is_as_in_the_file_after_an_uncertain_gap():
    """Ben alone is the first one; where Anna comes back, the file's order is the best guess."""
    both, ben = {"anna": "0", "ben": "1"}, {"ben": "0"}
    given = [both] * 20 + [{}] * 25 + [ben] * 15 + [both] * 30

    found, _ = names_found(two_people(0.8), given)

    assert found[0] == found[-1] == {"0": "anna", "1": "ben"}


def test_close_people_in_a_list_are_as_in_the_file_when_both_are_back():
    """Ben is followed to the first place; Anna comes back closer to him than people jump."""
    both, ben = {"anna": "0", "ben": "1"}, {"ben": "0"}
    people = {
        "anna": person(line((-0.6, 0.0), (-0.1, 0.0), N), 0.0, 1),
        "ben": person(line((0.6, 0.0), (0.1, 0.0), N), 0.0, 2),
    }

    found, _ = names_found(people, [both] * 20 + [ben] * 62 + [both] * 8)

    assert found[30] == {"1": "ben"}
    assert found[-1] == {"0": "anna", "1": "ben"}


@pytest.mark.parametrize("distance", [0.2, 0.6, 1.7])
def test_right_identities_stay_with_any_gaps(distance, rng):
    gaps = rng.random((2, N // 5)) < 0.4
    given = [
        {who: key for (who, key), is_gap in zip(AS_THEY_ARE.items(), gaps[:, at], strict=True)
         if not is_gap}
        for at in range(N // 5) for _ in range(5)
    ]  # fmt: skip

    _, followed = names_found(two_people(distance), given)

    assert not followed.is_changed


def test_people_swapped_while_both_are_missing_are_swapped_back():
    given = [AS_THEY_ARE] * 30 + [{}] * 10 + [SWAPPED] * 50

    found, _ = names_found(two_people(), given)

    assert_right(found)


def test_people_who_were_away_for_long_keep_what_the_tracker_says():
    given = [AS_THEY_ARE] * 20 + [{}] * 40 + [SWAPPED] * 30

    _, followed = names_found(two_people(), given)

    assert not followed.is_changed


@pytest.mark.parametrize("absent", [0, 3, 20])
def test_a_new_number_is_the_person_who_was_lost_there(absent):
    given = [AS_THEY_ARE] * 30 + [{"ben": "2"}] * absent
    given += [{"anna": "3", "ben": "2"}] * (N - len(given))

    found, followed = names_found(two_people(), given)

    assert_right(found)
    ((person_, new, time),) = followed.found_again
    assert (person_, new, time) == ("1", "3", pytest.approx((30 + absent) / RATE_HZ))
    assert followed.switch_times == []


def test_a_new_number_is_new_if_two_people_could_be_it():
    people = two_people(0.6) | {"cleo": person(line((0.0, 0.3), (0.0, 0.9), N), 0.0, 3)}
    given = [AS_THEY_ARE] * 30 + [{}] * 5 + [{"cleo": "3"}] * 55

    _, followed = names_found(people, given)

    assert not followed.is_changed


def test_a_new_number_is_new_if_the_old_one_is_seen_with_it():
    """Cleo comes out from behind Anna, who is hidden for a moment."""
    people = two_people() | {"cleo": person(line((-0.8, 0.5), (-0.6, 1.5), N), 0.0, 3)}
    given = [AS_THEY_ARE] * 30 + [{"ben": "2"}] * 2 + [{"ben": "2", "cleo": "3"}] * 8
    given += [AS_THEY_ARE | {"cleo": "3"}] * (N - len(given))

    _, followed = names_found(people, given)

    assert not followed.is_changed


def test_a_name_is_not_another_person():
    given = [{"anna": "Anna", "ben": "Ben"}] * 30 + [{"anna": "Cleo", "ben": "Ben"}] * 60

    _, followed = names_found(two_people(), given)

    assert not followed.is_changed


def test_a_person_who_comes_in_elsewhere_is_new():
    given = [AS_THEY_ARE] * 30 + [{"ben": "2"}] * 3 + [{"ben": "2", "cleo": "3"}] * 57
    people = two_people() | {"cleo": person(line((0.0, 2.5), (0.3, 2.0), N), 1.0, 3)}

    _, followed = names_found(people, given)

    assert not followed.is_changed


def test_people_relative_to_their_own_hips_are_not_followed():
    still = np.zeros((N, 2))
    people = {"anna": person(still, 0.0, 1), "ben": person(still, np.pi, 2)}

    _, followed = names_found(people, [AS_THEY_ARE] * 40 + [SWAPPED] * 50)

    assert not followed.is_changed


def test_one_jump_is_no_swap():
    """A tracker that finds Anna in a chair for three frames has not swapped her."""
    people = two_people()
    people["anna"][40:43] += (0.9, 0.0, 0.0)
    people["ben"][60, :5] += 3.0

    _, followed = names_found(people, [AS_THEY_ARE] * N)

    assert not followed.is_changed


def test_joints_at_the_origin_are_missing():
    people = two_people()
    people["anna"][20:60, 7:12] = 0.0
    people["ben"][30:50] = 0.0

    found, followed = names_found(people, [AS_THEY_ARE] * 70 + [SWAPPED] * 20)

    assert_right(found)
    assert len(followed.switch_times) == 1


@pytest.mark.parametrize("n_frames", [0, 1])
def test_hardly_any_frames(n_frames):
    frames = observed(two_people(), [AS_THEY_ARE] * n_frames)
    followed = follow_people(frames, TIMES[:n_frames])

    assert followed.persons == [{"1": "1", "2": "2"}] * n_frames
