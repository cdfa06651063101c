"""`python -m artist_py` is the command `artist`."""

import sys

from artist_py.cli.main import main

if __name__ == "__main__":
    sys.exit(main())
