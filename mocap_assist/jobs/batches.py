"""Divide the parts of a job into batches of limited size."""

from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

Item = TypeVar("Item")


def batches_by_size(
    items: Iterable[Item], size_of: Callable[[Item], int], max_bytes: int
) -> Iterator[list[Item]]:
    """Yield several small items at a time, in order, or a large one alone."""
    batch: list[Item] = []
    room = max_bytes
    for item in items:
        size = size_of(item)
        if batch and size > room:
            yield batch
            batch, room = [], max_bytes
        batch.append(item)
        room -= size
    if batch:
        yield batch
