"""Programs that are compiled and run: 1,000 steps of each language beside the exact difference equation."""

from __future__ import annotations

import json
import random
import re
import shutil
import subprocess
import sys
from fractions import Fraction
from functools import cache
from typing import TYPE_CHECKING, Any

import mpmath
import pytest

import symobs
from tests.kit import SERVO, tabled
from tests.support.tools import octave
from tests.support.tools.modelica import Block

if TYPE_CHECKING:
    from pathlib import Path

STEPS = 1000
PENDULUM = symobs.StateSpace(
    "[0 1 0 0; 0 0 -981/1000 0; 0 0 0 1; 0 0 10791/500 0]", "[0; 1; 0; -2]", "[1 0 0 0; 0 0 1 0]"
)
WITH_FEEDTHROUGH = symobs.StateSpace("[0 1/3; -2 -3/7]", "[0 1; 1 0]", "[1 0]", "[1/3 2]")
SAMPLED = symobs.StateSpace("[1 1/10; 0 9/10]", "[1/200; 1/10]", "[1 0]", dt="1/10")
DESIGNS: dict[str, tuple[Any, str | None]] = {
    "compensator": (symobs.compensator(SERVO, control_poles="-2, -2", observer_poles="-10, -10"), "1/100"),
    "minimal compensator": (
        symobs.compensator(PENDULUM, control_poles="-1, -2, -3, -4", observer_poles="-5, -6", observer="minimal"),
        "1/500",
    ),
    "observer": (symobs.observer(WITH_FEEDTHROUGH, poles="-3 + 2i, -3 - 2i"), "1/30"),
    "reduced observer": (symobs.reduced_order_observer(WITH_FEEDTHROUGH, poles="-3"), "1/30"),
    "sampled": (symobs.compensator(SAMPLED, control_poles="4/5, 7/10", observer_poles="1/2, 3/5"), None),
}
CASES = [(name, hold) for name, (_, period) in DESIGNS.items() for hold in (("zoh", "tustin") if period else ("zoh",))]


def system_of(name: str) -> tuple[Any, Any, Any, Any, tuple[str, ...]]:
    """The matrices of a design by the formulas of the books, from K, L, F, G, H and M alone."""
    design, _ = DESIGNS[name]
    A, B, C, D = (getattr(design.plant, letter) for letter in "ABCD")
    n, one = A.shape[0], A.eye(A.shape[0])
    if name == "observer":
        driven = (B - design.L * D).row_join(design.L)
        return A - design.L * C, driven, one, one.zeros(n, driven.shape[1]), ("u", "y")
    if name == "reduced observer":
        p = C.shape[0]
        M = design.M
        return design.F, design.G.row_join(design.H), M[:, p:], (-M[:, :p] * D).row_join(M[:, :p]), ("u", "y")
    if name == "minimal compensator":
        estimator = symobs.reduced_order_observer(design.plant, poles="-5, -6")
        p, KM = C.shape[0], design.K * estimator.M
        N, K2 = KM[:, :p], KM[:, p:]
        return estimator.F - estimator.G * K2, estimator.H - estimator.G * N, -K2, -N, ("y",)
    closed = A - B * design.K - design.L * C + design.L * D * design.K
    return closed, design.L, -design.K, one.zeros(B.shape[1], C.shape[0]), ("y",)


def in_many_digits(matrix: Any) -> Any:
    return mpmath.matrix([[mpmath.mpf(int(q.p)) / int(q.q) for q in matrix.row(i)] for i in range(matrix.rows)])


