"""`python -m symobs.live.site OUT --pyodide FOLDER --flint WHEEL`: write the static site into a folder."""

from __future__ import annotations

import argparse
from pathlib import Path

from symobs.applications.live.site import build


def main() -> None:
    """Build the site from two things that were fetched before."""
    parser = argparse.ArgumentParser(
        prog="python -m symobs.live.site", description="Write live pages that need no server."
    )
    parser.add_argument("out", type=Path, metavar="OUT", help="the folder to write, which any static server can serve")
    parser.add_argument("--pyodide", type=Path, required=True, metavar="FOLDER", help="the npm package pyodide")
    parser.add_argument("--flint", type=Path, required=True, metavar="WHEEL", help="the wheel of python-flint for it")
    asked = parser.parse_args()
    try:
        size = build(asked.out, asked.pyodide, asked.flint)
    except OSError as error:
        parser.error(f"{error.filename or asked.out}: {error.strerror or error}")
    except ValueError as error:
        parser.error(str(error))
    print(f"{asked.out}: {size / 1e6:.1f} MB, {asked.out / 'index.html'}")  # noqa: T201 - a command


if __name__ == "__main__":
    main()
