"""Write scenes/images/sky.exr: a clear sky without its sun, as a latitude-longitude image in linear sRGB.

Luminance is that of the CIE standard clear sky, type 12 (CIE S 011/E:2003); its colours are only chosen to look like
one. Below the horizon the ground reflects a fifth. Run from anywhere: `python scripts/make_sky.py`.
"""

from pathlib import Path

import numpy as np
import OpenImageIO as oiio

TARGET = Path(__file__).parent.parent / "scenes" / "images" / "sky.exr"
WIDTH, HEIGHT = 96, 48
SUN = np.array([-0.55, 0.45, 0.7])  # where the sun stands; scenes/sun_sky.toml has the same
GRADATION = -1.0, -0.32  # a and b of type 12
INDICATRIX = 10.0, -3.0, 0.45  # c, d and e
ZENITH = np.array([0.30, 0.55, 1.30])
HORIZON = np.array([0.85, 0.95, 1.10])
GROUND = np.array([0.16, 0.14, 0.11])


def directions():
    """Unit directions of the texels' centres, (h, w, 3): row 0 is up, the middle column is y, x is to its right."""
    theta = (np.arange(HEIGHT) + 0.5) / HEIGHT * np.pi
    angle = ((np.arange(WIDTH) + 0.5) / WIDTH - 0.5) * 2 * np.pi
    sine = np.sin(theta)[:, None]
    z = np.broadcast_to(np.cos(theta)[:, None], (HEIGHT, WIDTH))
    return np.stack([sine * np.sin(angle), sine * np.cos(angle), z], axis=2)


def relative_luminance(cos_zenith, to_sun):
    """CIE clear sky: gradation over the zenith angle times indicatrix over the angle to the sun, radians."""
    a, b = GRADATION
    c, d, e = INDICATRIX
    gradation = 1 + a * np.exp(b / np.maximum(cos_zenith, 0.01))
    indicatrix = 1 + c * (np.exp(d * to_sun) - np.exp(d * np.pi / 2)) + e * np.cos(to_sun) ** 2
    return gradation * indicatrix


def sky():
    """The image, float32 (h, w, 3); the mean over the sky is about 1."""
    towards = directions()
    z = towards[..., 2]
    to_sun = np.arccos(np.clip(towards @ (SUN / np.linalg.norm(SUN)), -1, 1))
    luminance = relative_luminance(z, to_sun)
    # One row more than the sky has, so that no ground shines through between the rows above the horizon.
    above = z > -np.pi / HEIGHT
    luminance /= luminance[z > 0].mean()
    blend = np.clip(z, 0, 1)[..., None] ** 0.4
    color = HORIZON * (1 - blend) + ZENITH * blend
    return np.where(above[..., None], luminance[..., None] * color, GROUND).astype(np.float32)


def main():
    """Write the image."""
    TARGET.parent.mkdir(exist_ok=True)
    spec = oiio.ImageSpec(WIDTH, HEIGHT, 3, "half")
    spec.attribute("compression", "zip")
    output = oiio.ImageOutput.create(str(TARGET))
    if not (output and output.open(str(TARGET), spec) and output.write_image(sky())):
        raise SystemExit(f"{TARGET}: {oiio.geterror()}")
    output.close()
    print(f"{TARGET}: {TARGET.stat().st_size} bytes")


if __name__ == "__main__":
    main()
