"""The input of least energy from x₀ to x_f:  u(t) = Bᵀ e^{Aᵀ(T−t)} λ  with  W λ = d,  d = x_f − e^{AT} x₀,  ∫ uᵀu dt = dᵀ λ.

W is the controllability Gramian over the horizon.  Where it is singular, d must lie in its image, which is that of [B, AB, …].
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, NotRequired, Self, TypedDict

from symobs.exact import Matrix, Scalar, independent_rows
from symobs.exact.core.generators import function_named, identities, normal_form, substitute
from symobs.exact.time_functions.quasipolynomial import table_of
from symobs.formula.phrases.languages import Counted
from symobs.formula.tree import Literal
from symobs.formula.tree.calculus import since_start
from symobs.formula.tree.term import block, identity, letter
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError
from symobs.proof.derivation.builder import relation
from symobs.system.conditions import Condition, vanishing_factors
from symobs.system.specification import read_gain
from symobs.tasks.analysis.time_response.damping_cases import (
    DampingAnswer,
    DampingCases,
    Signs,
    rate_of,
    reject,
    time_environment,
)
from symobs.tasks.analysis.time_response.gramian import Gramian, GramianAnswer
from symobs.tasks.analysis.time_response.horizons import over_horizon, read_horizon
from symobs.tasks.analysis.time_response.initial_state_covariance import too_long
from symobs.tasks.analysis.time_response.matrix_exponential import (
    TIME,
    closed_form,
    require_continuous,
    tell_exponential,
    tell_polynomial,
    tell_question,
)
from symobs.tasks.result import Result, choose, holds, method, page_of, task
from symobs.tasks.result.answers import named_found, those_found

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.formula.tree import Environment
    from symobs.formula.tree.term import Term
    from symobs.proof.certificate.claims import Certificate, Claim
    from symobs.proof.derivation.builder import Builder
    from symobs.system import StateSpace
    from symobs.system.specification import Horizon, MatrixText, Name


class MinimumEnergyAsked(TypedDict):
    """The horizon and both states."""

    horizon: Scalar
    initial: Matrix
    final: Matrix


class MinimumEnergyAnswer(MinimumEnergyAsked, DampingAnswer):
    """The input, the Gramian, d, λ and the energy; or w and wᵀ d, which refute the final state."""

    input: Matrix | None
    gramian: Matrix | None
    difference: NotRequired[Matrix]
    multiplier: NotRequired[Matrix]
    energy: NotRequired[Scalar]
    w: NotRequired[Matrix]
    left: NotRequired[Scalar]


@dataclass
class MinimumEnergyInput(DampingCases):
    """λ with W λ = d, the input u = Bᵀ e^{Aᵀ(T−t)} λ and its energy dᵀ λ; or w with wᵀ [B, AB, …] = 0 and wᵀ d ≠ 0.

    `inner` is the controllability Gramian, with its own claims.
    """

    answer: MinimumEnergyAnswer
    inner: Gramian

    task: ClassVar[str] = "minimum_energy_input"
    answered_by = ("input",)
    letters = {"input": "u_t", "energy": "E_u", "gramian": "W"}
    main: ClassVar[str] = "input"
    asked_for: ClassVar[tuple[str, ...]] = ("horizon", "initial", "final")

    @classmethod
    def of(cls, plant: StateSpace, method_name: str, asked: MinimumEnergyAsked, taken: Signs) -> Self:
        """Return the result for a plant."""
        end = asked["horizon"]
        inner = Gramian.of(plant, "integral", {"of": "controllability", "horizon": end}, taken)
        known, W = inner.answer, inner.answer["matrix"]
        answer: MinimumEnergyAnswer = {
            "horizon": end,
            "initial": asked["initial"],
            "final": asked["final"],
            "taken": taken,
            "chosen": known["chosen"],
            "input": None,
            "gramian": W,
        }
        if W is None:
            answer |= {"question": known["question"], "factor": known["factor"]}
            return cls(plant, method_name, answer, inner)
        if not plant.is_discrete and (open_question := _open_question(plant, known)):
            return cls(plant, method_name, {**answer, "question": open_question, "factor": None}, inner)
        powers = _powers(plant, inner, end)
        moved = (asked["final"] - powers[0] @ asked["initial"]).normal()
        answer["difference"] = d = _written(moved)
        N = known["rank"]["kernel"]
        for j in range(N.shape[1]):
            w = N.select(range(N.shape[0]), [j])
            left = normal_form(plant.simplified((w.T @ d)[0, 0]))
            if not left.is_zero:
                return cls(plant, method_name, {**answer, "w": w, "left": left}, inner)
        balance = W, d
        if not plant.is_discrete:
            balance = _in_common_exponentials(W), _in_common_exponentials(d)
        answer["multiplier"] = lam = _written(_solved(*balance, independent_rows(N, plant.ideal)))
        rows = [plant.matrices.B.T @ power.T @ lam for power in powers[1:]]
        answer["input"] = _written(Matrix.block([rows]))
        answer["energy"] = normal_form((d.T @ lam)[0, 0])
        return cls(plant, method_name, answer, inner)

    @property
    def matrices(self) -> tuple[Matrix | Scalar, ...]:
        """The functions of time and of the horizon."""
        answer = self.answer
        found = answer.get("difference"), answer.get("multiplier"), answer["input"], answer.get("energy")
        return those_found(answer["initial"], answer["final"], *found, answer.get("left"), *self.inner.matrices)

    @property
    def all_certificates(self) -> tuple[Certificate, ...]:
        """The certificates of the Gramian and of the input."""
        return (*self.inner.certificates, *self.certificates)

    @property
    def verdict(self) -> str:
        """`no` where the final state cannot be reached."""
        return "no" if self.answer.get("w") is not None else super().verdict

    @property
    def has_answer(self) -> bool:
        """Whether there is one in general."""
        return self.answer.get("w") is None

    @property
    def further_zeros(self) -> tuple[Scalar, ...]:
        """Where less is reachable, and where what shows that d is not may vanish."""
        return tuple(dict.fromkeys((*self.inner.further_zeros, *self._refuting)))

    @property
    def _refuting(self) -> tuple[Scalar, ...]:
        left = self.answer.get("left")
        return () if left is None else vanishing_factors([left], self.plant.symbols.signs)

    @cached_property
    def holds_where(self) -> tuple[Condition, ...]:
        """That no rank is lost is a condition of an input."""
        known = super().holds_where
        told = {c.expression for c in known}
        zeros = self.inner.further_zeros if self.has_answer else ()
        return (*known, *(Condition("existence", f) for f in zeros if f not in told))

    def claims(self) -> Iterator[Claim]:
        """Yield W λ = d, the input, and its energy; or the row that excludes the final state."""
        yield from super().claims()
        known = self.inner.answer
        if (self.answer["gramian"], self.answer["horizon"]) != (known["matrix"], known["horizon"]):
            reject("the Gramian or its horizon is another one")
        if self.inner.plant != self.plant:
            reject("the Gramian is that of another plant")
        if self.answer.get("question") is not None:
            return
        answer, inner, m = self.answer, self.inner, self.plant.matrices
        if (answer.get("w") is None) != (answer.get("multiplier") is not None):
            reject("an input exists exactly where no row shows that there is none")
        values: dict[str, Matrix | Scalar | None] = {
            "d_r": answer.get("difference"),
            "lam_e": answer.get("multiplier"),
            "u_t": answer["input"],
            "E_u": answer.get("energy"),
            "x_0": answer["initial"],
            "x_1f": answer["final"],
            "W": answer["gramian"],
            "w": answer.get("w"),
        }
        powers = _powers(self.plant, inner, answer["horizon"])
        values |= {"A": m.A, "B": m.B, **{f"Phi_{k}": power for k, power in enumerate(powers)}}
        e = time_environment(self.plant, named_found(values), None if self.plant.is_discrete else answer["horizon"])
        yield from self._about_powers(e, len(powers))
        yield holds(e, "d_r = x_1f - Phi_0 x_0")
        if answer.get("w") is not None:
            B, A = letter("B", e), letter("A", e)
            count = _seen_steps(self)
            reached = block([[A**k @ B if k else B for k in range(count)]])
            yield holds(e, "w.T {reached} = 0", reached=reached)
            yield holds(e, "w.T d_r !== 0")
            return
        lam = letter("lam_e", e)
        yield holds(e, "W lam_e = d_r")
        shown = block([[letter("B", e).T @ letter(f"Phi_{k}", e).T @ lam for k in range(1, len(powers))]])
        yield holds(e, "u_t = {shown}", shown=shown)
        yield holds(e, "E_u = d_r.T lam_e")

    def _about_powers(self, e: Environment, count: int) -> Iterator[Claim]:
        """Yield what e^{AT} and e^{A(T−t)}, or the powers of A, are."""
        A, end = letter("A", e), self.answer["horizon"]
        if self.plant.is_discrete:
            for k in range(count):
                power = (
                    A ** (count - 1 if k == 0 else count - 1 - k) if k < count - 1 else identity(self.plant.order, e)
                )
                yield holds(e, f"Phi_{k} = {{power}}", "a power of A", power=power)
            return
        back = letter("Phi_1", e)
        yield holds(e, "{rate} = -A Phi_1", rate=rate_of(back))
        yield holds(e, "{end} = I", end=back.at("t", end))
        yield holds(e, "Phi_1(t = 0) = Phi_0")

    @cached_property
    def fields(self) -> Mapping[str, Any]:
        """The input, its energy and the Gramian; where there is none, the row that shows it."""
        u, w, asked = self.answer["input"], self.answer.get("w"), self.answer.get("question")
        shown: object = u
        if u is not None and 1 in u.shape:
            shown = u[0, 0] if u.shape == (1, 1) and not self.plant.is_discrete else list(u.entries)
        found = {"input": shown, "energy": self.answer.get("energy"), "gramian": self.answer["gramian"]}
        found |= {"unreachable": None if w is None else list(w.entries)}
        return {**found, **({"question": asked} if asked else {})}


def _open_question(plant: StateSpace, known: GramianAnswer) -> str:
    """Return the question that stays open where the Gramian cannot be inverted readably."""
    if "exponential" not in known:
        return f"the inverse of the {plant.order}x{plant.order} Gramian, whose entries are sums over roots"
    pair = plant.matrices.A.T, plant.matrices.B.T
    return too_long(*pair, table_of(known["exponential"])) if pair[0].names else ""


def _has_functions(value: Scalar) -> bool:
    return any(function_named(name) for name in value.names)


def _written(matrix: Matrix) -> Matrix:
    return Matrix.of([[normal_form(entry) for entry in row] for row in matrix.normal().rows], matrix.shape[1])


def _seen_steps(result: MinimumEnergyInput) -> int:
    """Return how many of B, AB, … span what is reachable: n, and in discrete time no more than there are steps."""
    order, end = result.plant.order, result.answer["horizon"]
    return min(order, int(end.fraction())) if result.plant.is_discrete else order


def _powers(plant: StateSpace, inner: Gramian, end: Scalar) -> list[Matrix]:
    """Return e^{AT} and e^{A(T−t)}; in discrete time A^N, and A^{N−1}, …, A, I."""
    if plant.is_discrete:
        found = [Matrix.identity(plant.order)]
        for _ in range(int(end.fraction())):
            found.insert(0, (found[0] @ plant.matrices.A).normal())
        return found
    exponential = inner.answer["exponential"].T
    return [substitute(exponential, {"t": end}), substitute(exponential, {"t": end - TIME})]


def _in_common_exponentials(matrix: Matrix) -> Matrix:
    """Return a matrix with its exponentials written in powers of common ones, so that factors cancel."""
    meanings, _ = identities([matrix], falling=True)
    return matrix.substitute({n: v for n, v in meanings.items() if n.startswith("exp(") and n not in v.names})


def _solved(W: Matrix, d: Matrix, hidden: tuple[int, ...]) -> Matrix:
    """Return a λ with W λ = d, 0 in as many places as W has a kernel, chosen so that the others are independent."""
    kept = [i for i in range(W.shape[0]) if i not in hidden]
    values = [Scalar.of(0)] * W.shape[0]
    if kept:
        found = W.select(kept, kept).solve(d.select(kept, [0]))
        for place, index in enumerate(kept):
            values[index] = found[place, 0]
    return Matrix.column(values)


@method("minimum_energy_input/gramian", source="kalman1963a; kailath1980, ch. 9")
def by_gramian(plant: StateSpace, asked: MinimumEnergyAsked) -> MinimumEnergyInput:
    """Solve W λ = x_f − e^{AT} x₀ for λ; then u(t) = Bᵀ e^{Aᵀ(T−t)} λ."""
    return MinimumEnergyInput.of(plant, "gramian", asked, {})


@task
def minimum_energy_input(
    plant: StateSpace,
    *,
    initial: MatrixText = None,
    final: MatrixText = None,
    horizon: Horizon = None,
    method: Name = "auto",
) -> Result:
    """Return the input of least energy ∫ uᵀu dt (Σ uᵀu) from x₀ to x_f: u = Bᵀ e^{Aᵀ(T−t)} W⁻¹ (x_f − e^{AT} x₀).

    plant    n states, m inputs
    initial  x₀; 0 where it is left out
    final    x_f; 0 where it is left out
    horizon  T > 0, a symbol or a number ("T" if left out); in discrete time a number of steps (n if left out)
    Returns input (u(t) in t; in discrete time u(0), u(1), …, columns for several inputs), energy, gramian, and unreachable
    (where x_f is not reached: a vector w, orthogonal to all that is reachable, with wᵀ (x_f − e^{AT} x₀) ≠ 0).
    Raises `InputError` where neither state is given and for an infinite horizon; `ShapeMismatch`.
    Source: R. E. Kalman, Y. C. Ho and K. S. Narendra (1963); T. Kailath (1980), ch. 9.
    """
    plant = plant.knowing(initial, final)
    plant.require("B", task="minimum_energy_input")
    if initial is None and final is None:
        message = "neither an initial nor a final state is given"
        raise InputError(
            message, where="specification.final", repair=f'give final = "{", ".join(["1"] * plant.order)}"'
        )
    size, end = (plant.order, 1), read_horizon(plant, horizon)
    states = {"initial": initial, "final": final}
    given = {n: Matrix.zeros(*size) if v is None else read_gain(v, plant, n, size) for n, v in states.items()}
    if isinstance(end, str):
        message = "the final state is to be reached at a finite time"
        raise InputError(message, where="specification.horizon", repair='write "T", or a number above 0')
    if "t" in end.names:
        message = "the input is a function of t, which cannot be its horizon, too"
        raise InputError(message, where="specification.horizon", repair='write "T", or a number above 0')
    if not plant.is_discrete:
        require_continuous(plant, "minimum_energy_input")
    asked: MinimumEnergyAsked = {"horizon": end, "initial": given["initial"], "final": given["final"]}
    return over_horizon(lambda: choose("minimum_energy_input", method, "gramian").solve(plant, asked))


# The page: e^{At}, what is to be bridged, the Gramian, λ, the input, its energy.


@page_of(MinimumEnergyInput)
def write_minimum_energy_input(page: Builder, result: MinimumEnergyInput) -> None:
    """Write the whole page."""
    end = result.answer["horizon"]
    powers = _powers(result.plant, result.inner, end) if "difference" in result.answer else []
    page.in_time(*result.everything(), *powers, at=None if result.plant.is_discrete else end)
    result.state_data(page)
    with page.section("minimum_energy_input"):
        if not result.plant.is_discrete:
            tell_polynomial(page)
        result.write_branches(page, _write_branch)


def _write_branch(page: Builder, result: MinimumEnergyInput) -> None:
    answer, plant, A = result.answer, result.plant, page["A"]
    u, known, end = answer["input"], answer["gramian"], answer["horizon"]
    if known is None:
        tell_question(page, answer["factor"])
        return
    if "question" in answer:
        page.remark("energy_open")
        return
    powers = _powers(plant, result.inner, end)
    x_0, x_f = page.set("x_0", answer["initial"]), page.set("x_1f", answer["final"])
    stated = (page.line("x_0 = #"), page.line("x_1f = #"))
    steps = len(powers) - 1
    if plant.is_discrete:
        page.equal(*stated, say="energy_states_discrete")
        over = A**steps
    else:
        beside = () if end == Scalar.symbol("T") else (relation(page.set("T_h", end), end),)
        page.equal(*stated, *beside, say="energy_states")
        found, _ = closed_form(plant, {**answer["taken"], **answer["chosen"]})
        tell_exponential(page, found, result.inner.answer["exponential"].T)
        over = page.set("Phi_T", powers[0])
        page.conclude_silently(relation(over, page["exp_At"].at("t", end)))
    d = page.define("d_r", x_f - over @ x_0, answer["difference"], say="energy_difference", closing=False)
    if u is None:
        _tell_unreachable(page, result, d)
        return
    W = _tell_gramian(page, result, known)
    lam = page.define("lam_e", page.value(answer["multiplier"]), say="energy_multiplier", closing=False)
    page.verified("energy_solved", equation=relation(W @ lam, d))
    if plant.is_discrete:
        moved = [
            page("B.T {k} lam_e", k=A.T ** (steps - 1 - k)) if k < steps - 1 else page["B.T lam_e"]
            for k in range(steps)
        ]
        page.define("U_k", block([moved]), u, say="energy_sequence", closing=False, answer=True)
    else:
        back = page.set("Phi_b", powers[1])
        page.conclude_silently(
            page.line("{rate} = -A Phi_b", rate=rate_of(back)), page.line("{end} = I", end=back.at("t", end))
        )
        page.define(
            "u_t",
            "B.T Phi_b.T lam_e",
            u[0, 0] if u.shape == (1, 1) else u,
            say="energy_input",
            closing=False,
            answer=True,
        )
    page.define(
        "E_u",
        "d_r.T lam_e",
        answer["energy"],
        say="energy_spent_discrete" if plant.is_discrete else "energy_spent",
        closing=False,
        answer=True,
    )


def _tell_gramian(page: Builder, result: MinimumEnergyInput, W: Matrix) -> Term:
    A, B = page["A"], page["B"]
    if result.plant.is_discrete:
        total = page["B B.T"]
        steps = int(result.answer["horizon"].fraction())
        for k in range(1, steps):
            total = total + A**k @ B @ B.T @ A.T**k
        counted = Counted("step", steps)
        return page.define("W", total, W, say="energy_gramian_discrete", closing=False, steps=counted)
    integrand = page["exp_At B B.T exp_At.T"]
    whole = page.term(
        since_start(integrand.formula, Literal(result.inner.answer["function"]), result.answer["horizon"])
    )
    return page.define("W", whole, W, say="energy_gramian", closing=False)


def _tell_unreachable(page: Builder, result: MinimumEnergyInput, d: Term) -> None:
    """Write w with wᵀ [B, AB, …] = 0 and wᵀ d ≠ 0."""
    A, B, count = page["A"], page["B"], _seen_steps(result)
    page.define("Ctr", block([[A**k @ B if k else B for k in range(count)]]), say="energy_reachable")
    w = page.set("w_d", result.answer["w"].T)
    page.conclude(
        "energy_unreachable",
        relation(w @ d, "!==", 0),
        row=page.line("w_d = #"),
        annuls=page.line("w_d Ctr = 0"),
        left=page.line("w_d {d} = #", d=d),
    )
