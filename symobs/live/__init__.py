"""Live: answers while a pole, a parameter or an entry is moved, each of them checked before it is shown.

`answer` is one pure function from a request to a response, both JSON objects of the protocol `symobs-live/1`.  Whatever
carries them (the server of `symobs serve`, a notebook, a worker in a browser) computes no mathematics of its own.
"""

from symobs.live.answering import answer

__all__ = ["answer"]
