"""Tables on the standard output."""

import sys

WIDE = 200  # columns, where there is no terminal that could be too narrow


def print_table(header, lines, left=1):
    """Print texts in columns: the first `left` of them aligned to the left, the others to the right."""
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    console = Console() if sys.stdout.isatty() else Console(width=WIDE)
    table = Table(box=None, header_style="bold", pad_edge=False)
    for i, title in enumerate(header):
        table.add_column(Text(title), justify="left" if i < left else "right", overflow="fold")
    for line in lines:
        table.add_row(*(Text(cell) for cell in line))
    console.print(table)
