"""Quick gestures: claps and waves."""

from collections import deque
from math import isnan

from .events import Gesture, GestureEvent
from .hand_signals import Hands
from .settings import GestureSettings

BELLY, CHIN = -0.8, 0.3
"""Heights of the hands' middle, from the shoulders, between which they clap."""
IN_FRONT, ASIDE = 0.1, 0.5
"""How far in front of the shoulders the hands' middle must be in a clap, and may be aside."""
RAISED = -0.1, -0.85
"""How far before the shoulders, and above them, the hands' middle is where a clap begins."""
PARTED = 1.3
"""Share of the touching distance from which on hands that touched are parted."""
SHARED = 0.2
"""Share of the way inwards that each hand makes at least in a clap."""
HAND_HIGH = -0.65
"""Height of the right wrist from its shoulder from which on it can wave."""
FLAT = 0.9
"""Share of a wave's way that its height may change."""
OUTSIDE, ACROSS = 0.3, -0.1
"""How far right of its shoulder the wrist ends a wave to the right, or to the left."""
HANGS = -0.45
"""Height of the left wrist below which that arm takes no part in a wave."""


class Clap:
    """Hands come from apart, touch before the chest, and part: quickly.

    Hands that are lost while they close in on each other are taken to go on: that is when depth
    cameras lose them.
    """

    def __init__(self, settings: GestureSettings) -> None:
        self._settings = settings
        self.forget()

    def forget(self) -> None:
        """Begin anew."""
        self._apart: Hands | None = None
        self._touched_at: float | None = None
        self._began = 0.0
        self._before: Hands | None = None
        self._last: Hands | None = None

    def see(self, hands: Hands, held: bool = False) -> GestureEvent | None:
        """Return an event (of a start; who listens knows whether it is an end) at the end.

        Hands that have hold of the view (`held`) come together without clapping.
        """
        if self._touched_at is not None:
            return self._part(hands)
        if isnan(hands.newest_gap):
            self.lose(hands.time)
            return None
        if hands.sideways >= self._settings.apart and _raised(hands):
            self._apart = hands
        elif self._apart is not None and hands.gap <= self._settings.together and not held:
            self._touch(hands, hands.time)
        self._before, self._last = self._last, hands
        return None

    def lose(self, time: float) -> None:
        """Note that the hands are not seen."""
        before, last = self._before, self._last
        if None in (self._apart, before, last) or self._touched_at is not None:
            return
        assert before is not None and last is not None
        closing = (before.newest_gap - last.newest_gap) / (last.time - before.time)
        gap = last.newest_gap - closing * (time - last.time)
        if closing > 0.0 and gap <= self._settings.together:
            self._touch(last, time)

    def _touch(self, hands: Hands, time: float) -> None:
        assert self._apart is not None
        quick = time - self._apart.time <= self._settings.clap_within
        if quick and _before_the_chest(hands) and _both_came(self._apart, hands):
            self._touched_at, self._began = time, self._apart.time
        self._apart = self._before = self._last = None

    def _part(self, hands: Hands) -> GestureEvent | None:
        assert self._touched_at is not None
        parted = hands.gap >= PARTED * self._settings.together or hands.between[2] < BELLY
        if hands.time - self._touched_at > self._settings.touch_for:
            self.forget()
        elif parted:
            began = self._began
            self.forget()
            return GestureEvent(Gesture.CAPTURE_START, hands.time, began)
        return None


def _raised(hands: Hands) -> bool:
    """Whether the hands are before the body, and do not hang."""
    return bool(hands.between[1] >= RAISED[0] and hands.between[2] >= RAISED[1])


def _both_came(apart: Hands, near: Hands) -> bool:
    """Whether each hand moved inwards: one that comes alone strikes or reaches."""
    right, left = apart.right[0] - near.right[0], near.left[0] - apart.left[0]
    return bool(min(right, left) >= SHARED * (right + left))


def _before_the_chest(hands: Hands) -> bool:
    right, forward, up = hands.between
    return bool(BELLY <= up <= CHIN and forward >= IN_FRONT and abs(right) <= ASIDE)


class Wave:
    """The right hand goes far to one side, quickly and level; the left one hangs."""

    def __init__(self, settings: GestureSettings) -> None:
        self._settings = settings
        self.forget()

    def forget(self) -> None:
        """Begin anew."""
        self._path: deque[Hands] = deque()
        self._pause_until = float("-inf")

    def see(self, hands: Hands) -> GestureEvent | None:
        """Return an event at the end of a wave."""
        able = hands.right[2] >= HAND_HIGH and hands.left[2] < HANGS
        if not able or hands.time < self._pause_until:
            self._path.clear()
            return None
        self._path.append(hands)
        while hands.time - self._path[0].time > self._settings.wave_within:
            self._path.popleft()
        event = self._ended(hands, 1.0) or self._ended(hands, -1.0)
        if event is not None:
            self._path.clear()
            self._pause_until = hands.time + self._settings.wave_pause
        return event

    def _ended(self, hands: Hands, way: float) -> GestureEvent | None:
        """Return the wave to one side (1: right, -1: left) that ends here, if one does."""
        x = hands.right[0]
        if (x < OUTSIDE) if way > 0 else (x > ACROSS):
            return None
        start = min(self._path, key=lambda seen: way * seen.right[0])
        far = way * (x - start.right[0])
        rise = abs(hands.right[2] - start.right[2])
        if far < self._settings.wave or rise > FLAT * far:
            return None
        gesture = Gesture.PAGE_NEXT if way > 0 else Gesture.PAGE_BACK
        return GestureEvent(gesture, hands.time, start.time)
