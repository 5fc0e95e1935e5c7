"""Detect hands held still: the right hand up, or hands that drag the view."""

from math import atan2, exp, pi

import numpy as np

from ..arrays import Array
from .events import Gesture, GestureEvent
from .hand_tracking import Hands
from .settings import GestureSettings
from .stroke_gestures import MAX_HANGING_HEIGHT

LOWERED_HEIGHT = 0.0
"""Height of the wrist above its shoulder below which the hand counts as lowered."""
MIN_FORWARD = 0.3
"""Minimum distance of zooming hands in front of the shoulders, in arm lengths. Without it the
exercises of UI-PRMD zoom 43 times. Half and twice are no better (`make sensitivity`)."""
MIN_ZOOM_HEIGHT, MAX_ZOOM_HEIGHT = -0.75, 0.35
"""Range of heights of zooming hands above the shoulders, in arm lengths. Sweep: without the
second the exercises of UI-PRMD zoom 145 times, without the first MSR Action3D once
(`test_exercises_give_no_command`)."""
MIN_ZOOM_GAP, MAX_ZOOM_GAP = 0.25, 2.2
"""Range of distances of zooming hands, in arm lengths. Sweep: without it an exercise of KIMORE
zooms (`test_hands_that_touch_do_not_zoom`, `test_arms_that_are_spread_wide_do_not_zoom`)."""
STRAIGHT_REACH = 0.85
"""Reach, in arm lengths, at which an arm counts as straight. With 0.7 the exercises of UI-PRMD
turn the view 54 times. Half and twice are no better (`make sensitivity`)."""
BENT_REACH = 0.7
"""Reach, in arm lengths, below which an arm counts as bent. It guards an arm that turns the
view and bends a little as it swings across the body."""
MAX_TILT = 0.4
"""Maximum height of a level arm above or below the shoulder, in arm lengths. Without it the
exercises of UI-PRMD turn the view 99 times. Half and twice are no better
(`make sensitivity`)."""
MAX_HEIGHT_CHANGE = 0.3
"""Height change, in arm lengths, that ends a drag: lowering the hands moves nothing. Without it
MSR Action3D turns the view once more. Half and twice are no better (`make sensitivity`)."""
FILTER_TIME_S = 0.12
"""Time constant in seconds of the filter of dragged values. Without it three turns of MSR
Action3D are lost. Half and twice are no better (`make sensitivity`)."""
MAX_DRAG_RATE = 4.0
"""Maximum change per second of the angle in radians, or of the logarithm of the gap. It guards
claps and waves that begin with still hands: faster hands do not drag the view
(`test_clap_of_still_hands_does_not_zoom`)."""


class StillnessTimer:
    """Measure how long a position has been still."""

    def __init__(self, radius: float) -> None:
        self._radius = radius
        self._position: Array | None = None
        self._since = 0.0

    def update(self, time: float, position: Array | None) -> float:
        """Return the seconds since the position last moved; None resets the timer."""
        if position is None:
            self._position = None
            return 0.0
        if self._position is None or np.linalg.norm(position - self._position) > self._radius:
            self._position, self._since = position, time
        return time - self._since

    @property
    def since(self) -> float:
        """Time at which it came to rest, seconds."""
        return self._since


class HandUp:
    """Detect the raised right or left hand, once until it is lowered, the other arm hanging."""

    def __init__(self, settings: GestureSettings, gesture: Gesture = Gesture.HAND_UP) -> None:
        self._settings, self._gesture = settings, gesture
        self.reset()

    def reset(self) -> None:
        """Reset the detector."""
        self._hold = StillnessTimer(self._settings.still)
        self._reported = False

    def update(self, hands: Hands) -> GestureEvent | None:
        """Return an event once the hand has been up for long enough."""
        hand, other = hands.right, hands.left
        if self._gesture is Gesture.LEFT_HAND_UP:
            hand, other = other, hand
        self._reported = self._reported and hand[2] > LOWERED_HEIGHT
        up = hand[2] >= self._settings.raised and other[2] < MAX_HANGING_HEIGHT
        duration = self._hold.update(hands.time, hand if up else None)
        if self._reported or duration < self._settings.raised_for:
            return None
        self._reported = True
        return GestureEvent(self._gesture, hands.time, self._hold.since)


