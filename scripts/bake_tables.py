"""Writes artist_py/data/spectra.npz: observers, illuminants, ColorChecker patches, sRGB reflectance basis.

Needs the `colour-science` package, which artist_py itself never imports. The bytes written depend on the
tables alone, so that running it again leaves the repository unchanged. `--check` writes nothing and fails if
the file is not what would be written. Tables keep the spacing of their standard; in between they are linear.
"""

import argparse
import sys
import warnings
from pathlib import Path

import numpy as np

TARGET = Path(__file__).resolve().parent.parent / "artist_py" / "data" / "spectra.npz"

OBSERVERS = {
    "CIE 1931 2": "CIE 1931 2 Degree Standard Observer",
    "CIE 1964 10": "CIE 1964 10 Degree Standard Observer",
}
ILLUMINANTS = (
    ["B", "C", "D50", "D55", "D60", "D65", "D75", "ID50", "ID65"]
    + [f"FL{i}" for i in range(1, 13)]
    + [f"FL3.{i}" for i in range(1, 16)]
    + [f"HP{i}" for i in range(1, 6)]
    + [f"LED-B{i}" for i in range(1, 6)]
    + ["LED-BH1", "LED-RGB1", "LED-V1", "LED-V2"]
)
RANGE_NM = (300, 830)
DECIMALS = 10  # of what is computed here; the last bits depend on the machine


def main():
    """Writes the file, or checks it."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="compare with the file instead of writing it")
    check_only = parser.parse_args().check
    tables = baked_tables()
    if check_only:
        return 0 if is_current(tables) else f"{TARGET.name} is not what this script writes"
    with TARGET.open("wb") as file:
        np.savez_compressed(file, **tables)
    print(f"{TARGET.name}: {len(tables)} tables, {TARGET.stat().st_size} bytes")
    return 0


def baked_tables():
    """All tables by name; float64 (samples, 1 + columns), first column the wavelength in nm."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # colour reports the optional packages that it misses
        import colour
        from colour.recovery import MSDS_BASIS_FUNCTIONS_sRGB_MALLETT2019 as basis

    tables = {f"observer/{name}": knots(colour.MSDS_CMFS[theirs]) for name, theirs in OBSERVERS.items()}
    tables["illuminant/A"] = illuminant_a()
    tables["illuminant/E"] = np.array([[RANGE_NM[0], 1.0], [RANGE_NM[1], 1.0]])
    for name in ILLUMINANTS:
        tables[f"illuminant/{name}"] = knots(colour.SDS_ILLUMINANTS[name])
    for patch, reflectance in colour.SDS_COLOURCHECKERS["ColorChecker N Ohta"].items():
        patch_name = patch.split(" (")[0]  # without the density, as in "black 2 (1.5 D)"
        tables[f"reflectance/ColorChecker {patch_name}"] = knots(reflectance)
    tables["basis/sRGB"] = adjusted_basis(
        knots(basis), tables["illuminant/D65"], tables["observer/CIE 1931 2"]
    )
    return tables


def knots(distribution):
    """The samples of a `colour` distribution beside their wavelengths."""
    columns = np.asarray(distribution.values, dtype=np.float64).reshape(len(distribution.wavelengths), -1)
    return np.column_stack([distribution.wavelengths, columns])


def illuminant_a():
    """CIE standard illuminant A at 1 nm from its defining equation, 100 at 560 nm; CIE 15:2018, eq. 4.1."""
    nm = np.arange(RANGE_NM[0], RANGE_NM[1] + 1.0)
    c2_over_t = 1.435e7 / 2848.0  # nm; the values of 1931 that define A, not those of CODATA
    planck = (560.0 / nm) ** 5 * np.expm1(c2_over_t / 560.0) / np.expm1(c2_over_t / nm)
    return np.column_stack([nm, np.round(100.0 * planck, DECIMALS)])


def adjusted_basis(basis, d65, observer):
    """Mallett and Yuksel's basis, mixed by about 1e-3 so that it is exact for our tables.

    Theirs was optimised for sums over 5 nm; ours are averages over 1 nm, that is, values at bin centres. Under
    D65 an rgb reflectance shall have the colour rgb, relative to D65 itself, and the primaries add up to 1.
    """
    nm, primaries = basis[:, 0], basis[:, 1:] / basis[:, 1:].sum(axis=1, keepdims=True)
    centers = np.arange(nm[0], nm[-1]) + 0.5
    matching = np.array([np.interp(centers, observer[:, 0], column) for column in observer[:, 1:].T])
    under_d65 = xyz_to_srgb() @ (matching * np.interp(centers, *d65.T))
    seen = under_d65 @ np.array([np.interp(centers, nm, primary) for primary in primaries.T]).T
    mixing = np.linalg.solve(seen, np.diag(seen.sum(axis=1)))  # its rows sum to 1, hence white stays white
    red, green, _ = np.round(primaries @ mixing, DECIMALS).T
    adjusted = np.column_stack([red, green, 1.0 - red - green])
    if np.abs(mixing - np.eye(3)).max() > 3e-3 or adjusted.min() < 0.0:
        raise ValueError("the published basis is not what it was")
    return np.column_stack([nm, adjusted])


def xyz_to_srgb():
    """Linear sRGB of XYZ from the primaries and white of IEC 61966-2-1."""
    primaries = np.array([[0.64, 0.33, 0.03], [0.30, 0.60, 0.10], [0.15, 0.06, 0.79]]).T
    white = np.array([0.3127, 0.3290, 0.3583]) / 0.3290
    return np.linalg.inv(primaries * np.linalg.solve(primaries, white))


def is_current(tables):
    """Whether the packaged file holds exactly these tables."""
    with np.load(TARGET) as packaged:
        same_names = set(packaged.files) == set(tables)
        return same_names and all(np.array_equal(packaged[name], tables[name]) for name in tables)


if __name__ == "__main__":
    sys.exit(main())
