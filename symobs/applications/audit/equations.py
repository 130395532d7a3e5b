"""Printed equations: their grammar, the values of letters and signals, and their evaluation."""

from __future__ import annotations

import re
from dataclasses import field, replace
from typing import TYPE_CHECKING, Any, TypeAlias

from symobs.exact import VARIABLES, Factored, Ideal, Matrix, Scalar, TooLarge, rank
from symobs.exact.core.generators import roots_in, substitute
from symobs.exact.core.polynomial import coefficients_over, hankel_of, product_of
from symobs.formula.convention import STANDARD
from symobs.formula.expression import parse_scalar
from symobs.formula.expression.names import FUNCTIONS as SCALAR_FUNCTIONS
from symobs.formula.expression.names import Scope
from symobs.formula.expression.source import Source, shown
from symobs.formula.expression.syntax import SyntaxNode, every, exponent_of, parse
from symobs.formula.expression.tokenizer import EXPONENTIAL, TOKENS, Tokeniser
from symobs.formula.tree import Block, Derivative, Environment, Formula, Letter, Literal, Negative, Product, Sum
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import BudgetExceeded, InputError
from symobs.proof.certificate.pointwise import never_together_zero
from symobs.system.conditions import sign_of, vanishing_factors
from symobs.tasks.design.reduced_order.reduced_order_observer import partition

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping, Sequence
    from fractions import Fraction

    from symobs.formula.convention import Convention
    from symobs.system import StateSpace
    from symobs.tasks.result import Result

    Kept = dict[int | str, tuple[SyntaxNode, Any]]


# A reading of an equation: its letters, its conditions, and where it is undefined or different.


_CONDITION = re.compile(r"(.+?)(!=|>=|<=|>|<)(.+)")
_STRICT = {"positive", "negative", "nonzero"}
_STRICT_OF = {"nonnegative": "positive", "nonpositive": "negative", "real": "nonzero"}
NOT_NEGATIVE, NOT_POSITIVE = {"positive", "nonnegative", "zero"}, {"negative", "nonpositive"}


@dataclass
class EquationConditions:
    """The conditions of an equation, and the signs of the symbols with them.

    apart   of each group one is not 0
    above   what is not negative
    """

    text: str = ""
    signs: Mapping[str, str] = field(default_factory=dict)
    apart: tuple[tuple[Scalar, ...], ...] = ()
    above: tuple[Scalar, ...] = ()

    @staticmethod
    def of(text: str, signs: Mapping[str, str], place: str) -> EquationConditions:
        """Return the conditions of a text such as `c != 0, d > 0`; raises InputError for any other text."""
        apart, above = [], []
        for part in re.split(r",|\band\b", text):
            group = [_condition(each, signs, place) for each in re.split(r"\bor\b", part)]
            if len(group) > 1 and any(operator != "!=" for _, operator in group):
                raise InputError(
                    f'"{shown(part)}" has no plain meaning', where=place, repair='write "or" between != only'
                )
            if group[0][1] != ">=":
                apart.append(tuple(value for value, _ in group))
            if group[0][1] != "!=":
                above.append(group[0][0])
        return EquationConditions(text.strip(), _stronger(signs, apart, above), tuple(apart), tuple(above))

    def sign(self, value: Scalar) -> str:
        """Return the certain sign of a value."""
        found = sign_of(value, self.signs)
        ratios = [value / other for other in self.above if not other.is_zero]
        known = next((ratio.fraction() for ratio in ratios if ratio.is_constant and not ratio.is_zero), None)
        if known is None or found not in {"real", "nonzero"}:  # other ratios have denominators that may vanish
            return found
        return "nonnegative" if known > 0 else "nonpositive"

    def excludes(self, values: Sequence[Scalar], nonzero: tuple[Scalar, ...]) -> bool:
        """Return whether values are seen not to vanish together here, where factors in `nonzero` do not vanish."""
        single = [value for group in self.apart if len(group) == 1 for value in group]
        try:
            if never_together_zero(values, (), self.signs, (*nonzero, *vanishing_factors(single, self.signs))):
                return True
            ideal = Ideal.of(values)
            return any(all(value in ideal for value in group) for group in self.apart)
        except TooLarge:
            return False


