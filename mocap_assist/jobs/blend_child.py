"""child.py for a background Blender, which can read .blend files."""

import runpy
import sys
from pathlib import Path

if __name__ == "__main__":
    child = str(Path(__file__).with_name("child.py"))
    sys.argv = [child, *sys.argv[sys.argv.index("--") + 1 :]]
    runpy.run_path(child, run_name="__main__")  # ends this process
