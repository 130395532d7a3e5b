"""The page of an optimal gain: the polynomial of the loop, the gain, P and its check; or digits; or the obstacle."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar, decimal_places, roots_of
from symobs.exact.core.generators import all_roots, function_named
from symobs.exact.floating.riccati_check import excess, is_proved
from symobs.exact.linear_algebra.krylov import Krylov
from symobs.exact.numerals.written_digits import rounded_roots
from symobs.formula.tree import ROOT_DIGITS, Decimals, Power, RoundedRoots
from symobs.formula.tree.term import block
from symobs.proof.certificate.claims import as_scalar
from symobs.proof.derivation.builder import predicate, relation
from symobs.stability.criteria.stability import stability
from symobs.stability.plots import root_locus
from symobs.system.conditions import sign_of
from symobs.tasks.analysis.page_parts import case_steps, given
from symobs.tasks.design.optimal.optimal_gain import is_numeric
from symobs.tasks.design.optimal.spectral_factor import with_signs

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from symobs.formula.tree.term import Term
    from symobs.proof.derivation.builder import Builder
    from symobs.tasks.design.optimal.optimal_gain import Obstacle, OptimalGain, Solution

#: Up to this order the coefficients of the loop are compared on the page.
_MATCHED_UP_TO = 3
#: The roots are drawn up to this order; the factor of the weight has this name.
_DRAWN_UP_TO, _WEIGHT = 4, "rho"
#: Significant digits on the page, and how many more are tried.
_DIGITS, _MORE = 6, 9
_LETTERS = {"Q": "Q_x", "R": "R_u", "N": "N_x", "P": "P_x", "W": "W_n", "V": "V_n", "G": "G_n"}


def write_optimal(page: Builder, result: OptimalGain) -> None:
    """Write the whole page."""
    _admit_roots(page, result)
    if not is_numeric(result.regulator):
        inner_first = sorted(all_roots(*result.all_values), key=lambda root: (len(all_roots(root.argument)), root.name))
        page.name_roots(*(root.value for root in inner_first))
    given(page)
    with page.section("optimal_feedback" if result.letter == "K" else "optimal_filter"):
        _tell_weights(page, result)
        _solve(page, result)
        gain = next((name for name in ("L", "L_r") if result.letter == "L" and page.defines(name)), None)
        if gain is not None:
            _tell_filter(page, gain)
        page.steps += case_steps(page, result, _case)


def _case(page: Builder, result: OptimalGain) -> None:
    _admit_roots(page, result)
    _set_weights(page, result)
    _solve(page, result)


def _admit_roots(page: Builder, result: OptimalGain) -> None:
    """Let the square roots of the answer have their relations and their sign from the start."""
    values = result.values_with_cases
    page.with_roots(*values)
    signs, open_ones = with_signs(page.start.signs, *values), _open_radicands(page, values)
    page.start, page.environment = (
        replace(each, signs=signs, positive=(*each.positive, *open_ones)) for each in (page.start, page.environment)
    )


def _open_radicands(page: Builder, values: Iterable[Scalar | Matrix]) -> list[Scalar]:
    """Return what stands under the roots and is positive by what c is, not by the declared signs alone."""
    roots = sorted(all_roots(*values), key=lambda root: root.name)
    signs = with_signs(page.plant.symbols.signs, *values)
    return [root.argument for root in roots if sign_of(root.argument, signs) != "positive"]


def _set_weights(page: Builder, result: OptimalGain) -> None:
    """Give the weights, or the intensities of the noise, their letters."""
    letters = _LETTERS if result.letter == "K" else {**_LETTERS, "N": "N_n"}
    for name, value in result.weights.items():
        if letters[name] != "N_n" or not value.is_zero:
            page.set(letters[name], value)
    if result.letter == "L":
        page.set("N_x", result.regulator.N)
        page.set("Q_x", result.regulator.Q)


def _tell_weights(page: Builder, result: OptimalGain) -> None:
    """State the weights, or the intensities of the noise."""
    _set_weights(page, result)
    time, names = "discrete" if page.plant.is_discrete else "continuous", list(result.weights)
    if result.letter == "K":
        names = names[:2] if result.regulator.N.is_zero else names
        say = "lqr_cost" if result.regulator.N.is_zero else "lqr_cost_cross"
    else:
        names = ["W", "V", "G"] if _has_input_matrix(result) else ["W", "V"]
        say = "kalman_noise_through" if _has_input_matrix(result) else "kalman_noise"
    shown = [relation(page[_LETTERS[name]], result.weights[name]) for name in names]
    page.equal(*shown, say=f"{say}_{time}")
    if result.letter == "L" and not result.regulator.N.is_zero:
        page.equal(relation(page["N_n"], result.weights["N"]), say="kalman_shared")


def _has_input_matrix(result: OptimalGain) -> bool:
    """Return whether the noise enters through a matrix of its own."""
    return "G" in result.weights and result.weights["G"] != Matrix.identity(result.plant.order)


def _solve(page: Builder, result: OptimalGain) -> None:
    if result.answer["question"] is not None:
        page.remark("optimal_open")
    elif result.answer["obstacle"] is not None:
        _tell_obstacle(page, result, result.answer["obstacle"])
    elif result.exact is None:
        _tell_digits(page, result)
    else:
        _tell_exact(page, result, result.exact)


def _problem(page: Builder, result: OptimalGain) -> tuple[Term, Term, Term, Term]:
    """Return the terms of A, B, Q and R of the regulator, the cross weight removed."""
    names = ("A", "B", "Q_x", "R_u") if result.letter == "K" else ("A.T", "C.T", _noise(result), "V_n")
    A, B, Q, R = (page[name] for name in names)
    if result.regulator.N.is_zero:
        return A, B, Q, R
    if result.letter == "L" and not page.defines("A_N"):
        shared = _shared(result)
        page.define("A_N", f"A.T - C.T V_n^-1 ({shared}).T", say="optimal_uncrossed")
        page.define("Q_N", f"{_noise(result)} - {shared} V_n^-1 ({shared}).T")
    if not page.defines("A_N"):
        page.define("A_N", "A - B R_u^-1 N_x.T", say="optimal_uncrossed")
        page.define("Q_N", "Q_x - N_x R_u^-1 N_x.T")
    return page["A_N"], B, page["Q_N"], R


def _noise(result: OptimalGain) -> str:
    """Return GWGᵀ, or W where the noise acts on each state."""
    return "G_n W_n G_n.T" if _has_input_matrix(result) else "W_n"


def _shared(result: OptimalGain) -> str:
    """Return GN, or N where the noise acts on each state."""
    return "G_n N_n" if _has_input_matrix(result) else "N_n"


# -- exact -------------------------------------------------------------------------------------------------------------


def _tell_exact(page: Builder, result: OptimalGain, exact: Solution) -> None:
    """Write c, its stable factor p, the gain, P, the check and what follows."""
    plant, letter = page.plant, result.letter
    held = [condition.expression for condition in result.holds_where if condition.kind != "domain"]
    if held:
        page.assume("optimal_provided", *held)
    A, B, Q, R = _problem(page, result)
    if not _tell_root_square(page, result):
        _tell_pencil(page, A, B, Q, R)
    page.define("p_s", page.value(exact.polynomial), say="optimal_factor", closing=False)
    named = (root for name in page.forms if (root := function_named(name)) is not None)
    for index, root in enumerate(named):
        letter_of, say = page.value(root.value), "optimal_next_root" if index else "optimal_root"
        square = relation(letter_of**2, page.value(root.argument))
        page.conclude(say, root=square, positive=relation(letter_of, ">", 0))
    _tell_locus(page, Q, R)
    if _open_radicands(page, [exact.P, *exact.factors]):
        page.remark("optimal_roots_real")
    matched = result.regulator.B.shape[1] == 1 and plant.order <= _MATCHED_UP_TO and _is_controllable(result)
    if matched:
        _tell_matching(page, result, exact.gain)
    page.define("P_x", page.value(exact.P), say="optimal_P", answer=True, closing=False)
    if not matched:
        page.define(letter, page.value(exact.gain), say="optimal_gain", answer=True, closing=False)

    equations = result.equations(discrete=plant.is_discrete, cross=not result.regulator.N.is_zero)
    written = (each.replace("noise", _noise(result)).replace("shared", _shared(result)) for each in equations)
    riccati, gain = (page.line(each, **_LETTERS) for each in written)
    page.verified("optimal_checked", riccati=riccati, gain=gain)
    chi = page.define(f"chi_{letter}", _pencil(page, result, page[letter]).apply("det"), exact.polynomial, silent=True)
    found = "optimal_feedback_found" if letter == "K" else "optimal_filter_found"
    page.conclude(found, predicate("stable", chi))
    if letter == "L" and plant.is_discrete:
        page.define(
            "L_f", "P_x C.T (C P_x C.T + V_n)^-1", result.fields["L_filter"], say="kalman_update", closing=False
        )
        page.define("P_f", "P_x - L_f C P_x", result.fields["P_filter"], closing=False)
    if letter == "K" and plant.inputs == 1 and not plant.is_discrete and result.regulator.N.is_zero:
        page.remark("optimal_margins", predicate("stable", chi))


def _pencil(page: Builder, result: OptimalGain, gain: Term) -> Term:
    """Return sI − A + BK, sI − A + LC, the gain in some form."""
    moved = page["B"] @ gain if result.letter == "K" else gain @ page["C"]
    return page("s I - A + {moved}", moved=moved)


def _tell_root_square(page: Builder, result: OptimalGain) -> bool:
    """Write p(s) p(−s) = χ(s) χ(−s) + R⁻¹ v(−s)ᵀ Q v(s) with v(s) = adj(sI − A) B, of one input in continuous time."""
    if result.regulator.B.shape[1] > 1 or page.plant.is_discrete:
        return False
    A, B, Q, R = _problem(page, result)
    side = "_dual" if result.letter == "L" else ""
    forward, backward = page["s I"] - A, page("-s I - {A}", A=A)
    page.define("chi_p", forward.apply("det"), say=f"optimal_open_loop{side}")
    page.define("chi_m", backward.apply("det"))
    page.define("v_s", forward.apply("adj") @ B)
    page.define("v_m", backward.apply("adj") @ B)
    cost = page("{inverse} v_m.T {Q} v_s", inverse=R.inverse, Q=Q)
    page.define("c_even", page("chi_p chi_m + {cost}", cost=cost), say="optimal_even")
    return True


def _tell_locus(page: Builder, Q: Term, R: Term) -> None:
    """Draw the roots of χ(s) χ(−s) + ρ R⁻¹ v(−s)ᵀ Q v(s) for ρ from 0 to 1, where the data are numbers."""
    variable, values = page.plant.variable, page.environment.values
    if "chi_m" not in values or values["c_even"].names - {variable} or page.plant.order > _DRAWN_UP_TO:
        return
    free = as_scalar(values["chi_p"]) * as_scalar(values["chi_m"])
    cost = as_scalar(values["c_even"]) - free
    moved = free + cost * Scalar.symbol(_WEIGHT)
    picture = root_locus(moved, variable, _WEIGHT, (Fraction(0), Fraction(1)), None, None)
    if picture is not None and not cost.is_zero:
        cost_term = page("{inverse} v_m.T {Q} v_s", inverse=R.inverse, Q=Q)
        grown = page("chi_p chi_m + {WEIGHT} {cost_term}", WEIGHT=Scalar.symbol(_WEIGHT), cost_term=cost_term)
        page.define("c_rho", grown, moved, say="optimal_weighted")
        page.plot(picture, page["c_rho"], say="optimal_locus")


def _tell_pencil(page: Builder, A: Term, B: Term, Q: Term, R: Term) -> None:
    """Write det(sI − H), in discrete time the determinant of the pencil of Riccati's equation."""
    S = B @ R.inverse @ B.T
    if page.plant.is_discrete:
        pencil = page("[s I - {A}, s {S}; {Q}, s {T} - I]", A=A, S=S, Q=Q, T=A.T)
        page.define("c_even", pencil.apply("det"), say="optimal_even_of_pencil")
        return
    page.define("H_m", block([[A, -S], [-Q, -A.T]]), say="optimal_hamiltonian")
    pencil = page["s I - H_m"]
    page.define("c_even", pencil.apply("det"), say="optimal_even_of_pencil")