def _condition(text: str, signs: Mapping[str, str], place: str) -> tuple[Scalar, str]:
    """Return (value, operator): it is != 0, > 0 or >= 0."""
    match = _CONDITION.fullmatch(text.strip())
    if match is None:
        repair = 'write for example "where c != 0, d > 0"'
        raise InputError(f'a condition is expected, but "{shown(text.strip())}" came', where=place, repair=repair)
    left, right = (parse_scalar(side, signs, where=place) for side in (match[1], match[3]))
    difference, operator = left - right, match[2]
    return (-difference, operator.replace("<", ">")) if "<" in operator else (difference, operator)


def _stronger(signs: Mapping[str, str], apart: Sequence[tuple[Scalar, ...]], above: Sequence[Scalar]) -> dict[str, str]:
    """Return the signs strengthened by conditions on single symbols."""
    found = {}
    for name, declared in signs.items():
        symbol = Scalar.symbol(name)
        sign = "nonnegative" if symbol in above else "nonpositive" if -symbol in above else declared
        strict = declared in _STRICT or any(group in {(symbol,), (-symbol,)} for group in apart)
        found[name] = (
            declared if declared in {"positive", "negative"} else _STRICT_OF.get(sign, sign) if strict else sign
        )
    return found


@dataclass
class Gap:
    """An exception: the common zeros of the values, or (`below`) negative values of a radicand."""

    values: tuple[Scalar, ...]
    says: str
    below: bool = False


@dataclass(frozen=False)
class Reading:
    """Letters and conditions of an equation; with `rounding`, decimals are read as generators.

    `gaps` are found as the equation is evaluated.  So are `squares`, f of a root of f² where the sign of f is open: its value
    is f, and for those in `turned` it is -f.  Where only the value is asked for, `kept` holds those of parts that were
    evaluated before in the same environment, by the letter or the identity of the part, which is held with it.
    """

    environment: Environment
    where: EquationConditions = field(default_factory=EquationConditions)
    rounding: bool = False
    turned: frozenset[Scalar] = frozenset()
    gaps: list[Gap] = field(default_factory=list)
    squares: list[Scalar] = field(default_factory=list)
    kept: Kept | None = None

    def fails_where(self, values: Iterable[Scalar], says: str) -> None:
        """Note that something fails where all these values are 0."""
        values, names = tuple(values), self.environment.signs.keys()
        if any(roots_in(value) and self.where.sign(value) in _NEVER_ZERO for value in values):
            return  # of its norm a factor may vanish that belongs to other signs of the roots
        found = [part for value in values for part in coefficients_over(_norm(value), names)]
        if not any(part.is_constant and not part.is_zero for part in found):
            self.gaps.append(Gap(tuple(found), says))

    def real_where(self, value: Scalar, root: str) -> None:
        """Note that a root is real only where a value is not negative."""
        if value.names <= self.environment.signs.keys() and self.where.sign(value) not in NOT_NEGATIVE:
            self.gaps.append(Gap((value,), f"{root} is not real", below=True))

    def sign_of_square(self, factor: Scalar) -> int:
        """Return 1 or -1, the sign that is read for a factor."""
        sign = self.where.sign(factor)
        if sign in NOT_NEGATIVE:
            return 1
        if sign in NOT_POSITIVE:
            return -1
        if factor not in self.squares:
            self.squares.append(factor)
        return -1 if factor in self.turned else 1


#: The signs of what never vanishes.
_NEVER_ZERO = {"positive", "negative", "nonzero"}


