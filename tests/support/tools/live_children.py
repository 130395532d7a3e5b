"""Children of the live server that sleep or swell where they are told to, and answer otherwise."""

from __future__ import annotations

import json
import os
import time
from typing import TYPE_CHECKING

from symobs.live.process import limit

if TYPE_CHECKING:
    from multiprocessing.connection import Connection


def obedient(connection: Connection, megabytes: int) -> None:
    """Do what a request says: sleep, take memory, or return the number of this process."""
    limit(megabytes)
    while True:
        try:
            body = json.loads(connection.recv_bytes())
        except (EOFError, OSError):
            return
        if body.get("do") == "sleep":
            time.sleep(3600)
        if body.get("do") == "swell":
            kept = []
            while True:
                kept.append(bytearray(1 << 24))
        connection.send_bytes(json.dumps({"process": os.getpid()}).encode())
