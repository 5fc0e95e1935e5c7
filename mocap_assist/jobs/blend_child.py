"""child.py for a background Blender, which can read .blend files."""

import os
import runpy
import sys
from pathlib import Path

if __name__ == "__main__":
    for path in os.environ["PYTHONPATH"].split(os.pathsep):  # which Blender itself ignores
        if path not in sys.path:
            sys.path.append(path)
    # Scripts of a Blender that is a module of Python would hide the module itself.
    sys.path.sort(key=lambda path: "scripts" in Path(path).parts)
    child = str(Path(__file__).with_name("child.py"))
    sys.argv = [child, *sys.argv[sys.argv.index("--") + 1 :]]
    runpy.run_path(child, run_name="__main__")
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)  # Blender may hang on its way out