def _is_controllable(result: OptimalGain) -> bool:
    """Return whether the polynomial determines the gain."""
    return not Krylov.of(result.regulator.A.T, result.regulator.B.T).determinant.is_zero


def _tell_matching(page: Builder, result: OptimalGain, gain: Matrix) -> None:
    """Write the polynomial of the loop in unknown entries of the gain, and the gain."""
    _tell_unknown(page, result)
    page.define(result.letter, page.value(gain), say="optimal_matched_gain", answer=True, closing=False)


def _tell_unknown(page: Builder, result: OptimalGain) -> bool:
    """Write the polynomial of the loop in unknown entries of the gain, where their letters are free."""
    letter, order = result.letter, page.plant.order
    names = [f"{letter.lower()}{k + 1}" for k in range(order)]
    taken = {*page.plant.symbols.signs, *page.plant.field.names, *page.environment.coefficients}
    if taken & {*names}:
        return False
    unknown = [Scalar.symbol(name) for name in names]
    pencil = _pencil(page, result, page.value(Matrix.row(unknown) if letter == "K" else Matrix.column(unknown)))
    shown = pencil.apply("det")
    page.equal(relation(shown, shown.as_value), say="optimal_matched")
    return True


# -- digits ------------------------------------------------------------------------------------------------------------


