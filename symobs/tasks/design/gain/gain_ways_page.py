"""The pages of ways to a gain: Ackermann's formula, matching coefficients, companion, row-reduced and canonical form."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar, companion, hankel_of, roots_of
from symobs.formula.tree import Evaluated, Literal, Roots
from symobs.formula.tree.term import Term, block, product
from symobs.proof.derivation.builder import Builder, relation
from symobs.tasks.analysis.page_parts import determinant_form
from symobs.tasks.design import readability
from symobs.tasks.design.named_gains import define_gain, gain_letters
from symobs.tasks.design.pole_placement.row_reduction import Reduction, gain_of, row_reduction
from symobs.tasks.design.pole_placement.single_output import matching
from symobs.tasks.design.pole_placement.sylvester import taken_names

if TYPE_CHECKING:
    from symobs.formula.tree import Relation
    from symobs.system.specification import DesiredPolynomial
    from symobs.tasks.design.gain.gain_design import GainDesign, PlacementProblem


#: A gain that rounding changes by more than this share of an entry is worth a warning.
_HARM = Fraction(1, 100)


def write_ackermann_formula(page: Builder, _: GainDesign, side: PlacementProblem, desired: DesiredPolynomial) -> None:
    """Write L = φ(A) 𝒪⁻¹ eₙ, and K = eₙᵀ 𝒞⁻¹ φ(A)."""
    order = page.plant.order
    unit = page.value(Matrix.unit(order, order - 1))
    polynomial = page["A"].apply(f"{side.phi}_at")
    at = product([_factor_at(page, factor, power) for factor, power in desired.grouped()])
    if side.is_dual:
        last = page.define("q_o", page["O^-1"] @ unit, say="last_column")
        define_gain(page, "L", polynomial @ last, at @ last, say="ackermann_observer")
    else:
        last = page.define("q_c", unit.T @ page["Ctr^-1"], say="last_row")
        define_gain(page, "K", last @ polynomial, last @ at, say="ackermann_state_feedback")


def _factor_at(page: Builder, factor: Scalar, power: int) -> Term:
    """Return a factor of φ with A put in for the variable: (A + 10 I)²."""
    lead, *rest = factor.coefficients(page.plant.variable)
    A, degree, order = page["A"], len(rest), page.plant.order
    total = A**degree if lead.is_one else page.value(lead) @ A**degree
    for index, coefficient in enumerate(rest):
        if coefficient.is_zero:
            continue
        exponent = degree - 1 - index
        body = A**exponent if exponent else page.identity(order)
        negative = coefficient.is_constant and coefficient.fraction() < 0
        size = -coefficient if negative else coefficient
        term = body if size.is_one else page.value(size) @ body
        total = total - term if negative else total + term
    return total**power


def write_matching(page: Builder, design: GainDesign, side: PlacementProblem, desired: DesiredPolynomial) -> None:
    """Write det(sI − A + LC) with unknown l₁ … lₙ, its coefficients equated to those of φ, the linear system, its solution."""
    variable = page.plant.variable
    system = matching(design.dual_pair(page.plant), desired)
    unknown = gain_letters(page, side.gain, system.solution)
    gain = page.define(side.gain, design.transpose_for_task(unknown), say="unknown_gain")
    moved = gain @ page["C"] if side.is_dual else page["B"] @ gain
    determinant = page("det(s I - A + {moved})", moved=moved)
    polynomial = determinant.scalar
    page.equal(relation(determinant, page.value(polynomial)), say="polynomial_of_unknown")
    pairs = zip(polynomial.coefficients(variable)[1:], desired.coefficients, strict=True)
    page.equal(*(relation(found, target) for found, target in pairs), say="equal_coefficients")
    page.equal(relation(page("{M} {unknown}", M=system.M, unknown=unknown), system.r), say="linear_system")
    define_gain(page, side.gain, design.transpose_for_task(system.solution), say="solution_of_system")


def write_companion(page: Builder, _: GainDesign, side: PlacementProblem, desired: DesiredPolynomial) -> None:
    """Write T = [q; qAᵀ; …], which carries the dual pair to companion form, where the gain is the row of differences."""
    order, variable = page.plant.order, page.plant.variable
    found = page.plant.matrices.A.characteristic_polynomial(variable).coefficients(variable)[1:]
    unit = page.value(Matrix.unit(order, order - 1))
    A, driven = side.pair(page)
    if side.is_dual:
        q = page.define("q_o", page["O^-1"] @ unit, say="companion_vector_observer").T
    else:
        q = page.define("q_c", unit.T @ page["Ctr^-1"], say="companion_vector_state_feedback")
    T = page.define("T", block([[q @ A**k if k else q] for k in range(order)]), say="companion_rows")
    page.equal(relation(T @ A @ T.inverse, companion(found)), relation(T @ driven, unit), say="companion_reached")
    wanted = [page.value(c) for c in reversed(desired.coefficients)]
    row = block([[w - page.value(a) for w, a in zip(wanted, reversed(found), strict=True)]])
    _define_row(page, side, row @ T, row.as_value @ T.as_value)


def _define_row(page: Builder, side: PlacementProblem, *members: Term, say: str = "row") -> None:
    """Introduce K, or L through its transpose."""
    define_gain(page, side.gain, *members, say=f"{say}_{side.kind}", transposed=side.is_dual)


def readable(design: GainDesign) -> bool:
    """Return whether the row-reduced forms belong to the gain of the answer and are short enough to be written out."""
    found = _reductions(design)
    if (
        found is None
        or len(found) > readability.NULL_VECTORS
        or any(part.reduced.size > readability.REDUCED_FORM for part in found)
    ):
        return False
    return bool(design.transpose_for_task(gain_of(found)) == design.answer[design.letter])


def _reductions(design: GainDesign) -> tuple[Reduction, ...] | None:
    assert design.desired is not None  # noqa: S101 - a page of a given gain does not come here
    return row_reduction(design.dual_pair(design.plant), design.desired)


def write_row_reduction(page: Builder, design: GainDesign, side: PlacementProblem, _: DesiredPolynomial) -> None:
    """Write for each pole the matrix [λI − Aᵀ : Cᵀ], its reduced form, the scalar relations, what is chosen, the vector."""
    found = _reductions(design)
    assert found is not None  # noqa: S101 - `readable` has said so
    _open_eigenvalues(page, side)
    page.remark(f"null_vectors_{side.kind}")
    for number, part in enumerate(found, 1):
        _reduce(page, side, part, number)
    psi = page.define("Psi", Matrix.block([[part.psi for part in found]]), say="upper_parts")
    page.define("f_psi", Matrix.block([[part.f for part in found]]))
    page.equal(
        page.line("det(Psi) = {value}", value=determinant_form(page, psi.value.determinant())), say="with_determinant"
    )
    gain, shown = page["f_psi Psi^-1"], page["#f_psi (#Psi)^-1"]
    is_unique = side.pair(page)[1].value.shape[1] == 1
    _define_row(page, side, gain, shown, say="row_reduced_unique" if is_unique else "row_reduced")
    _rounded_too_early(page, gain.value)


def _open_eigenvalues(page: Builder, side: PlacementProblem) -> None:
    """Say where the eigenvalues are without the gain, where they can be written down."""
    own = page["det(s I - A)"]
    factors = own.scalar.factors()[1]
    if own.scalar.names <= {page.plant.variable} and all(f.degree(page.plant.variable) <= 2 for f, _ in factors):
        page.remark(
            f"open_eigenvalues_{side.kind}", roots=Roots(own.formula, roots_of(own.scalar, page.plant.variable))
        )


def _rounded_too_early(page: Builder, gain: Matrix) -> None:
    """Show what becomes of the gain when the columns of Ψ are rounded before it is inverted, where that does harm."""
    near = page.decimals(page["Psi"].value)
    if not near or near[1].value.determinant().is_zero:
        return
    spoiled = page["#f_psi"] @ near[1].inverse
    shown = page.decimals(spoiled.value)
    pairs = zip(spoiled.value.entries, gain.entries, strict=True)
    if shown and any(abs((wrong - right).fraction()) > _HARM * abs(right.fraction()) for wrong, right in pairs):
        page.equal(relation(spoiled, *shown), say="rounded_too_early")


def _reduce(page: Builder, side: PlacementProblem, part: Reduction, number: int) -> None:
    """Write one reduction."""
    if part.before is not None:
        page.equal(relation(part.matrix, "~", part.reduced), say="generalised", pole=_named(page, part))
    else:
        words = ("pole" if number == 1 else "next_pole") if part.size == 1 else "pair" if _pair(part) else "factor"
        chain = relation(_matrix(page, side, part), part.matrix, "~", part.reduced)
        page.equal(chain, say=f"{words}_reduced", pole=_named(page, part))
    if part.size == 1 and number == 1:
        _relations(page, part, number)
    near = page.decimals(part.vector)
    xi = page.define(f"xi_{number}", part.vector, *near, say="" if part.size == 1 else "vectors_chosen")
    zero = Matrix.zeros(part.order * part.size, 1)
    matrix = part.matrix.select(range(part.matrix.shape[0]), range(part.vector.shape[0]))
    right = zero if part.before is None else Matrix.column([-entry for entry in part.before.T.entries])
    page.conclude_silently(relation(page.value(matrix) @ xi, right))


def _matrix(page: Builder, side: PlacementProblem, part: Reduction) -> Term:
    """Return [λI − Aᵀ : Cᵀ] (or [λI − A : B]) in letters; of a block J its blocks."""
    order, J = part.order, part.J
    A, driven = side.pair(page)
    nothing, empty = page.value(Matrix.zeros(order, order)), page.value(Matrix.zeros(*driven.value.shape))
    rows = []
    for j in range(part.size):
        row = []
        for k in range(part.size):
            multiple = _multiple(page, J[k, j], order)
            if k == j:
                row.append(-A if multiple is None else multiple - A)
            else:
                row.append(nothing if multiple is None else multiple)
        rows.append([*row, *(driven if k == j else empty for k in range(part.size))])
    return block(rows)


def _multiple(page: Builder, factor: Scalar, order: int) -> Term | None:
    """Return a multiple of I, None for 0."""
    identity = page.identity(order)
    if factor.is_zero:
        return None
    if (factor * factor).is_one:
        return identity if factor.is_one else -identity
    return page.value(factor) @ identity


def _relations(page: Builder, part: Reduction, number: int) -> None:
    """Read the components off the reduced form, and choose what is free: for the first pole, which stands for all."""
    width = part.vector.shape[0]
    short = width < 10
    names = [f"xi_{number}{i}" if short else f"xi_{number}_{i}" for i in range(1, width + 1)]
    if taken_names(page).intersection(names):
        return
    xi = [page.name_coefficient(name, entry) for name, entry in zip(names, part.vector.entries, strict=True)]
    free = [j for j in range(width) if j not in part.pivots]
    lines: list[Relation] = []
    for row, pivot in enumerate(part.pivots):
        right = part.reduced[row, width] if part.before is not None else Scalar.of(0)
        lines.append(relation(xi[pivot], sum((xi[j] * -part.reduced[row, j] for j in free), start=right)))
    chosen = [relation(xi[j], part.vector[j, 0]) for j in free]
    page.equal(*lines, say="relations_read_off")
    page.equal(*chosen, say="free_chosen")


def _pair(part: Reduction) -> bool:
    """Return whether J stands for a conjugate pair."""
    return part.size == 2 and part.J[0, 0] == part.J[1, 1]


def _named(page: Builder, part: Reduction) -> Evaluated:
    """Return the pole, or the factor of φ, of a reduction."""
    if part.size == 1:
        return Evaluated(page("det({J})", J=part.J).formula, Literal(part.J[0, 0]))
    pencil = page("s I - {J}", J=part.J)
    return Evaluated(pencil.apply("det").formula, Literal(part.J.characteristic_polynomial(page.plant.variable)))


def is_canonical(page: Builder) -> bool:
    """Return whether (A, B) is in controllable canonical form."""
    m, order = page.plant.matrices, page.plant.order
    chi = m.A.characteristic_polynomial(page.plant.variable)
    return Matrix.unit(order, order - 1) == m.B and companion(chi.coefficients(page.plant.variable)[1:]) == m.A


def say_canonical(page: Builder) -> None:
    """Say that (A, B) is in controllable canonical form already."""
    order, variable = page.plant.order, page.plant.variable
    chi = page.plant.matrices.A.characteristic_polynomial(variable)
    tested = block([[page["A"] ** k @ page["B"] if k else page["B"] for k in range(order)]])
    page.remark(
        "already_canonical",
        relation(tested.apply("rank"), order),
        relation(page["A"], companion(chi.coefficients(variable)[1:])),
        relation(page["B"], Matrix.unit(order, order - 1)),
        chi=page.line("det(s I - A) = {chi}", chi=chi),
    )


def write_canonical(page: Builder, _: GainDesign, side: PlacementProblem, desired: DesiredPolynomial) -> None:
    """Write the difference of coefficients, constant first, carried back by V⁻¹."""
    plant, order = page.plant, page.plant.order
    variable = plant.variable
    wanted = [page.value(c) for c in reversed(desired.coefficients)]
    if side.gain == "K" and is_canonical(page):
        found = plant.matrices.A.characteristic_polynomial(variable).coefficients(variable)[1:]
        define_gain(page, "K", _difference(page, wanted, list(found)))
        return
    A, matrix = side.pair(page)[0], page["O.T"] if side.is_dual else page["Ctr"]
    chi = plant.matrices.A.characteristic_polynomial(variable)
    found = chi.coefficients(variable)[1:]
    said = getattr(page.steps[-1], "sentence", None)
    is_announced = said is not None and said.key == f"polynomials_{side.kind}"  # beside φ
    say = "" if is_announced else f"open_{side.kind}"
    page.define("chi", page("det(s I - {A})", A=A), say=say)
    hankel = page.value(hankel_of(found))
    written = [matrix.as_value @ hankel] if order > 1 else []
    V = page.define(f"V_{side.index}", matrix @ hankel, *written, say=f"canonical_{side.kind}")
    page.equal(
        relation(V.inverse, V.inverse.as_value), relation(V.apply("det"), determinant_form(page, V.value.determinant()))
    )
    row = _difference(page, wanted, list(found))
    _define_row(page, side, row @ V.inverse, row.as_value @ V.inverse.as_value)


def _difference(page: Builder, wanted: list[Term], found: list[Scalar]) -> Term:
    entries = [w - page.value(a) for w, a in zip(wanted, reversed(found), strict=True)]
    return block([entries])
