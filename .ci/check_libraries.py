"""Name the system libraries that Blender needs and this machine lacks, before anything fails.

python .ci/check_libraries.py              say what is missing, with the command to install it
python .ci/check_libraries.py --install    as root on Debian or Ubuntu: run that command
"""

import ctypes
import os
import shutil
import subprocess
import sys

PACKAGES = {
    "libX11.so.6": "libx11-6",
    "libXrender.so.1": "libxrender1",
    "libXfixes.so.3": "libxfixes3",
    "libXi.so.6": "libxi6",
    "libXext.so.6": "libxext6",
    "libxkbcommon.so.0": "libxkbcommon0",
    "libSM.so.6": "libsm6",
    "libICE.so.6": "libice6",
    "libGL.so.1": "libgl1",
    "libEGL.so.1": "libegl1",
}


def main() -> None:
    """Exit with 1 and one sentence while a library is missing."""
    missing = [library for library in PACKAGES if not loads(library)]
    if not missing:
        return
    install = ["apt-get", "install", "-y", *(PACKAGES[library] for library in missing)]
    can_install = os.geteuid() == 0 and shutil.which("apt-get")
    if "--install" in sys.argv and can_install:
        subprocess.run(["apt-get", "update"], check=True)
        environment = os.environ | {"DEBIAN_FRONTEND": "noninteractive"}
        subprocess.run(install, check=True, env=environment)
        missing = [library for library in missing if not loads(library)]
    if missing:
        command = " ".join(install)
        sys.exit(
            f"Blender needs system libraries that are missing: {', '.join(missing)}.\n"
            f"Install them with:  sudo {command}\n"
            "(those are the names of Debian and Ubuntu), and run make again."
        )


def loads(library: str) -> bool:
    """Whether the dynamic linker finds it."""
    try:
        ctypes.CDLL(library)
    except OSError:
        return False
    return True


if __name__ == "__main__":
    main()
