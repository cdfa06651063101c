"""`artist diff`: how far an image is from another, and whether that is too far."""

import click

from artist_py.cli.options import Number

METRICS = ("relmse", "smape", "mse", "flip", "de2000", "z")  # as artist_py/compare/diff.py, which loads NumPy
DIFFERENT = 1  # exit code
SHOWN_BANDS = 8


@click.command()
@click.argument("image", metavar="IMAGE", type=click.Path())
@click.argument("reference", metavar="REFERENCE", type=click.Path())
@click.option(
    "--metric",
    type=click.Choice(METRICS),
    default="relmse",
    help="relmse, smape and mse compare linear values; flip what people see when they flip between the images; de2000 "
    "colours by CIEDE2000, where RGB 1 is white; z whether both may show the same, by their layers of variance.",
)
@click.option(
    "--threshold",
    type=Number(min=0),
    metavar="X",
    help="Largest value that is allowed: beyond it, the exit code is 1. For z, the probability of a false alarm below "
    "which the images differ (0.001 unless given). Of spectral images each band is held against it.",
)
@click.option("-o", "--output", type=click.Path(), metavar="FILE.png", help="Write a map of the errors.")
@click.option("-q", "--quiet", is_flag=True, help="Print nothing but errors.")
def command(image, reference, metric, threshold, output, quiet):
    """Compare two images.

    Says how far IMAGE is from REFERENCE. Both are .exr, with colours or spectral channels, or both .png. The exit code
    is 1 above the threshold, and where a threshold is given and pixels are not finite; 2 where images cannot be
    compared.
    """
    from artist_py.compare.diff import FALSE_ALARM, difference
    from artist_py.compare.pair import read_pair

    if output:
        from artist_py.film.output import check_output

        _check_png(output)
        check_output(output)
    pair = read_pair(image, reference)
    result = difference(pair, metric)
    if metric == "z" and threshold is None:
        threshold = FALSE_ALARM
    if not quiet:
        _print(pair, result)
    if output:
        _write(output, result, quiet)
    is_different = threshold is not None and result.is_above(threshold)
    if not quiet and threshold is not None:
        click.echo(_verdict(result, threshold, is_different))
    return DIFFERENT if is_different else 0


def _check_png(output):
    if not output.lower().endswith(".png"):
        raise click.UsageError(f"--output {output}: maps of errors are written as .png")


def _print(pair, result):
    for note in (*pair.notes, result.note) if result.note else pair.notes:
        click.echo(f"warning: {note}", err=True)
    x, y = result.worst
    click.echo(f"{result.metric} {result.value:.6g}; worst pixel x {x}, y {y}: {result.worst_value:.6g}")
    parts = {name: value for name, value in result.parts.items() if name not in {"RGB", "p"}}
    bands = {name: value for name, value in parts.items() if name.endswith(" nm")}
    for name, value in parts.items():
        if name not in bands:
            click.echo(f"  {name}: {value:.6g}")
    if len(parts) > len(bands) and "RGB" in result.parts and bands:
        click.echo(f"  RGB together: {result.parts['RGB']:.6g}")
    worst = sorted(bands, key=bands.get, reverse=True)[:SHOWN_BANDS]
    for name in (name for name in bands if name in worst):
        click.echo(f"  {name}: {bands[name]:.6g}")
    if len(bands) > SHOWN_BANDS:
        click.echo(f"  {len(bands) - SHOWN_BANDS} other bands: no more")


def _write(output, result, quiet):
    from artist_py.compare.heat import write_heat

    low, high, is_logarithmic = write_heat(output, result.map, result.metric)
    if not quiet:
        scale = "logarithmic" if is_logarithmic else "linear"
        click.echo(f"wrote {output}: black is {low:.3g}, light yellow {high:.3g}, {scale}")


def _verdict(result, threshold, is_different):
    if result.n_bad:
        return f"different: {result.n_bad} pixels are not finite"
    if result.metric == "z":
        relation = "below" if is_different else "not below"
        outcome = "different" if is_different else "they may show the same"
        return f"{outcome}: p is {relation} {threshold:g}"
    return f"{'different: above' if is_different else 'within'} {threshold:g}"
