"""Children of the live server that sleep or swell where they are told to, and answer otherwise."""

from __future__ import annotations

import json
import os
import time

from symobs.ground.child_processes.inside import serve


def obey(body: bytes) -> bytes:
    """Do what a request says: sleep, take memory, or return the number of this process."""
    asked = json.loads(body)
    if asked.get("do") == "sleep":
        time.sleep(3600)
    if asked.get("do") == "swell":
        kept = []
        while True:
            kept.append(bytearray(1 << 24))
    return json.dumps({"process": os.getpid()}).encode()


if __name__ == "__main__":
    serve(lambda: None, obey)