def _norm(value: Scalar) -> Scalar:
    """Return a value without square roots that vanishes where this one does."""
    value = value.numerator
    for root in roots_in(value):
        q = Scalar.symbol(root.name)
        both = value * value.substitute({root.name: -q})
        even = list(reversed(both.coefficients(root.name)))[::2]
        value = sum((part * root.argument**power for power, part in enumerate(even)), Scalar.of(0)).numerator
    return value


def exceptions(reading: Reading, nonzero: tuple[Scalar, ...]) -> tuple[list[str], list[str]]:
    """Return the further conditions of an equation, and the failures where they are violated.

    Letters have no value where one of `nonzero` vanishes, so that nothing is said of that.
    """
    needed: dict[str, None] = {}
    reasons: dict[str, None] = {}
    for gap in reading.gaps:
        if gap.below:
            needed[f"{text_of_value(gap.values[0])} >= 0"] = None
            reasons[f"{gap.says} where {text_of_value(gap.values[0])} < 0"] = None
        elif not reading.where.excludes(gap.values, nonzero):
            groups = _parts(gap.values, reading.where, nonzero)
            needed |= dict.fromkeys(" or ".join(f"{text_of_value(value)} != 0" for value in group) for group in groups)
            places = " or ".join(" and ".join(f"{text_of_value(value)} = 0" for value in group) for group in groups)
            reasons[f"{gap.says} where {places}"] = None
    return list(needed), list(reasons)


def _parts(values: Sequence[Scalar], where: EquationConditions, nonzero: tuple[Scalar, ...]) -> list[list[Scalar]]:
    """Return the components of the common zeros: each common factor, and the cofactors together."""
    factored: list[dict[Scalar, int]] = [dict(value.factors()[1]) for value in values if not value.is_zero]
    common = [factor for factor in factored[0] if all(factor in other for other in factored)]
    groups = [[factor] for factor in common if not where.excludes([factor], nonzero)]
    rest = [product_of([factor for factor in each if factor not in common]) for each in factored]
    if not any(value.is_constant for value in rest) and not where.excludes(rest, nonzero):
        try:
            groups.append(list(Ideal.of(rest).generators))
        except TooLarge:
            groups.append(rest)
    return groups


def text_of_value(value: Any) -> str:
    """Return a value in the grammar of printed equations."""
    return str(value).replace("**", "^")


# The grammar of printed equations: from text to trees.
#
# The tokens and the tree are those of every other expression (`formula.expression`), and three tokens more: `'` after
# an operand, its transpose or, behind a signal, its derivative; `=`; and the argument of a function, `P(s)`. A name is
# a letter, and is not evaluated here: letters do not commute.


FUNCTIONS = (
    ("det", 1),
    ("adj", 1),
    ("trace", 1),
    ("rank", 1),
    ("size", 1),
    ("eigenvalues", 1),
    ("rref", 1),
    ("ctrb", 2),
    ("obsv", 2),
    ("place", 3),
    ("Phi", 2),
    ("integral", 4),
    *((name, 1) for name in SCALAR_FUNCTIONS),
)


_ARGUMENTS = dict(FUNCTIONS)
MOST_CHARACTERS = 2_000
MOST_NODES = 200
MOST_EXPONENT = 12
#: `x(t)` and `P(s)` are x and P whatever they are.
_OF_ITS_VARIABLE = re.compile(rf"\([ ]*({'|'.join(VARIABLES)})[ ]*\)")


