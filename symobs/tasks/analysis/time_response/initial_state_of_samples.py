"""The initial state from samples of the output:  y(k) = C Aᵏ x₀ + C x_f(k) + D u(k),  k = 0, …, N − 1.

Stacked, the samples less the forced output are O x₀ with O = [C; CA; …; CA^(N−1)]; where no x₀ solves this, a row w with
w O = 0 shows it.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, Self

from symobs.exact import Matrix, Scalar, kernel
from symobs.exact.core.generators import normal_form
from symobs.formula.tree import Environment, Literal
from symobs.formula.tree.term import Term, block, letter
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, ShapeMismatch
from symobs.proof.certificate.claims import Claim
from symobs.proof.derivation.builder import relation
from symobs.system.reading import as_rows, read_matrix
from symobs.tasks.analysis.rank.rank_test import rank_answer
from symobs.tasks.analysis.time_response.initial_state import InitialState
from symobs.tasks.result import page_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace
    from symobs.tasks.analysis.time_response.damping_cases import Signs

#: The forced output of N samples is a sum of N² products.
MOST_SAMPLES = 60


def read_samples(value: object, plant: StateSpace, name: str, rows: int) -> Matrix:
    """Return samples, a column for each instant; raises `InputError`, and `ShapeMismatch` for other than `rows` rows."""
    where = f"specification.{name}"
    if value is None:
        message = f"the samples of the {name} are missing"
        raise InputError(message, where=where, repair=f'give them from k = 0 on, {name} = "1, 3"')
    if isinstance(value, str) and not value.lstrip().startswith("["):
        value = f"[{value}]"
    found = read_matrix(as_rows("C", value), plant.symbols.seen(value), where, functions=True)
    if rows == 1 and found.shape[1] == 1:
        found = found.T
    if found.shape[0] != rows:
        message = f"{found.shape[0]} rows of samples of the {name}, but {rows} are expected"
        raise ShapeMismatch(message, where=where, repair="give a row for each signal, an entry for each instant")
    if found.shape[1] > MOST_SAMPLES:
        raise InputError(f"{found.shape[1]} samples of the {name}", where=where, repair=f"keep to {MOST_SAMPLES}")
    return found


@dataclass(frozen=True, eq=False, repr=False)
class InitialStateOfSamples(InitialState):
    """x₀ with O x₀ = r, the samples without the forced output; or the proof that there is none."""

    @classmethod
    def of(cls, plant: StateSpace, method_name: str, asked: Mapping[str, Any], taken: Signs) -> Self:
        """Return the result for a plant; `asked` holds the samples of the output and of the input."""
        m, y, u = plant.matrices, asked["output"], asked["input"]
        test = rank_answer(m.A, m.C)
        rows, state = [m.C], Matrix.zeros(plant.order, 1)
        right: list[Scalar] = []
        for k in range(y.shape[1]):
            sample = _column(y, k) - m.C @ state
            if u is not None:
                sample = sample - m.D @ _column(u, k)
                state = (m.A @ state + m.B @ _column(u, k)).normal()
            right += sample.entries
            rows.append((rows[-1] @ m.A).normal())
        O, r = Matrix.block([[row] for row in rows[:-1]]), Matrix.column(list(map(normal_form, right)))
        answer = {
            "output": y,
            "input": u,
            "rank": test,
            "taken": taken,
            "chosen": {},
            "stack": O,
            "right": r,
            "x0": None,
        }
        values = [Scalar.of(0)] * plant.order
        if test["columns"]:
            solution = test["matrix"].select(test["rows"], test["columns"]).solve(r.select(test["rows"], [0]))
            for place, index in enumerate(test["columns"]):
                values[index] = normal_form(solution[place, 0])
        candidate = Matrix.column(values)
        residual = Matrix.column([normal_form(entry) for entry in (r - O @ candidate).entries])
        if residual.is_zero:
            return cls(plant, method_name, {**answer, "x0": candidate})
        null = kernel(O.T)
        for j in range(null.shape[1]):
            w = _column(null, j).T
            value = normal_form((w @ r)[0, 0])
            if not value.is_zero:
                return cls(plant, method_name, {**answer, "row": w, "residual": residual, "refuted": (value,)})
        raise ArithmeticError("a residual that no row refutes")

    @property
    def matrices(self) -> tuple[Matrix | Scalar, ...]:
        """The samples and the state."""
        return tuple(self.answer[name] for name in ("output", "input", "x0") if self.answer.get(name) is not None)

    def claims(self) -> Iterator[Claim]:
        """Yield the stacked equations, and that the state solves them or that a row refutes them."""
        m, answer = self.plant.matrices, self.answer
        values = {"A": m.A, "B": m.B, "C": m.C, "D": m.D, "O": answer["stack"], "r_0": answer["right"]}
        values |= {} if answer["x0"] is None else {"x_0": answer["x0"]}
        e = Environment(variable=self.plant.variable, values=values, signs=self.plant.symbols.signs)
        O, r = letter("O", e), letter("r_0", e)
        yield Claim(relation(O, block([[row] for row in self.seen(e)])), e, "O stacks C*A**k")
        yield Claim(
            relation(r, block([[sample] for sample in self.free(e)])), e, "r is the output without that of the input"
        )
        if answer["x0"] is not None:
            yield Claim(relation(O @ letter("x_0", e), r), e, "O*x0 = r")
        else:
            w = Term(Literal(answer["row"]), e)
            yield Claim(relation(w @ O, Matrix.zeros(1, self.plant.order)), e, "w*O = 0")
            yield Claim(relation(w @ r, "!==", 0), e, "w*r is not 0")
        yield from self.observability_claims()

    def seen(self, e: Environment) -> list[Term]:
        """Return C Aᵏ for each sample."""
        A, C = letter("A", e), letter("C", e)
        return [C @ A**k if k else C for k in range(self.answer["output"].shape[1])]

    def free(self, e: Environment) -> list[Term]:
        """Return y(k) − Σ C A^(k−1−i) B u(i) − D u(k)."""
        A, B, C, D, y, u = *(letter(name, e) for name in "ABCD"), self.answer["output"], self.answer["input"]
        found = []
        for k in range(y.shape[1]):
            sample = Term(Literal(_column(y, k)), e)
            for i in range(k if u is not None else 0):
                if _column(u, i).is_zero:
                    continue
                power = C @ A ** (k - 1 - i) if k - 1 - i else C
                sample = sample - power @ B @ Term(Literal(_column(u, i)), e)
            if u is not None and self.plant.matrices.has_feedthrough and not _column(u, k).is_zero:
                sample = sample - D @ Term(Literal(_column(u, k)), e)
            found.append(sample)
        return found

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The state, the kernel where it is not the only one, and what is left where there is none."""
        residual = self.answer.get("residual")
        return super().fields | ({} if residual is None else {"residual": list(residual.entries)})


