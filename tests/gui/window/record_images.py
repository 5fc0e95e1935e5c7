"""Write the images of a depth recording into a folder, as a camera's recorder does.

    python3 record_images.py walk.npz FOLDER

The recording is played forward and backward until this process is ended.
"""

import io
import sys
from itertools import count
from pathlib import Path
from time import monotonic, sleep

import numpy as np
from PIL import Image

RATE_HZ = 30.0


def encoded(image):
    content = io.BytesIO()
    Image.fromarray(image).save(content, "PNG", compress_level=1)
    return content.getvalue()


def main(source, folder):
    with np.load(source) as recording:
        images = [encoded(image) for image in recording["depth"]]
    images += images[::-1]
    Path(folder).mkdir(exist_ok=True)
    began = monotonic()
    for number in count():
        (Path(folder) / f"{number:06}.png").write_bytes(images[number % len(images)])
        sleep(max(began + number / RATE_HZ - monotonic(), 0.0))


if __name__ == "__main__":
    main(*sys.argv[1:])