def read_relation(
    text: str, where: str, functions: Collection[str] = (), symbols: Collection[str] = ()
) -> tuple[SyntaxNode, ...]:
    """Return the members of a printed equation `a = b = …`; raises ExpressionError with the place of the fault.

    A letter of `functions` directly before "(" is applied to what stands there; before `(s)`, `(z)` or `(t)` any letter is
    but `symbols`, which are numbers.
    """
    source = Source(text, where)
    if len(text) > MOST_CHARACTERS:
        message = f"the equation has {len(text)} characters, more than {MOST_CHARACTERS}"
        raise source.error(message, 0, "print it in parts", kind=BudgetExceeded)
    members = parse(_Printed(source, functions, symbols).run(), source, "_EQUAL")
    parts = [part for member in members for part in every(member)]
    if len(parts) > MOST_NODES:
        raise source.error(f"the equation has more than {MOST_NODES} parts", 0, "print it in parts", BudgetExceeded)
    members = tuple(map(_with_roots, members))
    for part in (part for member in members for part in every(member)):
        _require_known(part, source)
    return members


def _with_roots(node: SyntaxNode) -> SyntaxNode:
    """Return a tree in which x^(p/2^n), with an odd p and n up to 4, is the p-th power of the root of the root … of x."""
    parts = tuple(map(_with_roots, node.parts))
    exponent = _fraction(parts[1]) if node.kind == "power" else None
    if exponent is None or exponent.denominator not in _ROOTS:
        return node if parts == node.parts else replace(node, parts=parts)
    root = parts[0]
    for _ in range(exponent.denominator.bit_length() - 1):
        root = SyntaxNode("call", (root,), "sqrt", None, node.places)
    power = SyntaxNode("number", (), str(abs(exponent.numerator)), Scalar.of(abs(exponent.numerator)))
    power = SyntaxNode("negative", (power,)) if exponent.numerator < 0 else power
    return root if exponent.numerator == 1 else replace(node, parts=(root, power))


#: The denominators of exponents that are read as roots of roots.
_ROOTS = {2, 4, 8, 16}


def _fraction(node: SyntaxNode) -> Fraction | None:
    """Return the number that an exponent of numbers alone is, None for any other."""
    if node.kind == "number" and isinstance(node.value, Scalar) and node.value.is_constant:
        return node.value.fraction()
    parts = [_fraction(part) for part in node.parts]
    if node.kind == "negative" and parts[0] is not None:
        return -parts[0]
    if node.kind == "quotient" and parts[0] is not None and parts[1]:
        return parts[0] / parts[1]
    return None


def _require_known(part: SyntaxNode, source: Source) -> None:
    """Refuse exponents that are no integers, and functions of another number of arguments."""
    if part.kind == "power":
        exponent = exponent_of(part)
        if exponent is None or abs(exponent) > MOST_EXPONENT:
            of_e = EXPONENTIAL if part.parts[0].text == "e" else ""
            message = f"an exponent is an integer up to {MOST_EXPONENT}{of_e}"
            raise source.error(message, part.places[0], "write A^-1 for the inverse, A' for the transpose")
    if part.kind == "call" and len(part.parts) != _ARGUMENTS[part.text]:
        count = _ARGUMENTS[part.text]
        message = f"{part.text} takes {count} argument{'s' if count > 1 else ''}"
        raise source.error(message, part.places[0], "set them apart by commas")


class _Printed(Tokeniser):
    """Cuts a printed equation into tokens; a letter is a VALUE without a value."""

    pattern = re.compile(rf"{TOKENS}|(?P<PRIME>['ᵀ])|(?P<EQUAL>=)")

    def __init__(self, source: Source, functions: Collection[str], symbols: Collection[str]) -> None:
        super().__init__(source, Scope.of(None, None, source.where))
        self.applied = functions
        self.numbers = symbols

    def _take(self, kind: str, text: str, at: int) -> None:
        if kind == "EQUAL" and self.open:
            raise self.source.error('"=" stands inside brackets', at, "close them first")
        if kind == "EQUAL" or (kind == "COMMA" and self.open and not self._in_brackets()):
            self.spaced = False
            self._add("_EQUAL" if kind == "EQUAL" else "_COMMA", text, at)
        else:
            super()._take(kind, text, at)

    def _imply(self, kind: str, at: int) -> None:
        if kind == "OPEN" and self._is_applied(at):
            self._add("APPLY", "", at)
        else:
            super()._imply(kind, at)

    def _is_applied(self, at: int) -> bool:
        """Return whether the "(" here opens the argument of the preceding letter."""
        letter = next((token for token in reversed(self.tokens) if token.type != "PRIME"), None)
        if (
            self.spaced
            or letter is None
            or letter.type != "VALUE"
            or letter.value is not None
            or letter in self.numbers
        ):
            return False
        return letter in self.applied or _OF_ITS_VARIABLE.match(self.text, at) is not None

    def _name(self, name: str, at: int, end: int) -> None:
        called = self.text.startswith("(", end)
        if name in _ARGUMENTS and called:
            self._add("FUNCTION", name, at)
        elif len(name) > 64:
            raise self.source.error("a letter has more than 64 characters", at, "shorten it")
        else:
            self._add("VALUE", name, at)


