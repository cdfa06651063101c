"""The command `artist`: finds the subcommand, and turns every failure into one message and an exit code."""

import importlib
import os
import traceback

import click

from artist_py.cli.interrupt import INTERRUPTED
from artist_py.errors import ArtistError
from artist_py.version import __version__

SUBCOMMANDS = ("render", "check", "info", "tonemap", "diff", "converge", "compare", "stress", "warm")
INTERNAL_ERROR = 1
BAD_INPUT = 2

HELP = """\
Render scenes spectrally.

\b
  artist render scene.toml -o scene.exr --time 2m
  artist tonemap scene.exr scene.png --exposure auto

A scene is a TOML file. Exit codes: 0 done; 1 internal error, or an output that could not be written; 2 bad scene or
option; 130 interrupted, after the partial image was written. With ARTIST_DEBUG=1 errors show their traceback.

\b
Shell completion (bash; zsh and fish likewise):
  eval "$(_ARTIST_COMPLETE=bash_source artist)"
"""


class LazyGroup(click.Group):
    """A group that imports `cli/NAME.py` when subcommand NAME is needed."""

    def list_commands(self, _context):
        """Names in the order in which a user meets them."""
        return list(SUBCOMMANDS)

    def get_command(self, _context, name):
        """Subcommand `name`, or None."""
        return importlib.import_module(f"artist_py.cli.{name}").command if name in SUBCOMMANDS else None


@click.group(
    "artist",
    cls=LazyGroup,
    # Without values: click only takes from here what the user may have meant.
    commands=dict.fromkeys(SUBCOMMANDS),
    help=HELP,
    context_settings={"help_option_names": ["-h", "--help"], "show_default": True},
)
@click.version_option(__version__, prog_name="artist")
def command():
    """Hold the subcommands."""


def main(arguments=None):
    """Run the command line (default: that of the process); its exit code. Failures are printed, not raised."""
    try:
        code = command.main(arguments, prog_name="artist", standalone_mode=False)
    except (
        SystemExit
    ) as end:  # click's, after shell completion, or quietly when the reader of our output has left
        return end.code
    except (click.Abort, KeyboardInterrupt):
        return INTERRUPTED
    except click.ClickException as error:
        error.show()
        return BAD_INPUT
    except ArtistError as error:
        return _failure(error, str(error), error.exit_code)
    except Exception as error:  # noqa: BLE001  (a traceback is not for users)
        return _failure(error, _what(error), INTERNAL_ERROR)
    return code or 0


def _what(error):
    if isinstance(error, MemoryError):
        return "out of memory"
    what = f"internal error: {type(error).__name__}: {error}"
    return f"{what}\nPlease report it, with what it says when run again with ARTIST_DEBUG=1."


def _failure(error, message, code):
    if os.environ.get("ARTIST_DEBUG") == "1":
        message = "".join(traceback.format_exception(error)) + message
    click.echo(message, err=True)
    return code
