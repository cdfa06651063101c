"""Names of image channels: colour, auxiliary outputs, spectral bands."""

AOV_CHANNELS = {
    "normal": ("normal.X", "normal.Y", "normal.Z"),
    "shading_normal": ("shading_normal.X", "shading_normal.Y", "shading_normal.Z"),
    "albedo": ("albedo.R", "albedo.G", "albedo.B"),
    "depth": ("depth.Z",),
    "position": ("position.X", "position.Y", "position.Z"),
    "material": ("material.ID",),
    "variance": ("variance.R", "variance.G", "variance.B"),
}


def spectral_channel(wavelength):
    """Name of the channel of unpolarised radiance at `wavelength`, nm, such as `S0.550,000000nm`.

    The decimal sign is a comma because a dot separates layers. Fichet, Pacanowski and Wilkie 2021, section 3.
    """
    return f"S0.{wavelength:.6f}nm".replace(".", ",").replace("S0,", "S0.", 1)


def film_channels(film):
    """`(name, plane)` of each channel of `film`, planes (height, width): R G B, then AOVs, variance and bands."""
    channels = [(name, film.rgb[..., i]) for i, name in enumerate("RGB")]
    aovs = dict(film.aovs)
    if film.variance is not None:
        aovs["variance"] = film.variance
    for aov, values in aovs.items():
        names = AOV_CHANNELS[aov]
        planes = values.reshape(*values.shape[:2], -1)
        channels += [(name, planes[..., i]) for i, name in enumerate(names)]
    if film.spectral is not None:
        channels += [(spectral_channel(nm), film.spectral[..., i]) for i, nm in enumerate(film.band_centres)]
    return channels