# Values of the letters of a source: the plant and the checked answers, in its letters and signs.
#
# `values` is the one place that knows a convention's letters for matrices, `signals` the one for signals.


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


@dataclass
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
    if name == "plusK-minusHC" and L is not None and m.C is not None and L.shape == m.C.T.shape:
        found |= {"F": m.A - L @ m.C, "G": m.B}  # of x̂' = F x̂ + G u + H y
    if not plant.is_time_varying and not any("polynomial" in result.fields for result in results):
        found.setdefault("chi", PlantMatrices.of(plant).A.characteristic_polynomial(plant.variable))
    for result in reversed(results):
        found |= result.named_data
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
    parts = partition(plant, Matrix.identity(n))
    found: dict[str, Value | None] = {f"A_{i}": getattr(parts, f"A{i}") for i in (11, 12, 21, 22)}
    found |= {"B_1": parts.B1, "B_2": parts.B2}
    found |= {"C": first, "k": Scalar.of(p)} if convention.name in MEASURED else {}
    if K is not None:
        found |= {f"K_{i}": K.select(range(K.shape[0]), part) for i, part in ((1, range(p)), (2, range(p, n)))}
    if L is None or L.shape != (n - p, p):
        return found
    measured = L @ first
    F = parts.A22 - measured @ parts.A12
    u = None if parts.B1 is None else parts.B2 - measured @ parts.B1  # type: ignore[operator]
    y = F @ L + (parts.A21 - measured @ parts.A11) @ first.inverse()
    written = convention.written(reduced=True)
    found |= {"G_u": u, "G_y": y, "F_z": F, written.get("H_z", "H"): y, written.get("G_z", "G"): u}
    return found | {"dp": F.characteristic_polynomial(plant.variable)}


def leading_block(C: Matrix | None) -> Matrix | None:
    """Return C₁ of C = [C₁ 0] where it is invertible, else None."""
    if C is None or C.shape[0] > C.shape[1]:
        return None
    first, rest = C.select(range(C.shape[0]), range(C.shape[0])), range(C.shape[0], C.shape[1])
    regular = rank(first) == C.shape[0] and C.select(range(C.shape[0]), rest).is_zero
    return first if regular else None


# Signals of a source: the equations of plant, observer and control law, in its names.


