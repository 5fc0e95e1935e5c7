"""Detect fast gestures: claps and waves."""

from collections import deque
from math import isnan

from .events import Gesture, GestureEvent
from .hand_tracking import Hands
from .settings import GestureSettings

MIN_CLAP_HEIGHT, MAX_CLAP_HEIGHT = -0.8, 0.3
"""Range of heights of the hands' midpoint, relative to the shoulders, in arm lengths, in a
clap. Sweep: without the second MSR Action3D has 13 claps more, without the first one less
(`test_clap_above_the_head_is_ignored`)."""
MIN_CLAP_FORWARD, MAX_CLAP_SIDEWAYS = 0.1, 0.5
"""Minimum forward and maximum sideways position of the hands' midpoint in a clap, in arm
lengths. Sweep: without either MSR Action3D has a clap more
(`test_hands_that_meet_behind_the_back_do_not_clap`)."""
CLAP_START_HEIGHT = -0.85
"""Minimum height of the hands' midpoint at the start of a clap, in arm lengths. Without it arms
that swing up from the sides clap in 9 of the 104 other takes of UTD-MHAD instead of 4, and in
LabanotationSuite once more. Half and twice are no better (`make sensitivity`)."""
PARTED_FACTOR = 1.3
"""Factor on the touching distance from which on hands have parted. With 1, six claps of MSR
Action3D end at another time. Half and twice are no better (`make sensitivity`)."""
MIN_HAND_FRACTION = 0.2
"""Minimum fraction of the closing distance that each hand covers. Without it MSR Action3D has
three claps more and two waves less. Half and twice are no better (`make sensitivity`)."""
MIN_WAVE_HEIGHT = -0.65
"""Minimum height of the right wrist relative to its shoulder in a wave, in arm lengths. Without
it UI-PRMD and MSR Action3D have 100 waves more. Half and twice are no better
(`make sensitivity`)."""
MAX_RISE_FRACTION = 0.9
"""Maximum height change of a wave, as a fraction of its length. Without it UI-PRMD and MSR
Action3D have 26 waves more. Half and twice are no better (`make sensitivity`)."""
MIN_RIGHT_END, MAX_LEFT_END = 0.3, -0.1
"""End position of the wrist, to the right of its shoulder in arm lengths, for waves to the
right and to the left. Without the first UI-PRMD and MSR Action3D have 7 waves more, without the
second 55. Half and twice are no better (`make sensitivity`)."""
MAX_HANGING_HEIGHT = -0.45
"""Height of a wrist above its shoulder, in arm lengths, below which its arm hangs. Half and
twice are no better (`make sensitivity`)."""


class Clap:
    """Detect hands that close fast, touch in front of the chest, and part.

    Depth cameras often lose hands as they close. Missing hands are extrapolated then.
    """

    def __init__(self, settings: GestureSettings) -> None:
        self._settings = settings
        self.reset()

    def reset(self) -> None:
        """Reset the detector."""
        self._open_hands: Hands | None = None
        self._touched_at: float | None = None
        self._began = 0.0
        self._previous: Hands | None = None
        self._last: Hands | None = None

    def update(self, hands: Hands, is_dragging: bool = False) -> GestureEvent | None:
        """Return a start event at the end of a clap; the caller knows whether it ends a
        performance.

        Hands that drag the view (`is_dragging`) come together without clapping.
        """
        if self._touched_at is not None:
            return self._finish_clap(hands)
        if isnan(hands.latest_gap):
            self.mark_missing(hands.time)
            return None
        if (
            hands.sideways >= self._settings.hand_distance
            and hands.between[2] >= CLAP_START_HEIGHT
        ):
            self._open_hands = hands
        elif (
            self._open_hands is not None
            and hands.gap <= self._settings.together
            and not is_dragging
        ):
            self._start_touch(hands, hands.time)
        self._previous, self._last = self._last, hands
        return None

    def mark_missing(self, time: float) -> None:
        """Note that the hands are missing."""
        before, last = self._previous, self._last
        if None in (self._open_hands, before, last) or self._touched_at is not None:
            return
        assert before is not None and last is not None
        closing = (before.latest_gap - last.latest_gap) / (last.time - before.time)
        gap = last.latest_gap - closing * (time - last.time)
        if closing > 0.0 and gap <= self._settings.together:
            self._start_touch(last, time)

    def _start_touch(self, hands: Hands, time: float) -> None:
        assert self._open_hands is not None
        is_fast = time - self._open_hands.time <= self._settings.clap_within
        if is_fast and _is_at_chest(hands) and _both_hands_moved(self._open_hands, hands):
            self._touched_at, self._began = time, self._open_hands.time
        self._open_hands = self._previous = self._last = None

    def _finish_clap(self, hands: Hands) -> GestureEvent | None:
        assert self._touched_at is not None
        parted = (
            hands.gap >= PARTED_FACTOR * self._settings.together
            or hands.between[2] < MIN_CLAP_HEIGHT
        )
        if hands.time - self._touched_at > self._settings.touch_for:
            self.reset()
        elif parted:
            began = self._began
            self.reset()
            return GestureEvent(Gesture.CAPTURE_START, hands.time, began)
        return None


def _both_hands_moved(open_hands: Hands, closed_hands: Hands) -> bool:
    """Return whether each hand moved inwards: a single one strikes or reaches."""
    right, left = (
        open_hands.right[0] - closed_hands.right[0],
        closed_hands.left[0] - open_hands.left[0],
    )
    return bool(min(right, left) >= MIN_HAND_FRACTION * (right + left))


def _is_at_chest(hands: Hands) -> bool:
    right, forward, up = hands.between
    return bool(
        MIN_CLAP_HEIGHT <= up <= MAX_CLAP_HEIGHT
        and forward >= MIN_CLAP_FORWARD
        and abs(right) <= MAX_CLAP_SIDEWAYS
    )


class Wave:
    """Detect a fast, level sideways stroke of the right hand, with the left arm hanging."""

    def __init__(self, settings: GestureSettings) -> None:
        self._settings = settings
        self.reset()

    def reset(self) -> None:
        """Reset the detector."""
        self._path: deque[Hands] = deque()
        self._pause_until = float("-inf")

    def update(self, hands: Hands) -> GestureEvent | None:
        """Return an event at the end of a wave."""
        can_wave = hands.right[2] >= MIN_WAVE_HEIGHT and hands.left[2] < MAX_HANGING_HEIGHT
        if not can_wave or hands.time < self._pause_until:
            self._path.clear()
            return None
        self._path.append(hands)
        while hands.time - self._path[0].time > self._settings.wave_within:
            self._path.popleft()
        event = self._find_wave(hands, 1.0) or self._find_wave(hands, -1.0)
        if event is not None:
            self._path.clear()
            self._pause_until = hands.time + self._settings.wave_pause
        return event

    def _find_wave(self, hands: Hands, direction: float) -> GestureEvent | None:
        """Return the wave in a direction (1: right, -1: left) that ends now, if any."""
        x = hands.right[0]
        if (x < MIN_RIGHT_END) if direction > 0 else (x > MAX_LEFT_END):
            return None
        start = min(self._path, key=lambda hands_before: direction * hands_before.right[0])
        distance = direction * (x - start.right[0])
        rise = abs(hands.right[2] - start.right[2])
        if distance < self._settings.wave or rise > MAX_RISE_FRACTION * distance:
            return None
        gesture = Gesture.PAGE_NEXT if direction > 0 else Gesture.PAGE_BACK
        return GestureEvent(gesture, hands.time, start.time)
