"""A table as rows below titles, wherever its values were."""

from collections.abc import Sequence
from typing import Any, NamedTuple

from ....progress import Remark


class TitledRows(NamedTuple):
    """Titles, and cells of each row."""

    titles: list[str]
    rows: Sequence[Sequence[Any]]
    remark: Remark | None = None
    """What was chosen of the file; None if there was no choice."""
