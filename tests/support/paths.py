"""Where the checkout lies."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).parents[2]
#: Where what is compiled lies in a checkout.
COMPILED = ".pytest_cache/bytecode"
