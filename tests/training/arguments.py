"""What training scripts share: their arguments, and lines of progress."""

import argparse
from pathlib import Path


def parse_output(description: str | None, shipped: Path) -> Path:
    """Return the file of `--out`; by default the one that is shipped."""
    return Path(output_parser(description, shipped).parse_args().out)


def output_parser(description: str | None, shipped: Path | None) -> argparse.ArgumentParser:
    """Return a parser with `--out`, for scripts that add arguments of their own."""
    parser = argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--out", type=_output, default=shipped)
    return parser


def _output(text: str) -> Path:
    """Return a path in a folder that exists: training takes hours."""
    path = Path(text)
    path.parent.mkdir(parents=True, exist_ok=True)
    return path


def print_progress(fraction: float, message: str = "") -> None:
    """Print how far a script is."""
    print(f"{fraction:6.1%} {message}", flush=True)
