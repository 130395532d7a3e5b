"""`python -m symobs`, and the program `symobs`."""

import os
import sys
from contextlib import suppress
from typing import NoReturn

_INTERRUPTED = 130


def main() -> NoReturn:
    """Run the command line; one that is interrupted before it is there says so too."""
    try:
        from symobs.cli import main as run  # noqa: PLC0415 - what is imported here can be interrupted

        run()
    except KeyboardInterrupt:
        sys.stderr.write("interrupted\n")
    except SystemExit as leaving:
        if leaving.code != _INTERRUPTED:
            raise
    # Where the interrupt came upon code made of text (a dataclass that is imported), Python remembers it and would end
    # by the signal, whatever exit code it is given.
    with suppress(OSError, ValueError, AttributeError):
        sys.stderr.flush()
    os._exit(_INTERRUPTED)


if __name__ == "__main__":
    main()