def _column(table: Matrix, index: int) -> Matrix:
    return table.select(range(table.shape[0]), [index])


@page_of(InitialStateOfSamples)
def write_initial_state(page: Builder, result: InitialStateOfSamples) -> None:
    """Write the stacked equations, and their solution or why there is none."""
    page.in_time(*result.everything())
    result.state_data(page)
    with page.section("initial_state"):
        result.write_branches(page, _write_branch)


def _write_branch(page: Builder, result: InitialStateOfSamples) -> None:
    """Write one branch."""
    answer = result.answer
    O = page.define("O", block([[row] for row in result.seen(page.environment)]), say="samples_stacked")
    samples = block([[sample] for sample in result.free(page.environment)])
    say = "samples_right" if answer["input"] is None else "samples_right_input"
    members = [samples] if answer["input"] is not None else []
    r = page.define("r_0", *members, answer["right"], say=say, closing=False)
    page.conclude_silently(relation(r, samples))
    if answer["x0"] is None:
        w = page.set("v", answer["row"].T)
        zero = relation(w.T @ O, Matrix.zeros(1, result.plant.order))
        rest = relation(w.T @ r, (w.T @ r).as_value, "!==", 0)
        page.remark("samples_inconsistent", row=relation(w, answer["row"].T), zero=zero, rest=rest)
        return
    x_0 = page.define(
        "x_0",
        answer["x0"],
        say="samples_found" if result.is_unique else "initial_not_unique",
        answer=True,
        closing=False,
    )
    if not result.is_unique:
        N = answer["rank"]["kernel"]
        say = "samples_kernel" if N.shape[1] == 1 else "samples_kernel_several"
        zeros = [relation(O @ page.value(_column(N, j)), Matrix.zeros(r.value.shape[0], 1)) for j in range(N.shape[1])]
        page.equal(*zeros, say=say)
    page.verified("samples_checked", check=relation(O @ x_0, r))
