"""Point trajectories, as an optical system or a depth camera measures them."""

from collections import Counter
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from .file_conventions import FileConventions
from .frame_rate import check_frame_rate
from .skeleton import MAX_DISTANCE_M


@dataclass(frozen=True, eq=False)
class Tracks:
    """Trajectories of named points. NaN: missing.

    Attributes
    ----------
    names : tuple of str, length n_points, all different
    positions : float array, shape (n_frames, n_points, 3), meters, world space, Z up
    frame_rate : float, hertz
    confidence : float array, shape (n_frames, n_points), 0 to 1, or None
        Confidence of the sensor in each point.
    conventions : FileConventions or None
        How the file was interpreted that they were read from.
    """

    names: tuple[str, ...]
    positions: NDArray[np.float64]
    frame_rate: float
    confidence: NDArray[np.float64] | None = None
    conventions: FileConventions | None = None

    def __post_init__(self) -> None:
        positions = np.array(self.positions, dtype=np.float64)
        if positions.shape != (len(positions), len(self.names), 3) or not positions.size:
            raise InvalidMotionError(
                "Tracks need at least one frame and one point, and positions of shape"
                f" (n_frames, {len(self.names)}, 3), not {positions.shape}."
            )
        duplicates = sorted(name for name, count in Counter(self.names).items() if count > 1)
        if duplicates:
            raise InvalidMotionError(
                f"Point names must be unique; duplicates: {', '.join(duplicates)}."
            )
        check_frame_rate(self.frame_rate)
        distance = max(np.nanmax(positions, initial=0.0), -np.nanmin(positions, initial=0.0))
        if np.isinf(distance):
            raise InvalidMotionError("There are infinite positions; NaN marks missing ones.")
        if distance > MAX_DISTANCE_M:
            raise InvalidMotionError(
                f"A point is up to {distance:.3g} m from the origin; set the scale of the"
                " recording, or remove those frames."
            )
        object.__setattr__(self, "names", tuple(self.names))
        object.__setattr__(self, "positions", positions)
        object.__setattr__(self, "frame_rate", float(self.frame_rate))
        if self.confidence is not None:
            object.__setattr__(self, "confidence", self._check_confidence(self.confidence))

    def _check_confidence(self, confidence: NDArray[np.float64]) -> NDArray[np.float64]:
        confidence = np.array(confidence, dtype=np.float64)
        if confidence.shape != self.positions.shape[:2]:
            raise InvalidMotionError(
                f"Confidence needs shape {self.positions.shape[:2]}, not {confidence.shape}."
            )
        if not ((confidence >= 0.0) & (confidence <= 1.0)).all():
            raise InvalidMotionError("Confidence must be between 0 and 1.")
        return confidence

    @property
    def n_frames(self) -> int:
        """Number of frames."""
        return len(self.positions)

    @property
    def n_points(self) -> int:
        """Number of named points."""
        return len(self.names)

    @property
    def dt(self) -> float:
        """Seconds from one frame to the next."""
        return 1.0 / self.frame_rate

    @property
    def visible(self) -> NDArray[np.bool_]:
        """Whether each point is observed, shape (n_frames, n_points)."""
        return np.asarray(np.isfinite(self.positions).all(axis=-1))

    def with_positions(self, positions: NDArray[np.float64]) -> "Tracks":
        """Return the tracks with other positions and the same confidence."""
        return replace(self, positions=positions)

    def slice(self, start: int, stop: int) -> "Tracks":
        """Return frames `start` up to but without `stop`."""
        confidence = None if self.confidence is None else self.confidence[start:stop]
        return replace(self, positions=self.positions[start:stop], confidence=confidence)