def discretised(name: str, hold: str) -> tuple[Any, Any, Any, Any]:
    """Φ, Γ, C, D by Padé's exponential in mpmath, or by the bilinear map."""
    A, B, C, D, _ = system_of(name)
    period = DESIGNS[name][1]
    A, B, C, D = (in_many_digits(matrix) for matrix in (A, B, C, D))
    if period is None:
        return A, B, C, D
    h = mpmath.mpf(Fraction(period).numerator) / Fraction(period).denominator
    n, m = B.rows, B.cols
    if hold == "zoh":
        whole = mpmath.zeros(n + m)
        whole[:n, :n], whole[:n, n:] = A * h, B * h
        power = mpmath.expm(whole)
        return power[:n, :n], power[:n, n:], C, D
    inverse = (mpmath.eye(n) - A * h / 2) ** -1
    return inverse * (mpmath.eye(n) + A * h / 2), inverse * B * h, C * inverse, D + C * inverse * B * h / 2


def inputs_of(name: str) -> list[dict[str, list[float]]]:
    """Inputs of modulus at most 1 that decimals write exactly."""
    plant, signals = DESIGNS[name][0].plant, system_of(name)[4]
    sizes = {"u": plant.inputs, "y": plant.outputs}
    chosen = random.Random(name)  # noqa: S311 - a seeded draw
    return [{s: [chosen.randint(-1024, 1024) / 1024 for _ in range(sizes[s])] for s in signals} for _ in range(STEPS)]


@cache
def exact_outputs(name: str, hold: str) -> list[list[Fraction]]:
    """The outputs in fixed-point numbers of 240 bits, as integers."""
    bits = 240
    with mpmath.workdps(100):
        A, B, C, D = (
            [[int(mpmath.nint(entry * 2**bits)) for entry in row] for row in matrix.tolist()]
            for matrix in discretised(name, hold)
        )

    def times(rows: list[list[int]], column: list[int]) -> list[int]:
        return [sum(a * b for a, b in zip(row, column, strict=True)) >> bits for row in rows]

    x, found = [0] * len(A), []
    for given in inputs_of(name):
        w = [int(number * 1024) << (bits - 10) for entries in given.values() for number in entries]
        found.append([Fraction(c + d, 2**bits) for c, d in zip(times(C, x), times(D, w), strict=True)])
        x = [a + b for a, b in zip(times(A, x), times(B, w), strict=True)]
    return found


def assert_within_its_bound(text: str, outputs: list[list[float]], name: str, hold: str) -> None:
    stated = re.search(
        r"differs (?:at every step|in the first 1000 steps) by at most (\S+) from exact arithmetic", text
    )
    assert stated is not None
    exact = exact_outputs(name, hold)
    assert len(outputs) == STEPS
    pairs = [pair for own, true in zip(outputs, exact, strict=True) for pair in zip(own, true, strict=True)]
    off = max(abs(Fraction(number) - true) for number, true in pairs)
    assert off <= Fraction(stated[1]) < max(abs(true) for _, true in pairs) / 10**6


def text_of(name: str, hold: str, language: str) -> str:
    design, period = DESIGNS[name]
    return str(design.to(language, period=period, hold=hold))


def written(name: str) -> str:
    return "\n".join(" ".join(repr(n) for part in given.values() for n in part) for given in inputs_of(name)) + "\n"


@pytest.mark.parametrize(("name", "hold"), CASES)
def test_python(name: str, hold: str, tmp_path: Path) -> None:
    text = text_of(name, hold, "python")
    (tmp_path / "program.py").write_text(text, "utf-8")
    kind = "Observer" if "observer" in name else "Compensator"
    driver = (
        f"import json, sys, program\nsystem = program.{kind}()\n"
        "json.dump([system.step(**given) for given in json.load(sys.stdin)], sys.stdout)\n"
    )
    run = subprocess.run(
        [sys.executable, "-c", driver],
        cwd=tmp_path,
        input=json.dumps(inputs_of(name)),
        capture_output=True,
        text=True,
        check=True,
    )
    assert_within_its_bound(text, json.loads(run.stdout), name, hold)