@dataclass(frozen=False)
class _Signals:
    """The signals of an environment, collected one by one; `parts` are the rows of signals."""

    formulas: dict[str, Formula | None] = field(default_factory=dict)
    sizes: dict[str, int] = field(default_factory=dict)
    dynamics: dict[str, Formula] = field(default_factory=dict)
    parts: dict[str, Mapping[str, Formula]] = field(default_factory=dict)

    def free(self, name: str, size: int, rate: Formula | None = None) -> None:
        self.formulas[name], self.sizes[name] = None, size
        if rate is not None:
            self.dynamics[name] = rate

    def stacked(self, name: str, rate: Formula, parts: Mapping[str, Matrix], *, apart: bool) -> None:
        """Add a signal and its parts, from which it is stacked where they stand `apart`."""
        self.parts[name] = {part: _times(rows, name) for part, rows in parts.items()}
        self.formulas |= self.parts[name]
        self.free(name, sum(rows.shape[0] for rows in parts.values()), rate)
        if apart:
            for part, rows in parts.items():
                self.free(part, rows.shape[0], Product((Literal(rows), rate)))
            self.formulas[name] = Block(tuple((Letter(part),) for part in parts))

    def of_components(self, name: str, size: int, rate: Formula, mentioned: Collection[str]) -> None:
        """Add a signal, stacked from its components if the equation contains one of them."""
        parts = {f"{name}_{i + 1}": Matrix.unit(size, i).T for i in range(size)}
        self.stacked(name, rate, parts, apart=not parts.keys().isdisjoint(mentioned))

    def apart(self, name: str, whole: str, other: str, *, own: bool) -> None:
        """Add name = whole - other, which with equations of its `own` takes the place of the other."""
        if own:
            rate = Sum((Derivative(Letter(whole)), Negative(self.dynamics[other])))
            self.free(name, self.sizes[other], rate)
            self.formulas |= self.parts.get(other, {})
            name, other = other, name
        self.formulas[name] = Sum((Letter(whole), Negative(Letter(other))))


def _times(matrix: Matrix, signal: str) -> Formula:
    return Product((Literal(matrix), Letter(signal)))


def telling(plant: StateSpace, convention: Convention) -> frozenset[str]:
    """Return the letters on which it depends, where they stand in an equation, which signals are free in it."""
    called = _called(convention)
    components = {f"{name}_{i + 1}" for name in ("x", called["x_hat"]) for i in range(plant.order)}
    return frozenset({"x", "u", "y", "z", "x_hat", *called.values(), *components})


def _called(convention: Convention) -> dict[str, str]:
    """Return the names of errors and estimates in a convention."""
    called = {key: convention.letters.get(key, key) for key in ("e", "e_2", "e_d", "x_hat")}
    return {**called, "x_hat_2": convention.letters.get("x_2_hat", "x_hat_2")}


def signals(
    plant: StateSpace,
    results: Sequence[Result],
    convention: Convention,
    mentioned: Collection[str],
    right: Collection[str],
) -> Environment:
    """Return the environment of the signals of an equation.

    y stands by itself where nothing of x is `mentioned`, u where it is; the error replaces the estimate where it stands
    on the `right`.
    """
    m, answers, called = PlantMatrices.of(plant), answers_of(results), _called(convention)
    K, L, known = answers.get("K"), answers.get("L"), _Signals()
    first, p = leading_block(m.C), 0 if m.C is None else m.C.shape[0]
    states = {"x", called["e"], called["e_2"], called["e_d"], *(f"x_{i + 1}" for i in range(plant.order))}
    measured = m.C is not None and not states & set(mentioned)
    if measured:
        known.free("y", p, Letter("y'"))
        known.free("y'", p)
    fed_back = K is not None and "u" not in right and (L is not None or "x_hat" not in mentioned)
    if m.B is not None and not fed_back:
        known.free("u", m.B.shape[1], Letter("u'"))
        known.free("u'", m.B.shape[1])
    rate = _sum(_times(m.A, "x"), _times(m.B, "u") if m.B is not None else None)
    reduced = L is not None and L.shape == (plant.order - p, p)
    if first is not None and (reduced or convention.name in MEASURED):
        identity, every = Matrix.identity(plant.order), range(plant.order)
        parts = {"x_1": identity.select(every[:p], every), "x_2": identity.select(every[p:], every)}
        known.stacked("x", rate, parts, apart=True)
        if L is not None and reduced:
            _reduced_order(known, plant, (L, first), called, right)
    else:
        known.of_components("x", plant.order, rate, mentioned)
    if L is not None and L.shape == (plant.order, p):
        _full_order(known, m, L, called, (mentioned, right))
    if (L is not None or "K_d" in answers) and called["x_hat"] not in known.formulas:
        known.free(called["x_hat"], plant.order)  # the law needs it, its equations are not known
    if m.C is not None and not measured:
        through = None if m.D is None or m.D.is_zero else _times(m.D, "u")
        known.formulas["y"] = _sum(_times(m.C, "x"), through)
    if "K_d" in answers:
        _tracking(known, answers, called, right)
    elif fed_back and m.B is not None:
        law = -K  # type: ignore[operator]
        known.formulas["u"] = _times(law, called["x_hat"] if L is not None else "x")
    return Environment(variable=plant.variable, signals=known.formulas, sizes=known.sizes, dynamics=known.dynamics)