class DragGesture:
    """Detect hands that grab the view by being still, and track the value that they drag."""

    def __init__(self, settings: GestureSettings) -> None:
        self._settings = settings
        self.reset()

    def reset(self) -> None:
        """Release the view."""
        self._hold = StillnessTimer(self._settings.still)
        self._reported_value: float | None = None
        self._filtered = self._time = 0.0
        self._heights = np.zeros(1)

    @property
    def is_active(self) -> bool:
        """Whether the hands hold the view."""
        return self._reported_value is not None

    def _drag(self, time: float, position: Array | None, value: float) -> float:
        """Return the change of the value since the last report; mostly 0.

        Parameters
        ----------
        time : float, seconds
        position : shape (3,) or (6,), arm lengths, or None
            Of the hand or hands; None if they cannot grab the view.
        value : float
            An angle, or the logarithm of a distance.
        """
        if position is None:
            self.reset()
        elif self._reported_value is None:
            if self._hold.update(time, position) >= self._settings.engage_for:
                self._reported_value, self._filtered, self._time = value, value, time
                self._heights = position[2::3]
        elif self._is_released(position, value):
            self.reset()
        else:
            gain = 1.0 - exp((self._time - time) / FILTER_TIME_S)
            self._filtered += gain * _wrap_angle(value - self._filtered)
            self._time = time
            return self._change(self._filtered)
        return 0.0

    def _is_released(self, position: Array, value: float) -> bool:
        """Return whether the hands move too fast, measured by the filter lag, or up or down."""
        speed = abs(_wrap_angle(value - self._filtered)) / FILTER_TIME_S
        height_change = np.abs(position[2::3] - self._heights).max()
        return bool(speed > MAX_DRAG_RATE or height_change > MAX_HEIGHT_CHANGE)

    def _change(self, value: float) -> float:
        assert self._reported_value is not None
        change = _wrap_angle(value - self._reported_value)
        if abs(change) < self._settings.dead_zone:
            return 0.0
        self._reported_value = value
        return change


def _wrap_angle(angle: float) -> float:
    """Return the same angle between -pi and pi. Logarithms of zoom are never that large."""
    return (angle + pi) % (2.0 * pi) - pi


class Zoom(DragGesture):
    """Detect both hands in front of the chest, and zoom by their distance."""

    def update(self, hands: Hands) -> GestureEvent | None:
        """Return the factor of the hands' distance since the last report, while active."""
        position = np.concatenate([hands.right, hands.left]) if _is_zoom_pose(hands) else None
        change = self._drag(hands.time, position, float(np.log(max(hands.gap, 1e-3))))
        if not change:
            return None
        return GestureEvent(Gesture.ZOOM, hands.time, hands.time, float(np.exp(change)))


def _is_zoom_pose(hands: Hands) -> bool:
    """Return whether both hands are in front of the chest, next to each other."""
    return MIN_ZOOM_GAP <= hands.gap <= MAX_ZOOM_GAP and all(
        hand[1] >= MIN_FORWARD and MIN_ZOOM_HEIGHT <= hand[2] <= MAX_ZOOM_HEIGHT
        for hand in (hands.right, hands.left)
    )


class Turn(DragGesture):
    """Detect the straight right arm, and turn the view as it swings about the body."""

    def update(self, hands: Hands) -> GestureEvent | None:
        """Return the angle of the arm's rotation since the last report, while active."""
        right, forward, up = hands.right
        straight = hands.reach >= (BENT_REACH if self.is_active else STRAIGHT_REACH)
        level = abs(up) <= MAX_TILT and hands.left[2] < MAX_HANGING_HEIGHT
        position = hands.right if straight and level else None
        change = self._drag(hands.time, position, atan2(forward, right))
        if not change:
            return None
        return GestureEvent(Gesture.TURN, hands.time, hands.time, change)