def _tell_digits(page: Builder, result: OptimalGain) -> None:
    """Write P and the gain in decimals: in so many that a box of the size of their last place is mapped into itself."""
    letter, digits = result.letter, result.decimals
    is_short, is_matched = page.plant.order <= _DRAWN_UP_TO, False
    if is_short and _tell_root_square(page, result):
        _tell_roots(page)
        _tell_locus(page, *_problem(page, result)[2:])
        is_matched = _is_controllable(result) and _tell_unknown(page, result)
    elif is_short:
        _tell_pencil(page, *_problem(page, result))
        _tell_roots(page)
    tables = {f"{name}_r": [[Fraction(entry) for entry in row] for row in digits[name]] for name in ("P", letter)}
    largest = max(abs(entry) for table in tables.values() for row in table for entry in row)
    fewest = max(_DIGITS - len(str(int(largest))), 1)
    units = (Fraction(1, 10**places) for places in range(fewest, fewest + _MORE))
    unit = next((unit for unit in units if _is_enough(result, tables, unit)), None)
    if unit is None:
        page.remark("optimal_too_long")
        return
    near = {name: _rounded(table, unit) for name, table in tables.items()}
    shown = [relation(page.set(name, value), page.term(Decimals(value))) for name, value in near.items()]
    page.equal(*shown, say="optimal_digits_matched" if is_matched else "optimal_digits", answer=True)
    kind = "feedback" if letter == "K" else "filter"
    radius = page.term(Decimals(Scalar.of(unit)))
    page.conclude(f"optimal_{kind}_enclosed", radius=radius)
    pencil, plant = _pencil(page, result, page[f"{letter}_r"]), page.plant
    chi = page.define(f"chi_{letter}", pencil.apply("det"), silent=True)
    coefficients = chi.scalar.coefficients(plant.variable)
    if is_short and all(decimal_places(c) is not None for c in coefficients):  # others are too long to be read
        page.equal(relation(pencil.apply("det"), _in_decimals(page, chi.scalar)), say="optimal_loop_polynomial")
    found = stability(as_scalar(chi.value), plant.variable, plant.symbols.signs, discrete=plant.is_discrete)
    P, gain = near["P_r"], result.turned(near[f"{letter}_r"])
    bound = excess(result.regulator, P, gain, unit) if found.verdict == "yes" else None
    if bound is not None:
        power = page.term(Power(Decimals(Scalar.of(10)), 1 - len(str(1 / bound))))
        told = {"radius": radius, "bound": power if bound < unit else page.term(Decimals(Scalar.of(bound)))}
        page.conclude(f"optimal_rounded_{kind}", predicate("stable", chi), **told)


