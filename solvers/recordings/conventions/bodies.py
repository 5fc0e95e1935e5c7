"""List the bodies of a recording, and read one or all of them."""

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError, InvalidSettingError
from ...progress import READING, Progress, Remark, within
from ..containers import shown

Recording = TypeVar("Recording", covariant=True)
Key = TypeVar("Key", bound=Hashable)
ALL_BODIES = "all"
"""Choice of every body, without false detections."""
MIN_FRACTION = 0.05
"""Minimum frames of a person, relative to the person in most frames. Chosen by hand: at 30 Hz
it is 1.5 s of a take of 30 s, and trackers see people in furniture for a moment."""
MAX_LISTED = 4
"""Bodies that a sentence lists."""


def no_body_error(path: Path | str) -> InvalidFileError:
    """Return the refusal of a recording in which no frame has a body."""
    return InvalidFileError(
        f"{path} has no body in any frame. Record it again with the actor in view."
    )


@dataclass(frozen=True)
class Body:
    """A person of a recording, or a prop that was captured too.

    Attributes
    ----------
    name : str
        As in the file, or its number.
    n_frames : int
        Number of frames in which it is observed.
    first, last : int
        First and last of these, from 0.
    fraction : float
        Fraction of all frames of the recording in which it is observed.
    duration_s : float
        Seconds from the first to the end of the last frame.
    is_person : bool
    """

    name: str
    n_frames: int
    first: int
    last: int
    fraction: float
    duration_s: float
    is_person: bool = True

    @property
    def summary(self) -> str:
        """Name, length and fraction as text."""
        kind = "" if self.is_person else "prop, "
        percent = f"{100.0 * self.fraction:.0f} % of the frames"
        return f"{shown(self.name)} ({kind}{self.duration_s:.1f} s, {percent})"


@dataclass(frozen=True, eq=False)
class Bodies(Generic[Recording]):
    """The bodies of an opened file, and how one is read.

    Attributes
    ----------
    path : str
        For messages.
    listed : tuple of Body
        In the order of the file; empty where the format has no more than one.
    read : callable
        Returns the recording of the body with this index, on the time line of the file.
    read_together : callable or None
        Returns one recording of everything, for a person with props.
    """

    path: str
    listed: tuple[Body, ...]
    read: Callable[[int, Progress], Recording]
    read_together: Callable[[Progress], Recording] | None = None

    @cached_property
    def people(self) -> list[int]:
        """Indices of the persons that are no false detections."""
        persons = [each for each, body in enumerate(self.listed) if body.is_person]
        most = max((self.listed[each].n_frames for each in persons), default=0)
        return [each for each in persons if self.listed[each].n_frames >= MIN_FRACTION * most]

    @cached_property
    def offered(self) -> list[int]:
        """Indices to choose from: several persons, and props; empty without a choice."""
        if len(self.people) < 2:
            return []
        props = [each for each, body in enumerate(self.listed) if not body.is_person]
        return sorted((*self.people, *props))

    def choose(self, wanted: str | None) -> list[int]:
        """Return the indices of the chosen bodies.

        Parameters
        ----------
        wanted : str or None
            A name or a number from 1, several with commas, or `all`. None or empty: the person
            in most frames, the first one of a tie.

        Raises
        ------
        InvalidSettingError
            There is no such body.
        """
        text = (wanted or "").strip()
        if not self.listed:
            if text in {"", "1", ALL_BODIES}:
                return [0]
            raise InvalidSettingError(
                f"{self.path} has one body, so there is no body {shown(text)!r}. Leave it out."
            )
        if not text:
            persons = self.people or range(len(self.listed))
            return [max(persons, key=lambda index: self.listed[index].n_frames)]
        if text.lower() == ALL_BODIES:
            return self.offered or self.choose(None)
        names = [text] if self._find(text) is not None else text.split(",")
        indices = [self._find(name.strip()) for name in names]
        found = [index for index in indices if index is not None]
        if len(found) < len(indices):
            listed = self._summaries(range(len(self.listed)))
            raise InvalidSettingError(
                f"{self.path} has no body {shown(text)!r}. Name one of its"
                f" {len(self.listed)} by name or number, or all: {listed}."
            )
        return list(dict.fromkeys(found))

    def read_one(self, wanted: str | None, progress: Progress) -> Recording:
        """Read the chosen body; report which others there are.

        Raises InvalidSettingError if there is no such body, or several are chosen.
        """
        if not self.is_together(wanted) and len(self.choose(wanted)) > 1:
            raise InvalidSettingError(
                f"{self.path} has {len(self.choose(wanted))} bodies; only one can be read here."
                " Name it."
            )
        ((_, recording),) = self.read_chosen(wanted, progress)
        return recording

    def read_chosen(
        self, wanted: str | None, progress: Progress
    ) -> list[tuple[str, Recording]]:
        """Read the chosen bodies; report which others there are.

        Returns
        -------
        list of (str, recording)
            Each with its name; the name is empty where there is no choice.
        """
        if self.is_together(wanted):
            assert self.read_together is not None
            found = [("", self.read_together(progress))]
            progress(1.0, READING)
            return found
        chosen = self.choose(wanted)
        if sentence := self.describe_others(self.offered if wanted else chosen):
            progress(0.0, Remark(sentence))
        is_named = len(self.listed) > 1 and (wanted or self.offered)
        found = []
        for count, index in enumerate(chosen):
            part = within(progress, count / len(chosen), (count + 1) / len(chosen))
            name = self.listed[index].name if is_named else ""
            found.append((name, self.read(index, part)))
        progress(1.0, READING)
        return found

    def is_together(self, wanted: str | None) -> bool:
        """Whether everything is one recording, as nothing is to be chosen."""
        return not wanted and self.read_together is not None and not self.offered

    def describe_others(self, chosen: Sequence[int]) -> str:
        """Return a sentence without a period on what was left out; empty if that is nothing."""
        left = [each for each in range(len(self.listed)) if each not in chosen]
        offered = set(self.offered)
        real = [each for each in left if each in offered]
        ghosts = [each for each in left if each not in offered and self.listed[each].is_person]
        sentences = []
        if real:
            names = ", ".join(shown(self.listed[each].name) for each in chosen[:MAX_LISTED])
            sentences.append(
                f"Body {names} of {len(offered)}. Left out: {self._summaries(real)}. Set Body"
                " to a name, or to all (--body)"
            )
        if ghosts:
            sentences.append(f"Left out as a false detection: {self._summaries(ghosts)}")
        return ". ".join(sentences)

    def _summaries(self, indices: Sequence[int]) -> str:
        listed = "; ".join(self.listed[each].summary for each in indices[:MAX_LISTED])
        more = len(indices) - MAX_LISTED
        return f"{listed} and {more} more" if more > 0 else listed

    def _find(self, name: str) -> int | None:
        """Return the index of a body by its name or otherwise its number."""
        names = [body.name.lower() for body in self.listed]
        if name.lower() in names:
            return names.index(name.lower())
        is_number = name.isascii() and name.isdigit() and 0 < int(name[:9]) <= len(names)
        return int(name[:9]) - 1 if is_number else None


