"""Hands that are held still: the right one up, or those that take hold of the view."""

from math import atan2, exp, pi

import numpy as np
from numpy.typing import NDArray

from .events import Gesture, GestureEvent
from .hand_signals import Hands
from .settings import GestureSettings

Array = NDArray[np.float64]


LOWERED = 0.0
"""Height of the right wrist above its shoulder below which the hand is down again."""
HANGS = -0.45
"""Height of a wrist below which that arm takes no part."""
FRONT = 0.3
"""How far in front of the shoulders hands are that zoom."""
LOW, HIGH = -0.75, 0.35
"""Heights of hands between which they zoom."""
LEVEL = 0.45
"""Difference in height, and in reach forward, of hands that zoom."""
NARROWEST, WIDEST = 0.25, 2.2
"""Gaps between which hands zoom."""
STRAIGHT = 0.85
"""Reach from which on an arm is straight; it turns the view until it is below `BENT`."""
BENT = 0.7
TILT = 0.4
"""Height above or below the shoulder up to which a straight arm is level."""
SAG = 0.3
"""Height that hands may gain or lose before they let go: who lowers them moves nothing."""
STEADIED = 0.12
"""Seconds over which what the hands give is steadied."""
FASTEST_ZOOM = 4.0
"""Change of the logarithm of the gap in a second. Hands that meet faster clap."""
FASTEST_TURN = 4.0
"""Radians per second. An arm that swings faster waves."""


class Hold:
    """How long something has been still."""

    def __init__(self, radius: float) -> None:
        self._radius = radius
        self._place: Array | None = None
        self._since = 0.0

    def see(self, time: float, place: Array | None) -> float:
        """Return for how many seconds the place has not strayed; None is no place."""
        if place is None:
            self._place = None
            return 0.0
        if self._place is None or np.linalg.norm(place - self._place) > self._radius:
            self._place, self._since = place, time
        return time - self._since

    @property
    def since(self) -> float:
        """When it came to rest, seconds."""
        return self._since


class HandUp:
    """The right hand is held up, once until it is lowered; the left one hangs."""

    def __init__(self, settings: GestureSettings) -> None:
        self._settings = settings
        self.forget()

    def forget(self) -> None:
        """Begin anew."""
        self._hold = Hold(self._settings.still)
        self._said = False

    def see(self, hands: Hands) -> GestureEvent | None:
        """Return an event when the hand has been up for long enough."""
        self._said = self._said and hands.right[2] > LOWERED
        up = hands.right[2] >= self._settings.raised and hands.left[2] < HANGS
        held = self._hold.see(hands.time, hands.right if up else None)
        if self._said or held < self._settings.raised_for:
            return None
        self._said = True
        return GestureEvent(Gesture.HAND_UP, hands.time, self._hold.since)


class Grip:
    """Hands that took hold of the view by being still; what they do then moves it."""

    def __init__(self, settings: GestureSettings, fastest: float) -> None:
        self._settings, self._fastest = settings, fastest
        self.forget()

    def forget(self) -> None:
        """Let go."""
        self._hold = Hold(self._settings.still)
        self._given: float | None = None
        self._steady = self._time = 0.0
        self._heights = np.zeros(1)

    @property
    def holds(self) -> bool:
        """Whether the hands have hold of the view."""
        return self._given is not None

    def see(self, time: float, place: Array | None, value: float) -> float:
        """Return by how much the value has changed since it was last told; mostly 0.

        Parameters
        ----------
        time : float, seconds
        place : shape (3,) or (6,), arm lengths, or None
            Of the hand or hands; None where they are not fit to take hold.
        value : float
            An angle, or the logarithm of a distance.
        """
        if place is None:
            self.forget()
        elif self._given is None:
            if self._hold.see(time, place) >= self._settings.engage_for:
                self._given, self._steady, self._time = value, value, time
                self._heights = place[2::3]
        elif self._strays(place, value):
            self.forget()
        else:
            share = 1.0 - exp((self._time - time) / STEADIED)
            self._steady += share * _nearest(value - self._steady)
            self._time = time
            return self._change(self._steady)
        return 0.0

    def _strays(self, place: Array, value: float) -> bool:
        """Whether the hands go too fast, by how far the steadied value lags, or up or down."""
        speed = abs(_nearest(value - self._steady)) / STEADIED
        sag = np.abs(place[2::3] - self._heights).max()
        return bool(speed > self._fastest or sag > SAG)

    def _change(self, value: float) -> float:
        assert self._given is not None
        change = _nearest(value - self._given)
        if abs(change) < self._settings.dead_zone:
            return 0.0
        self._given = value
        return change


def _nearest(angle: float) -> float:
    """Return the same angle between -pi and pi. Logarithms of zoom are never that large."""
    return (angle + pi) % (2.0 * pi) - pi


class Zoom:
    """Both hands before the chest take hold, and zoom by their distance."""

    def __init__(self, settings: GestureSettings) -> None:
        self._grip = Grip(settings, FASTEST_ZOOM)

    def forget(self) -> None:
        """Let go."""
        self._grip.forget()

    @property
    def holds(self) -> bool:
        """Whether it has hold of the view."""
        return self._grip.holds

    def see(self, hands: Hands) -> GestureEvent | None:
        """Return by which factor the hands have moved apart, once they have hold."""
        place = np.concatenate([hands.right, hands.left]) if _offered(hands) else None
        change = self._grip.see(hands.time, place, float(np.log(max(hands.gap, 1e-3))))
        if not change:
            return None
        return GestureEvent(Gesture.ZOOM, hands.time, hands.time, float(np.exp(change)))


def _offered(hands: Hands) -> bool:
    """Whether both hands are before the chest, side by side."""
    for hand in (hands.right, hands.left):
        if hand[1] < FRONT or not LOW <= hand[2] <= HIGH:
            return False
    apart = np.abs(hands.right - hands.left)[1:]
    return bool((apart <= LEVEL).all()) and NARROWEST <= hands.gap <= WIDEST


class Turn:
    """The stretched right arm takes hold, and turns the view as it swings about the body."""

    def __init__(self, settings: GestureSettings) -> None:
        self._grip = Grip(settings, FASTEST_TURN)

    def forget(self) -> None:
        """Let go."""
        self._grip.forget()

    @property
    def holds(self) -> bool:
        """Whether it has hold of the view."""
        return self._grip.holds

    def see(self, hands: Hands) -> GestureEvent | None:
        """Return by how much the arm has turned, once it has hold."""
        right, forward, up = hands.right
        straight = hands.reach >= (BENT if self._grip.holds else STRAIGHT)
        level = abs(up) <= TILT and hands.left[2] < HANGS
        place = hands.right if straight and level else None
        change = self._grip.see(hands.time, place, atan2(forward, right))
        if not change:
            return None
        return GestureEvent(Gesture.TURN, hands.time, hands.time, change)
