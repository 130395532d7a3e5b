"""How much is tried: a sample by default, the same in every run; all of it with SYMOBS_FULL=1."""

import os

FULL = os.environ.get("SYMOBS_FULL") == "1"
