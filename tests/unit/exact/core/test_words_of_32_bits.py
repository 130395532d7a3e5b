"""FLINT's word has 32 bits on some platforms: primes fit in it, and the stated bound holds by drawing more points."""

from __future__ import annotations

import json
import subprocess
import sys

from sympy import isprime

from symobs.exact.core.modular import LARGEST_PRIME, PRIME_BITS
from tests.support.tools.command_line import SAFETY, environment

_ON_32_BITS = """
import sys
word = sys.maxsize
sys.maxsize = 2**31 - 1
import symobs.exact.core.modular as modular
sys.maxsize = word
import json, random, symobs
primes = [modular.random_prime(random.Random(seed)) for seed in range(40)]
design = symobs.observer(
    symobs.StateSpace("[0 1 0 0; a 0 b 0; 0 0 0 1; c 0 d e]", C="[1 0 0 f]"), poles=["-p", "-q", "-r", "-1"]
)
singular = symobs.observability(symobs.StateSpace("[1 0; 0 1]", C="[1 1]"))
region = symobs.stability_region(polynomial="s^3 + a s^2 + b s + a b + 1 - a^2", parameters=["a", "b"])
print(json.dumps({
    "primes": primes, "largest": modular.LARGEST_PRIME, "below": modular.PRIMES_BELOW, "rank": singular.rank,
    "region": region.verdict, "claims": [[c.how, c.bound] for c in design.all_certificates],
}))
"""


def test_claims_are_checked_with_primes_of_32_bits() -> None:
    run = subprocess.run(
        [sys.executable, "-c", _ON_32_BITS],
        env=environment(),
        capture_output=True,
        text=True,
        timeout=SAFETY,
        check=True,
    )
    found = json.loads(run.stdout)
    assert all(2**31 < prime < 2**32 and isprime(prime) for prime in [*found["primes"], found["largest"]])
    # From π(2³²) = 203,280,221 and π(2³¹) = 105,097,565.
    assert found["below"] <= 203_280_221 - 105_097_565
    assert (found["rank"], found["region"]) == (1, "conditional")
    random = [(how, bound) for how, bound in found["claims"] if "random" in how]
    assert random
    assert all("modulo 32-bit primes" in how and 0 < float(bound) <= 2.0**-50 for how, bound in random)


def test_the_largest_prime_of_this_word() -> None:
    assert isprime(LARGEST_PRIME)
    assert LARGEST_PRIME < 2**PRIME_BITS
    assert not any(isprime(candidate) for candidate in range(LARGEST_PRIME + 1, 2**PRIME_BITS))