def observed_body(
    name: str,
    frames: NDArray[np.intp],
    n_frames: int,
    duration_s: float,
    *,
    is_person: bool = True,
) -> Body:
    """Return a body from the indices, (n,), of frames of all `n_frames` that observe it."""
    first, last = (int(frames[0]), int(frames[-1])) if len(frames) else (0, -1)
    fraction, seconds = len(frames) / n_frames, duration_s * (last + 1 - first) / n_frames
    return Body(name, len(frames), first, last, fraction, seconds, is_person)


def recorded_seconds(times: NDArray[np.float64]) -> float:
    """Return the seconds between the first and the last of times, (n,); NaN are unknown."""
    known = times[np.isfinite(times)]
    return float(np.ptp(known)) if len(known) else 0.0


def bodies_of_frames(
    frames: Sequence[Mapping[Key, object]],
    duration_s: float,
    name: Callable[[int, Key], str] = lambda number, key: str(key),
) -> tuple[tuple[Key, ...], tuple[Body, ...]]:
    """Return keys and bodies, in the order in which they appear.

    Parameters
    ----------
    frames : sequence of mappings
        Observations by body.
    duration_s : float
    name : callable
        Makes a name from number and key.
    """
    found: dict[Key, list[int]] = {}
    for index, frame in enumerate(frames):
        for key in frame:
            found.setdefault(key, []).append(index)
    return tuple(found), tuple(
        observed_body(name(number, key), np.array(observed), len(frames), duration_s)
        for number, (key, observed) in enumerate(found.items(), start=1)
    )


def stack_body_frames(
    body: Key, frames: Sequence[Mapping[Key, NDArray[np.float64]]]
) -> NDArray[np.float64]:
    """Stack the values of one body, shape (n_frames, ...); NaN in the frames without it."""
    shape = next(frame[body].shape for frame in frames if body in frame)
    missing = np.full(shape, np.nan)
    return np.stack([frame.get(body, missing) for frame in frames])
