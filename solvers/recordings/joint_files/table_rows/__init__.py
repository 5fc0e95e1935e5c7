"""Put what a file holds otherwise in rows below titles: arrays next to names, and indices."""

from .named_arrays import named_arrays
from .row_index import INDEX, with_index
from .titled_rows import TitledRows

__all__ = ["INDEX", "TitledRows", "named_arrays", "with_index"]
