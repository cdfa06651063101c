"""`python -m gallery`: render the pictures that are out of date, and write index.html."""

import argparse
import os
import sys
from fnmatch import fnmatch
from pathlib import Path

from .page import write_page
from .plan import Manifest, all_pictures, details, together, update

FOLDER = Path(__file__).resolve().parent
LIST, SCENES = FOLDER / "pictures.toml", FOLDER.parent / "scenes"


def main():
    """Bring the gallery up to date; 1 if a picture could not be rendered."""
    options = parse()
    pictures, manifest = all_pictures(LIST, SCENES), Manifest(FOLDER)
    chosen = [each for each in pictures if is_named(each, options.names)]
    force = [each.name for each in chosen if options.again]
    if options.list:
        for each in chosen:
            print(f"{each.name:32} {'' if manifest.is_current(each) else 'out of date'}")
        return 0

    def paint(picture):
        from .painting import paint

        return paint(picture, FOLDER, options.threads)

    for file in manifest.forget_others(pictures):
        say(f"{file}: removed")
    try:
        failed = update(chosen, manifest, paint, say, force)
    except KeyboardInterrupt:
        print("interrupted; what is done is kept", file=sys.stderr)
        return 130
    finally:
        write_page(FOLDER, pictures, manifest.records, details(LIST), together(LIST))
    return 1 if failed else 0


def is_named(picture, names):
    """Whether one of the patterns fits; without patterns, always."""
    return not names or any(fnmatch(picture.name, name) for name in names)


def say(text):
    """A line of progress, at once."""
    print(text, flush=True)


def parse():
    """The command line."""
    parser = argparse.ArgumentParser(prog="python -m gallery", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="such as room-*; default: all")
    parser.add_argument("--again", action="store_true", help="render them even if nothing has changed")
    parser.add_argument("--list", action="store_true", help="only say which pictures there are")
    parser.add_argument("--threads", type=int, default=len(os.sched_getaffinity(0)), help="default: all")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
