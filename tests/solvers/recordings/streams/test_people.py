"""Two people in one stream keep their numbers, whatever the tracker calls them."""

from dataclasses import replace

import numpy as np
import pytest

from solvers.recordings.streams import MAX_PEOPLE, LiveFrame, StreamReader, encode_frame
from solvers.recordings.streams.frames.people import StreamPeople

NAMES, RATE = ("Head", "HipCenter"), 30.0


def body(identity, time, x):
    return LiveFrame(
        time, identity, NAMES, np.array([(x, 0.0, 1.7), (x, 0.0, 1.0)]), np.ones(2)
    )


def walk(n_frames=60, identities=lambda frame: (7, 9)):
    """One person walks along x, another one stands three meters away; frame by frame."""
    for frame in range(n_frames):
        first, second = identities(frame)
        yield body(first, frame / RATE, 0.02 * frame)
        yield body(second, frame / RATE, 3.0)


def followed(frames, chosen=0):
    reader = StreamReader(chosen=chosen)
    came = [each for frame in frames for each in reader.read(encode_frame(frame))]
    return reader, came


@pytest.mark.parametrize(("chosen", "identity"), [(0, 7), (1, 7), (2, 9)])
def test_the_chosen_person_is_followed(chosen, identity):
    reader, came = followed(walk(), chosen)

    assert len(came) == 60 and {frame.body for frame in came} == {identity}
    assert (reader.n_people, reader.followed) == (2, chosen or 1)
    assert reader.counts.others == 60


def test_switched_identities_change_nothing():
    _, true = followed(walk(), 1)

    _, came = followed(walk(identities=lambda frame: (9, 7) if 20 <= frame < 40 else (7, 9)), 1)

    assert [frame.body for frame in came] == [7] * 60
    assert all(
        np.array_equal(a.positions, b.positions) for a, b in zip(came, true, strict=True)
    )


def test_a_jump_to_where_no_one_was_is_no_identity_switch():
    jumped = [
        replace(each, positions=each.positions + np.array((0.0, -1.5, 0.0)))
        if each.body == 7 and each.time > 1.0
        else each
        for each in walk()
    ]

    _, came = followed(jumped, 1)

    assert [frame.body for frame in came] == [7] * 60


def test_who_was_lost_for_a_moment_is_found_again():
    frames = [each for each in walk() if not (each.body == 7 and 0.5 < each.time < 0.8)]
    renamed = [
        replace(each, body=12) if each.body == 7 and each.time > 0.7 else each
        for each in frames
    ]

    _, came = followed(renamed, 1)

    assert {frame.body for frame in came} == {7} and came[-1].time == pytest.approx(59 / RATE)


def test_a_number_is_free_after_a_second():
    people = StreamPeople()
    assert people.add(body(7, 0.0, 0.0)).number == 1
    assert people.add(body(9, 0.0, 3.0)).number == 2
    assert people.add(body(9, 1.5, 3.0)).number == 1
    assert people.n_present == 1


def test_without_the_chosen_person_nothing_comes():
    reader, came = followed(walk(), 3)
    assert came == [] and (reader.n_people, reader.followed) == (2, 3)


def test_the_others_keep_their_numbers_when_the_chosen_person_leaves():
    frames = [each for each in walk(90) if each.body == 9 or each.time < 1.0]
    readers = [
        followed([each for each in frames if each.time < end], 1)[0] for end in (1.0, 3.0)
    ]
    assert [reader.is_present for reader in readers] == [True, False]

    reader, came = followed(frames, 2)
    assert (reader.n_people, reader.is_present, len(came)) == (1, True, 90)


def test_the_actor_is_followed_next_to_a_place_that_stays_empty():
    empty = body(0, 0.0, np.nan)
    slots = [(replace(empty, time=time), body(7, time, 0.0)) for time in np.arange(60) / RATE]

    reader, came = followed([frame for pair in slots for frame in pair])

    assert [frame.body for frame in came] == [0] + [7] * 59 and reader.followed == 1


def test_the_actor_is_followed_at_once_after_empty_frames():
    empty = np.full((2, 3), np.nan)
    frames = [body(7, frame / RATE, 0.0) for frame in range(60)]
    frames[:20] = [replace(each, body=0, positions=empty) for each in frames[:20]]

    reader, came = followed(frames)

    assert (len(came), reader.counts.others, reader.followed) == (60, 0, 1)


def test_memory_of_a_flood_of_identities_is_bounded():
    people = StreamPeople()
    for identity in range(200):
        people.add(body(identity, 0.0, float(identity)))
    assert people.n_present == MAX_PEOPLE
    assert people.add(body(999, 0.0, 50.5)) is None
