"""Search for files that a reader neither reads nor refuses: coverage-guided, with atheris.

    make fuzz                                  every target, 60 s each
    make fuzz SECONDS=600 TARGETS="c3d bvh"    two of them, ten minutes each

What was found is written to build/fuzz/found/TARGET, and what libFuzzer learned to
build/fuzz/corpus/TARGET, from which the next search goes on. To keep a find: move it to
tests/data/damaged/TARGET, where `make test` reads it for good.
"""

import argparse
import random
import re
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic

ROOT = Path(__file__).parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "fixtures"), str(ROOT / "tests" / "fuzz")]
BUILD = ROOT / "build" / "fuzz"
MEMORY_MB = 1500
SECONDS_FOR_ONE = 20
"""Time limit in seconds that only an endless loop exceeds for a file of some kilobytes."""
EXECUTED = re.compile(r"stat::number_of_executed_units: +(\d+)")
PEAK = re.compile(r"stat::peak_rss_mb: +(\d+)")


def main(words: Sequence[str]) -> int:
    """Fuzz the named targets, or all; return 1 if a failure is found."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("targets", nargs="*", metavar="TARGET", help="[default: all]")
    parser.add_argument("--seconds", type=int, default=60, help="for each [default 60]")
    parser.add_argument("--one", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args(words)
    if arguments.one:
        search(arguments.targets[0], arguments.seconds)
    from targets import targets

    names = arguments.targets or list(targets())
    failed = [name for name in names if not searched(name, arguments.seconds)]
    print(f"Found something in: {', '.join(failed)}" if failed else "Nothing was found.")
    return int(bool(failed))


def searched(name: str, seconds: int) -> bool:
    """Search in a process of its own; print a line, and return whether there is no failure."""
    for folder in ("corpus", "found"):
        (BUILD / folder / name).mkdir(parents=True, exist_ok=True)
    before = set((BUILD / "found" / name).iterdir())
    started = monotonic()
    command = [sys.executable, __file__, "--one", name, "--seconds", str(seconds)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    counts = [pattern.search(done.stderr) for pattern in (EXECUTED, PEAK)]
    executed, peak = (int(found[1]) if found else 0 for found in counts)
    found = set((BUILD / "found" / name).iterdir()) - before
    print(
        f"{name:24}{executed:>9} executions{monotonic() - started:>7.0f} s{peak:>7} MB  "
        f"{len(found)} found",
        flush=True,
    )
    if done.returncode and not found:
        print(done.stderr[-2000:])
    for path in found:
        print(f"  {path}")
    return not (found or done.returncode)


def search(name: str, seconds: int) -> None:
    """Let libFuzzer run one target; it ends this process."""
    import atheris

    with atheris.instrument_imports(include=["solvers"]):
        import targets as module
    from mutations import damaged

    target = module.targets()[name]
    seed_folder = TemporaryDirectory()
    for number, seed in enumerate(module.seeds(name, target)):
        (Path(seed_folder.name) / f"seed{number}").write_bytes(seed)
    folder = TemporaryDirectory()

    def read(content: bytes) -> None:
        module.read_target(target, content, Path(folder.name))

    def damage(content: bytes, max_size: int, seed: int) -> bytes:
        return damaged(target, content, max_size, random.Random(seed), atheris.Mutate)

    options = [
        f"-max_total_time={seconds}", f"-max_len={max(module.MAX_BYTES, 2 * len(target.seed))}",
        f"-rss_limit_mb={MEMORY_MB}", f"-timeout={SECONDS_FOR_ONE}", "-print_final_stats=1",
        f"-artifact_prefix={BUILD / 'found' / name}/", str(BUILD / "corpus" / name),
        seed_folder.name,
    ]  # fmt: skip
    atheris.Setup([sys.argv[0], *options], read, custom_mutator=damage)
    atheris.Fuzz()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