def _tell_roots(page: Builder) -> None:
    """Say the roots of c in decimals."""
    variable, c = page.plant.variable, page["c_even"]
    lead = c.scalar.coefficients(variable)[0]
    subject = c if lead.is_one else -c if (-lead).is_one else page("{factor} c_even", factor=1 / lead)
    roots = roots_of(subject.scalar, variable)
    texts = rounded_roots(roots, ROOT_DIGITS)
    if texts is not None:
        page.remark("optimal_roots", roots=RoundedRoots(subject.formula, roots, texts))


def _in_decimals(page: Builder, polynomial: Scalar) -> Term:
    """Return a monic polynomial whose coefficients are decimals."""
    _, *rest = polynomial.coefficients(page.plant.variable)
    shown = page[f"s^{len(rest)}"]
    for power, c in zip(range(len(rest) - 1, -1, -1), rest, strict=True):
        if not c.is_zero:
            part = page.term(Decimals(Scalar.of(abs(c.fraction()))))
            part = part @ page[f"s^{power}" if power > 1 else "s"] if power else part
            shown = shown + part if c.fraction() > 0 else shown - part
    return shown


def _tell_filter(page: Builder, gain: str) -> None:
    """Write x̂' = A x̂ + B u + L(y − C x̂)."""
    m = page.plant.matrices
    model = page["A x_hat + B u"] if m.has_input else page["A x_hat"]
    error = page["y - C x_hat - D u"] if m.has_feedthrough else page["y - C x_hat"]
    rate = model + page[gain] @ error
    page.dynamics("x_hat", rate, silent=True)
    page.remark("kalman_filter", law=relation(page["x_hat"].derivative, rate))