@pytest.mark.skipif(shutil.which("gcc") is None, reason="gcc is not installed")
@pytest.mark.parametrize(("name", "hold"), CASES)
def test_c(name: str, hold: str, tmp_path: Path) -> None:
    text = text_of(name, hold, "c")
    assert not re.search(r"malloc|calloc|#include", text)
    kind = "observer" if "observer" in name else "compensator"
    sizes = {signal: len(entries) for signal, entries in inputs_of(name)[0].items()}
    outputs = len(exact_outputs(name, hold)[0])
    arrays = "".join(f" double {s}[{k}];" for s, k in sizes.items())
    reads = "".join(
        f'if (scanf("%lf", &{s}[{i}]) != 1) return 1;\n        ' for s, k in sizes.items() for i in range(k)
    )
    (tmp_path / "program.c").write_text(text, "utf-8")
    (tmp_path / "main.c").write_text(
        f'#include <stdio.h>\n#include "program.c"\nint main(void)\n{{\n'
        f"    {kind}_state state;{arrays} double v[{outputs}];\n"
        f"    {kind}_start(&state);\n    for (int k = 0; k < {STEPS}; k++) {{\n        {reads}\n"
        f"        {kind}_step(&state, {', '.join(sizes)}, v);\n"
        f'        for (int i = 0; i < {outputs}; i++) printf("%.17g ", v[i]);\n'
        '        printf("\\n");\n    }\n    return 0;\n}\n',
        encoding="utf-8",
    )
    strict = ["-std=c99", "-O2", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror"]
    compiled = subprocess.run(
        ["gcc", *strict, "main.c", "-o", "main"], cwd=tmp_path, check=False, capture_output=True, text=True
    )
    assert compiled.returncode == 0, compiled.stderr
    run = subprocess.run([tmp_path / "main"], input=written(name), capture_output=True, text=True, check=True)
    found = [[float(number) for number in line.split()] for line in run.stdout.splitlines()]
    assert_within_its_bound(text, found, name, hold)


@pytest.mark.skipif(shutil.which(octave.COMMAND) is None, reason="Octave is not installed")
def test_matlab_by_octave() -> None:
    questions, texts = [], []
    for number, (name, hold) in enumerate(CASES):
        text = text_of(name, hold, "matlab")
        kind = "observer" if "observer" in name else "compensator"
        own = text.replace(f"{kind}_step(", f"step_{number}(")
        given = inputs_of(name)
        arrays = [f"{s} = {octave.matrix([step[s] for step in given])};" for s in given[0]]
        called = ", ".join(f"{s}(k, :)'" for s in given[0])
        step = f"[v, state] = step_{number}(state, {called});"
        loop = f"found = []; state = [];\nfor k = 1:{STEPS}\n{step}\nfound(k, :) = v';\nend"
        texts.append(own)
        questions.append("\n".join([*arrays, loop, 'say("found", found);']))
    replies = octave.ask(questions, beginning="\n".join(texts))
    for (name, hold), text, reply in zip(CASES, texts, replies, strict=True):
        assert isinstance(reply, dict), reply
        assert_within_its_bound(text, reply["found"].real.tolist(), name, hold)


@pytest.mark.parametrize(("name", "hold"), CASES)
def test_modelica_by_a_reader_of_its_grammar(name: str, hold: str) -> None:
    text = text_of(name, hold, "modelica")
    block = Block(text)
    period = DESIGNS[name][1]
    assert block.period == (0.1 if period is None else float(Fraction(period)))
    assert_within_its_bound(text, block.run(inputs_of(name)), name, hold)


@pytest.mark.parametrize("name", [name for name, (_, period) in DESIGNS.items() if period])
def test_modelica_in_continuous_time(name: str) -> None:
    block = Block(str(DESIGNS[name][0].to("modelica")))
    assert block.period is None
    for letter, matrix in zip("ABCD", system_of(name), strict=False):
        entries = block.constants[letter].reshape(-1).tolist()
        assert entries == [float(Fraction(int(q.p), int(q.q))) for q in matrix]
    assert [left for left, *_ in block.equations] == ["der(x)", "x_hat" if "observer" in name else "u"]


@tabled
def test_the_reader_refuses_what_is_not_modelica(text: str) -> None:
    with pytest.raises(SyntaxError):
        Block(text)
