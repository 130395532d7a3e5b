"""The page on exported questions names what there is."""

from __future__ import annotations

import re

from symobs.applications.export import PLATFORMS
from tests.support.tools.document_pages import text_of


def test_the_page_lists_every_platform() -> None:
    assert set(PLATFORMS) <= set(re.findall(r"`(\w+)`", text_of("exporting")))