def _is_enough(result: OptimalGain, tables: Mapping[str, list[list[Fraction]]], unit: Fraction) -> bool:
    """Return whether decimals of this last place are proved to be right."""
    P, gain = (_rounded(table, unit) for table in tables.values())
    told = [[[(entry.fraction(), unit / 2) for entry in row] for row in M.rows] for M in (P, result.turned(gain))]
    return is_proved(result.regulator, P, unit, told[0], told[1])


def _rounded(table: list[list[Fraction]], unit: Fraction) -> Matrix:
    return Matrix.of([[round(entry / unit) * unit for entry in row] for row in table])


# -- the obstacle ------------------------------------------------------------------------------------------------------


def _tell_obstacle(page: Builder, result: OptimalGain, found: Obstacle) -> None:
    """Write the hidden modes and why there is no stabilising solution."""
    is_filter = result.letter == "L"
    dual = (found.kind == "uncontrollable") != is_filter
    names = ("N_K", "X_K") if dual else ("N", "X")
    for name, value in zip(names, (found.N, found.X), strict=True):
        page.set(name, value)
    N, X = (page[name] for name in names)
    A, _, Q, _ = _problem(page, result)
    if found.kind == "uncontrollable":
        A, row = (page["A"], page["C"]) if is_filter else (page["A.T"], page["B.T"])
        said = "optimal_unmeasured_modes" if is_filter else "optimal_uncontrollable_modes"
    else:
        row, said = page["Q_x"] if is_filter else Q, "optimal_undriven_modes" if is_filter else "optimal_unseen_modes"
        if not is_filter and result.regulator.N.is_zero:
            page.set("A_N", result.regulator.A)
            page.set("Q_N", result.regulator.Q)
    order = found.X.shape[0]
    mu = page.define("mu", page("det(s I - {X})", X=X), found.polynomial, say=said)
    nothing = Matrix.zeros(row.value.shape[0], order)
    page.equal(relation(N, N.as_value), relation(row @ N, nothing), relation(A @ N, N @ X, (N @ X).as_value))
    if found.kind == "uncontrollable":
        page.conclude(f"optimal_not_{'detectable' if is_filter else 'stabilizable'}", predicate("unstable", mu))
    else:
        page.conclude("optimal_filter_on_boundary" if is_filter else "optimal_on_boundary")
