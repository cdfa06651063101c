"""`python -m gallery`: render the pictures that are out of date, and write index.html."""

import argparse
import os
import sys
from fnmatch import fnmatch
from pathlib import Path

from .page import write_page
from .plan import Manifest, all_pictures, details, update

FOLDER = Path(__file__).resolve().parent
LIST, SCENES = FOLDER / "pictures.toml", FOLDER.parent / "scenes"


def main():
    """Bring the gallery up to date; 1 if a picture could not be rendered."""
    options = parse()
    pictures, manifest = all_pictures(LIST, SCENES), Manifest(FOLDER)
    force = [each.name for each in pictures if any(fnmatch(each.name, name) for name in options.again)]
    if options.list:
        for each in pictures:
            print(f"{each.name:32} {'' if manifest.is_current(each) else 'out of date'}")
        return 0

    def paint(picture):
        from .painting import paint

        return paint(picture, FOLDER, options.threads)

    try:
        failed = update(pictures, manifest, paint, say, force)
    except KeyboardInterrupt:
        print("interrupted; what is done is kept", file=sys.stderr)
        return 130
    write_page(FOLDER, pictures, manifest.records, details(LIST))
    return 1 if failed else 0


def say(text):
    """A line of progress, at once."""
    print(text, flush=True)


def parse():
    """The command line."""
    parser = argparse.ArgumentParser(prog="python -m gallery", description=__doc__)
    parser.add_argument(
        "--again", action="append", default=[], metavar="NAME", help="render this one again; * for all"
    )
    parser.add_argument("--list", action="store_true", help="only say which pictures there are")
    parser.add_argument("--threads", type=int, default=len(os.sched_getaffinity(0)), help="default: all")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
