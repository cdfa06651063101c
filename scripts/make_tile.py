"""Draws the picture of scenes/textures.toml: a glazed tile whose circles go on over its edges.

python scripts/make_tile.py

writes scenes/textures/tile.png. All circles lie around the corners, the middles of the edges and the centre of the
tile, and so neighbouring tiles complete each other.
"""

from pathlib import Path

import numpy as np
import OpenImageIO as oiio

OUTPUT = Path(__file__).resolve().parent.parent / "scenes" / "textures" / "tile.png"
SIZE, OVERSAMPLING = 256, 4
CREAM, BLUE, SKY, OCHRE, GROUT = (
    (237, 230, 209),
    (26, 56, 128),
    (115, 161, 204),
    (217, 153, 51),
    (128, 120, 110),
)


def tile(size):
    """The tile (size, size, 3), sRGB codes from 0 to 255."""
    x, y = np.meshgrid(*2 * [(np.arange(size) + 0.5) / size])
    # One triangle stands for all eight: the centre is at (0, 0), the middle of an edge at (1, 0), a corner at (1, 1).
    across, up = abs(2 * x - 1), abs(2 * y - 1)
    a, b = np.maximum(across, up), np.minimum(across, up)
    centre, edge, corner = np.hypot(a, b), np.hypot(1 - a, b), np.hypot(1 - a, 1 - b)
    petals = 0.3 + 0.14 * np.cos(8 * np.arctan2(b, a))
    layers = [
        (corner < 0.74, SKY),
        (corner < 0.68, CREAM),
        (abs(corner - 0.44) < 0.1, BLUE),
        (corner < 0.2, OCHRE),
        (corner < 0.12, BLUE),
        (edge < 0.16, OCHRE),
        (edge < 0.09, CREAM),
        (centre < petals, OCHRE),
        (centre < 0.2, BLUE),
        (centre < 0.09, CREAM),
        (a > 0.985, GROUT),
    ]
    picture = np.full((size, size, 3), CREAM)
    for where, colour in layers:
        picture[where] = colour
    return picture


def main():
    """Write the tile with smooth edges."""
    fine = tile(SIZE * OVERSAMPLING).reshape(SIZE, OVERSAMPLING, SIZE, OVERSAMPLING, 3)
    pixels = np.rint(fine.mean(axis=(1, 3)) / 5).astype(np.uint8) * 5  # fewer colours make a smaller file
    OUTPUT.parent.mkdir(exist_ok=True)
    output = oiio.ImageOutput.create(str(OUTPUT))
    spec = oiio.ImageSpec(SIZE, SIZE, 3, "uint8")
    spec["png:compressionLevel"] = 9
    if not (output and output.open(str(OUTPUT), spec) and output.write_image(pixels)):
        raise SystemExit(oiio.geterror())
    output.close()
    print(f"{OUTPUT}: {OUTPUT.stat().st_size} bytes")


if __name__ == "__main__":
    main()
