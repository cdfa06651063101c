"""`python -m benchmarks [NAME ...]`: measure, write results/*.json, and rewrite the tables of README.md."""

import argparse
import importlib
import os

from .summary import summary
from .tables import rewrite_readme

BENCHMARKS = (
    "speed",
    "luxcore",
    "embree_share",
    "start_up",
    "memory",
    "threads",
    "triangles",
    "samplers",
    "correlation",
    "published",
    "fluorescence_cost",
    "colour_control",
    "findings",
)


def main():
    """Run what was asked for, by default everything."""
    options = parse()
    if options.summary:
        print(summary())
        return
    processors = os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else None
    for name in options.names if options.names is not None else BENCHMARKS:
        print(name, flush=True)
        importlib.import_module(f"benchmarks.{name}").run(options)
        if processors:
            os.sched_setaffinity(0, processors)  # some benchmarks keep to one
    rewrite_readme()


def parse():
    """The command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument(
        "names", nargs="*", metavar="NAME", help=f"any of: {', '.join(BENCHMARKS)}; default: all"
    )
    parser.add_argument(
        "--tables", action="store_true", help="only rewrite the tables from the results there are"
    )
    parser.add_argument("--summary", action="store_true", help="only print the table of the project's README")
    parser.add_argument(
        "--quick", action="store_true", help="fewer repeats and smaller sizes: to try the scripts"
    )
    parser.add_argument("--only", default="*", metavar="PATTERN", help="of findings, such as 'wavelengths_*'")
    parser.add_argument("--repeats", type=int, default=5, help="of every comparison (default: 5)")
    parser.add_argument(
        "--iterations", type=int, default=32, help="paths per pixel in comparisons (default: 32)"
    )
    parser.add_argument(
        "--mitsuba-python", metavar="PATH", help="a Python that has mitsuba; default: the one that runs this"
    )
    options = parser.parse_args()
    if unknown := set(options.names) - set(BENCHMARKS):
        parser.error(f"unknown: {', '.join(sorted(unknown))}; expected any of {', '.join(BENCHMARKS)}")
    options.names = [] if options.tables else options.names or None
    if options.quick:
        options.repeats, options.iterations = 2, 4
    return options


if __name__ == "__main__":
    main()
