"""Values of the letters of a source: the plant and the checked answers, in its letters and signs.

`values` is the one place that knows a convention's letters for matrices, `signals` the one for signals.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

from symobs.exact import Factored, Matrix, Scalar, rank
from symobs.exact.core.generators import substitute
from symobs.exact.core.polynomial import hankel_of
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.formula.convention import Convention
    from symobs.system import StateSpace
    from symobs.tasks.result import Result

Value: TypeAlias = Scalar | Matrix

#: What the sources call the numbers of states, inputs and outputs; elsewhere n, m, p.
SIZES = {
    "plusK-plusMC": ("n", "m", "q"),
    "minusK-minusLC-estimate-x0": ("n", "p", "q"),
    "minusK-minusLC": ("n", "r", "m"),
}
#: Where C stands for the invertible block C₁ of y = C₁ x₁.
MEASURED = {"minusK-minusLC-estimate-x0"}
#: The generators of time: the instants of a transition matrix and of an integral.
INSTANTS = ("t", "t0", "t1", "sigma", "tau")
#: What the transition matrix is kept in.
BEGIN, END = "begin_", "end_"
#: Values that no source has a letter for.
HIDDEN = frozenset({"Phi_", "F_z", "G_u", "G_y"})


@dataclass(frozen=True)
class PlantMatrices:
    """The matrices of a plant, None for missing ones."""

    A: Matrix
    B: Matrix | None
    C: Matrix | None
    D: Matrix | None

    @staticmethod
    def of(plant: StateSpace) -> PlantMatrices:
        """Return the matrices of a plant."""
        m = plant.matrices
        B, C = m.B if m.B.shape[1] else None, m.C if m.C.shape[0] else None
        return PlantMatrices(m.A, B, C, m.D if B is not None and C is not None else None)


def values(plant: StateSpace, results: Sequence[Result], convention: Convention) -> dict[str, Value]:
    """Return the value of every letter for a matrix or a number, in a convention."""
    m, name, answers = PlantMatrices.of(plant), convention.name, answers_of(results)
    K, L = answers.get("K"), answers.get("L")
    written = convention.written(reduced=any(result.has_reduced_observer for result in results))
    found: dict[str, Value | None] = {key: value for key, value in answers.items() if key not in {"K", "L", "T"}}
    if {"G", "H", "M"} <= answers.keys():
        found |= {written.get(f"{key}_z", key): answers[key] for key in "FGHM"}
    found |= {"A": m.A, "B": m.B, "C": m.C, "D": m.D if m.D is None or not m.D.is_zero else None}
    counted = (plant.order, plant.inputs if m.B is not None else 0, plant.outputs if m.C is not None else 0)
    sizes = zip(SIZES.get(name, ("n", "m", "p")), counted, strict=True)
    found |= {letter: Scalar.of(number) for letter, number in sizes if number}
    found["Phi_"] = _transition(answers)
    if not plant.is_time_varying:
        found |= _of_the_plant(plant)
        found |= _polynomials(plant, K, L, convention)
    for key, gain in (("K", K), ("L", L)):
        found[written.get(key, key)] = -gain if gain is not None and key in convention.turned else gain
    found |= blocks_of(plant, K, L, convention)
    found |= _for_the_observer(m, L, name)
    return {key: value for key, value in found.items() if value is not None}


def answers_of(results: Sequence[Result]) -> dict[str, Any]:
    """Return the answers that are matrices or numbers, the first of each name."""
    found: dict[str, Any] = {}
    for result in results:
        if (reference := getattr(result, "reference", None)) is not None:
            found["A_d"] = reference
        for name, value in result.fields.items():
            exact = value.value if isinstance(value, Factored) else value
            key = f"{result.task}_matrix" if name == "matrix" else name
            if isinstance(exact, (Scalar, Matrix)) and name not in {"A", "B", "C", "D"}:
                found.setdefault(key, exact)
    return found


def _transition(answers: Mapping[str, Any]) -> Matrix | None:
    """Return the transition matrix from `BEGIN` to `END`, if a result has one."""
    begin, end = Scalar.symbol(BEGIN), Scalar.symbol(END)
    if "transition_matrix" in answers:
        kept: Matrix = substitute(answers["transition_matrix"], {"t": end, "t0": begin})
        return kept
    found = answers.get("matrix_exponential_matrix")
    return substitute(found, {"t": end - begin}) if isinstance(found, Matrix) else None


def _of_the_plant(plant: StateSpace) -> dict[str, Value | None]:
    m, s = PlantMatrices.of(plant), Scalar.symbol(plant.variable)
    pencil = Matrix.identity(plant.order) * s - m.A
    found: dict[str, Value | None] = {}
    if m.C is not None:
        found["O"] = krylov(m.A.T, m.C.T).T
    if m.B is not None and m.C is not None and plant.inputs == plant.outputs == 1:
        found["P"] = (m.C @ pencil.inverse() @ m.B + m.D)[0, 0] if m.D is not None else None
    return found


def krylov(A: Matrix, B: Matrix) -> Matrix:
    """Return [B A·B … Aⁿ⁻¹·B]."""
    columns = [B]
    while len(columns) < A.shape[0]:
        columns.append(A @ columns[-1])
    return Matrix.block([columns])


def _polynomials(
    plant: StateSpace, K: Matrix | None, L: Matrix | None, convention: Convention
) -> dict[str, Value | None]:
    """Return the characteristic and the desired polynomials, V of the pair (Aᵀ, Cᵀ), and the coefficients of `plusK-plusMC`."""
    m, s, name = PlantMatrices.of(plant), plant.variable, convention.name
    found: dict[str, Value | None] = {}
    if K is not None and m.B is not None:
        found[convention.letters.get("phi_c", "phi_c")] = (m.A - m.B @ K).characteristic_polynomial(s)
    if m.C is None or m.C.shape[0] != 1:
        return found
    chi = m.A.characteristic_polynomial(s)
    V = krylov(m.A.T, m.C.T) @ hankel_of(chi.coefficients(s)[1:])
    found["V"] = V
    if L is not None and L.shape == (plant.order, 1):
        found[convention.letters.get("phi_o", "phi_o")] = phi = (m.A - L @ m.C).characteristic_polynomial(s)
        if name == "plusK-plusMC":
            for i, (alpha, beta) in enumerate(zip(chi.coefficients(s), phi.coefficients(s), strict=True)):
                found |= {f"alpha_{i}": alpha, f"beta_{i}": beta, f"gamma_{i}": alpha - beta} if i else {}
            found |= {f"k_{i + 1}": -L[i, 0] for i in range(plant.order)}
    if name == "plusK-plusMC" and not V.determinant().is_zero:
        found["T"] = V.inverse()
    return found


def blocks_of(plant: StateSpace, K: Matrix | None, L: Matrix | None, convention: Convention) -> dict[str, Value | None]:
    """Return the blocks of the plant where y = C₁ x₁ with C₁ invertible, and the minimal-order observer made of them."""
    m = PlantMatrices.of(plant)
    first = leading_block(m.C)
    if first is None or m.C is None or first == m.C:
        return {}
    n, p = plant.order, m.C.shape[0]
    upper, lower = range(p), range(p, n)
    A_11, A_12, A_21, A_22 = (m.A.select(i, j) for i in (upper, lower) for j in (upper, lower))
    found: dict[str, Value | None] = {"A_11": A_11, "A_12": A_12, "A_21": A_21, "A_22": A_22}
    found |= {"C": first, "k": Scalar.of(p)} if convention.name in MEASURED else {}
    B = m.B if m.B is not None else Matrix.zeros(n, 0)
    B_1, B_2 = B.select(upper, range(B.shape[1])), B.select(lower, range(B.shape[1]))
    found |= {"B_1": B_1, "B_2": B_2} if m.B is not None else {}
    if K is not None:
        found |= {f"K_{i}": K.select(range(K.shape[0]), part) for i, part in ((1, upper), (2, lower))}
    if L is None or L.shape != (n - p, p):
        return found
    F = A_22 - L @ first @ A_12
    u, y = B_2 - L @ first @ B_1, F @ L + (A_21 - L @ first @ A_11) @ first.inverse()
    written = convention.written(reduced=True)
    found |= {"G_u": u, "G_y": y, "F_z": F, written.get("H_z", "H"): y}
    found |= {"dp": F.characteristic_polynomial(plant.variable)}
    return found | ({written.get("G_z", "G"): u} if m.B is not None else {})


def _for_the_observer(m: PlantMatrices, L: Matrix | None, name: str) -> dict[str, Value | None]:
    """Return F and G of `plusK-minusHC`, x̂' = F x̂ + G u + H y."""
    if name != "plusK-minusHC" or L is None or m.C is None or L.shape != (m.A.shape[0], m.C.shape[0]):
        return {}
    return {"F": m.A - L @ m.C, "G": m.B}


def leading_block(C: Matrix | None) -> Matrix | None:
    """Return C₁ of C = [C₁ 0] where it is invertible, else None."""
    if C is None or C.shape[0] > C.shape[1]:
        return None
    first, rest = C.select(range(C.shape[0]), range(C.shape[0])), range(C.shape[0], C.shape[1])
    regular = rank(first) == C.shape[0] and C.select(range(C.shape[0]), rest).is_zero
    return first if regular else None