def _sum(*terms: Formula | None) -> Formula:
    there = tuple(term for term in terms if term is not None)
    return there[0] if len(there) == 1 else Sum(there)


def _full_order(
    known: _Signals,
    m: PlantMatrices,
    L: Matrix,
    called: Mapping[str, str],
    letters: tuple[Collection[str], Collection[str]],
) -> None:
    """Add x̂ and e = x - x̂, one of which has equations of its own."""
    mentioned, right = letters
    estimate, error = called["x_hat"], called["e"]
    through = None if m.D is None or m.D.is_zero else m.D
    inputs = None if m.B is None else _times(m.B if through is None else m.B - L @ through, "u")
    closed = m.A if m.C is None else m.A - L @ m.C
    rate = _sum(_times(closed, estimate), inputs, _times(L, "y"))
    own = error in right and estimate not in right
    known.of_components(estimate, m.A.shape[0], rate, () if own else mentioned)
    known.apart(error, "x", estimate, own=own)


def _reduced_order(
    known: _Signals,
    plant: StateSpace,
    gains: tuple[Matrix, Matrix],
    called: Mapping[str, str],
    right: Collection[str],
) -> None:
    """Add z, x̂₂ and e₂ of a minimal-order observer, one of which has equations of its own."""
    (L, first), found = gains, blocks_of(plant, None, gains[0], STANDARD)
    estimate, error = called["x_hat_2"], called["e_2"]
    own = next((name for name in ("z", estimate, error) if name in right), "z")
    inputs = _times(found["G_u"], "u") if plant.inputs else None  # type: ignore[arg-type]
    z_rate = _sum(_times(found["F_z"], "z"), inputs, _times(found["G_y"], "y"))  # type: ignore[arg-type]
    if own == "z":
        known.free("z", L.shape[0], z_rate)
        known.formulas[estimate] = Sum((Letter("z"), _times(L, "y")))
    else:
        known.free(estimate, L.shape[0], Sum((z_rate, _times(L, "y'"))))
        known.formulas["z"] = Sum((Letter(estimate), Negative(_times(L, "y"))))
        known.formulas.setdefault("y'", Derivative(Letter("y")))
    known.apart(error, "x_2", estimate, own=own == error)
    measured = _times(first.inverse(), "y")
    known.formulas[called["x_hat"]] = Block(((measured,), (Letter(estimate),)))
    known.formulas.setdefault("x_hat_1", measured)


def _tracking(known: _Signals, answers: Mapping[str, Any], called: Mapping[str, str], right: Collection[str]) -> None:
    """Add the reference x_d, the error e = x_d - x and the law u = K (x_d - x₀) - K_d x_d."""
    order = answers["K_d"].shape[1]
    known.free("x_d", order, Product((Letter("A_d"), Letter("x_d"))))
    if "u" not in known.sizes:
        apart = Sum((Letter("x_d"), Negative(Letter(called["x_hat"]))))
        law = (Product((Literal(answers["K"]), apart)), Negative(_times(answers["K_d"], "x_d")))
        known.formulas["u"] = Sum(law)
    known.apart(called["e_d"], "x_d", "x", own=called["e_d"] in right)
