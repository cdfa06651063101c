"""`artist tonemap`: a linear image to one that a screen shows."""

import click

from artist_py.cli.options import WhitePoint, display_options
from artist_py.errors import OptionError


@click.command()
@click.argument("image", metavar="IN.exr", type=click.Path())
@click.argument("output", metavar="OUT.png", type=click.Path())
@click.option(
    "--operator",
    type=click.Choice(["srgb", "filmic", "linear"]),
    default="srgb",
    help="srgb clips what is too bright; filmic rolls it off; linear is srgb without its encoding, for measurements.",
)
@click.option(
    "--white-point",
    type=WhitePoint(),
    default="D65",
    help="What looks white: a CIE illuminant such as D65 or A, or chromaticity x,y.",
)
@display_options
def command(**options):  # click's way to pass options, by the names they have above
    """Make a linear image visible.

    Writes the linear image IN.exr as the display image OUT.png.

    --exposure auto makes the geometric mean luminance a middle grey.
    """
    from artist_py.film.output import check_output, write_display
    from artist_py.film.reading import read_image
    from artist_py.film.tonemap import ToneMapping

    image, output = options.pop("image"), options.pop("output")
    check_output(output)
    rgb = read_image(image).rgb
    if rgb is None:
        raise OptionError(f"{image}: has no channels R, G and B")
    write_display(output, rgb, ToneMapping(**options))
