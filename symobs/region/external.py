"""Deciders that may be there: z3 (the extra `verify`) and the program qepcad.  Neither is required, neither is waited for.

Both are asked one question: is there a real point where polynomials are all positive?
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import threading
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from symobs.exact.functions import PI, known

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.exact import Scalar

#: Milliseconds for one question to z3, seconds for one to qepcad.
QUESTION, CELLS = 1500, 4.0
#: z3 is not asked about more terms, nor about higher degrees: what it does before it looks at the clock grows with both.
_TERMS, _DEGREE = 2_000, 24
#: qepcad is asked about few symbols of low degree.
_CELL_NAMES, _CELL_DEGREE, _CELL_TERMS = 4, 10, 120
_RELATIONS = {"positive": "> 0", "negative": "< 0", "nonnegative": ">= 0", "nonpositive": "<= 0", "nonzero": "/= 0"}


def names_of(values: Sequence[Scalar]) -> list[str]:
    """Return the names that occur, in order."""
    return sorted(set().union(*(value.names for value in values)))


def is_free(name: str) -> bool:
    """Tell whether a generator is a symbol that may take any value of its sign: not √2, not π."""
    return name != PI and known(name) is None


def point_by_z3(
    positive: Sequence[Scalar],
    signs: Mapping[str, str],
    *,
    not_above: Scalar | None = None,
    milliseconds: int = QUESTION,
) -> tuple[str, Mapping[str, Fraction]]:
    """Return `no` where no point of these signs makes all positive, else `maybe` with the point z3 has in mind, if any.

    A point comes back rounded where it is no rational number: who needs it has to look.
    """
    values = [*positive, *([] if not_above is None else [not_above])]
    if not _is_small(values, _TERMS, _DEGREE):
        return "maybe", {}
    try:
        import z3
    except ImportError:
        return "maybe", {}

    context = z3.Context()
    solver = z3.SolverFor("QF_NRA", ctx=context)
    solver.set("timeout", milliseconds)
    symbols = {name: z3.Real(f"x{k}", context) for k, name in enumerate(names_of(values))}
    tests = {"positive": lambda x: x > 0, "negative": lambda x: x < 0, "nonzero": lambda x: x != 0}
    tests |= {"nonnegative": lambda x: x >= 0, "nonpositive": lambda x: x <= 0}
    for name, symbol in symbols.items():
        if signs.get(name, "real") in tests:
            solver.add(tests[signs[name]](symbol))
    for value in positive:
        solver.add(_in_z3(value, symbols, z3, context) > 0)
    if not_above is not None:
        solver.add(_in_z3(not_above, symbols, z3, context) <= 0)
    # z3 does not look at its own clock everywhere.
    alarm = threading.Timer(2 * milliseconds / 1000, context.interrupt)
    alarm.start()
    try:
        verdict = str(solver.check())
        if verdict != "sat":
            return ("no" if verdict == "unsat" else "maybe"), {}
        model = solver.model()
        return "maybe", {name: _fraction(model.evaluate(s, model_completion=True), z3) for name, s in symbols.items()}
    except z3.Z3Exception:
        return "maybe", {}
    finally:
        alarm.cancel()


def none_by_z3(positive: Sequence[Scalar], signs: Mapping[str, str], *, not_above: Scalar | None = None) -> bool:
    """Tell whether z3 shows that no point makes all positive, and one value not positive."""
    return point_by_z3(positive, signs, not_above=not_above)[0] == "no"


def none_by_cells(positive: Sequence[Scalar], signs: Mapping[str, str], *, not_above: Scalar | None = None) -> str:
    """Return `yes` where qepcad finds that no point makes all positive (and one value not), `no` where one does."""
    program = shutil.which("qepcad")
    values = [*positive, *([] if not_above is None else [not_above])]
    names = names_of(values)
    if program is None or not 0 < len(names) <= _CELL_NAMES or not _is_small(values, _CELL_TERMS, _CELL_DEGREE):
        return "maybe"
    letters = {name: f"x{k}" for k, name in enumerate(names)}
    parts = [f"{letters[n]} {_RELATIONS[signs[n]]}" for n in names if signs.get(n, "real") in _RELATIONS]
    parts += [f"{_in_qepcad(value, letters)} > 0" for value in positive]
    parts += [] if not_above is None else [f"{_in_qepcad(not_above, letters)} <= 0"]
    quantifiers = "".join(f"(E {letter})" for letter in letters.values())
    formula = quantifiers + "[" + " /\\ ".join(parts) + "]."
    script = f"[region]\n({','.join(letters.values())})\n0\n{formula}\nfinish\n"
    try:
        output = _output_of(program, script)
    except (subprocess.TimeoutExpired, OSError):
        return "maybe"
    answer = output.partition("An equivalent quantifier-free formula:")[2].split()
    return {"TRUE": "no", "FALSE": "yes"}.get(answer[0] if answer else "", "maybe")


def _output_of(program: str, script: str) -> str:
    """Return what a program writes; after `CELLS` seconds it ends, and with it what it has started itself."""
    # A program found on PATH reads polynomials with integer coefficients in its own letters; there is no shell.
    pipe = subprocess.PIPE
    with subprocess.Popen(  # noqa: S603
        [program], stdin=pipe, stdout=pipe, stderr=pipe, text=True, start_new_session=True
    ) as run:
        try:
            return run.communicate(script, timeout=CELLS)[0]
        except subprocess.TimeoutExpired:
            os.killpg(run.pid, signal.SIGKILL)
            raise


def _is_small(values: Sequence[Scalar], terms: int, degree: int) -> bool:
    return (
        sum(value.size for value in values) <= terms
        and all(value.degrees()[0] <= degree for value in values)
        and all(value.denominator.is_constant and all(map(is_free, value.names)) for value in values)
    )


def _in_z3(value: Scalar, symbols: Mapping[str, Any], z3: Any, context: Any) -> Any:
    terms = []
    for coefficient, powers in value.each_term():
        product = z3.RealVal(coefficient, context)
        for name, exponent in powers:
            for _ in range(exponent):
                product = product * symbols[name]
        terms.append(product)
    return z3.Sum(terms) if terms else z3.RealVal(0, context)


def _fraction(value: Any, z3: Any) -> Fraction:
    found = value.approx(20) if z3.is_algebraic_value(value) else value
    return Fraction(found.numerator_as_long(), found.denominator_as_long())


def _in_qepcad(value: Scalar, letters: Mapping[str, str]) -> str:
    terms = []
    for coefficient, powers in value.each_term():
        terms.append(" ".join([f"({coefficient})", *(f"{letters[name]}^{exponent}" for name, exponent in powers)]))
    return " + ".join(terms) or "0"
