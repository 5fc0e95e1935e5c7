"""What training scripts share: the file to write, and lines of progress."""

import argparse
from pathlib import Path


def parse_output(description: str | None, shipped: Path) -> Path:
    """Return the file of `--out`; by default the one that is shipped."""
    parser = argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--out", type=Path, default=shipped)
    return Path(parser.parse_args().out)


def print_progress(fraction: float, message: str) -> None:
    """Print how far a script is."""
    print(f"{fraction:6.1%} {message}", flush=True)
