"""The printer: traversal of a formula with precedences; a format supplies the glyphs.

A printed part is a `Box`: what is written, how wide it is, and how tightly it binds.  Nothing is rewritten on the way:
`A - L C` is printed as its author wrote it; only exact values are spelled out (`formula_of`).
"""

from __future__ import annotations

from abc import abstractmethod
from copy import copy
from dataclasses import replace
from typing import TYPE_CHECKING, Self

from symobs.exact import EIGENVALUE, Matrix, Scalar, decimal_digits, significant
from symobs.exact.algebraic.real_algebraic import RealRoot
from symobs.exact.algebraic.root_parts import RootPart
from symobs.exact.algebraic.root_sum import RootSum
from symobs.exact.core.generators import function_named
from symobs.exact.time_functions.matrix_power import PowerOf
from symobs.formula.notation import (
    FUNCTIONS,
    LETTERS,
    SIGNALS,
    TIMED,
    is_of_time,
    shows_time,
    symbol_latex,
    symbol_text,
)
from symobs.formula.phrases.languages import ENGLISH
from symobs.formula.tree import (
    Apply,
    At,
    Block,
    Decimals,
    Derivative,
    Formula,
    Identity,
    Integral,
    Letter,
    Literal,
    Negative,
    Numeral,
    Power,
    Product,
    Quotient,
    Relation,
    Sum,
    Transpose,
    children,
    with_children,
)
from symobs.pages.printers.glyphs import B, FormulaWriter, Level
from symobs.pages.printers.rational_formula import is_leaf, is_negative
from symobs.pages.printers.scalar_formula import factors, formula_of, formula_of_matrix, is_table, partitioned, wave

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.exact.core.generators import Function
    from symobs.formula.notation import LetterForm
    from symobs.formula.phrases.languages import Language

#: Formulas that are kept in print from one answer to the next.
_MOST_REMEMBERED = 4000
#: In a line of text a column of more entries is a row, transposed, and a matrix of more rows a list.
ROWS_IN_A_LINE = 2

_BELOW = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")


def _with_index(latex: str, index: str) -> str:
    stem, below, own = latex.partition("_")
    if below:
        return f"{stem}_{{{own.strip('{}')},{index}}}"
    return f"{stem}_{index}" if len(index) == 1 else f"{stem}_{{{index}}}"


class Printer(FormulaWriter[B]):
    """Formula → mathematics of one format."""

    #: Whether mathematics is printed into a line of text.
    running = False

    def __init__(
        self, variable: str = "s", symbols: Mapping[str, str] | None = None, *, discrete: bool = False
    ) -> None:
        """Print polynomials in `variable`; `symbols` are the declared forms of parameters."""
        self.variable = variable
        self.symbols = dict(symbols or {})
        self.letters: Mapping[str, LetterForm] = LETTERS
        self.language: Language = ENGLISH
        self.discrete = discrete
        #: What is printed already, by the style it is printed in; `known` is that of this printer's own style.
        self.memory: dict[tuple[object, ...], dict[Scalar | Formula, B]] = {}
        self.known = self.memory.setdefault(self.style, {})
        #: The entries named by stars so far, numbered through the page.
        self.stars: dict[Formula, int] = {}

    def remember(self, memory: dict[tuple[object, ...], dict[Scalar | Formula, B]]) -> None:
        """Go on with what another printer of the same letters has printed; a memory that is full begins anew."""
        if sum(map(len, memory.values())) > _MOST_REMEMBERED:
            memory.clear()
        self.memory = memory
        self.known = memory.setdefault(self.style, {})

    def keep_time(self, time: tuple[str, bool] | None) -> None:
        """Go on with this variable, in continuous or discrete time."""
        if time is not None and time != (self.variable, self.discrete):
            self.variable, self.discrete = time
            self.known = self.memory.setdefault(self.style, {})

    @property
    def style(self) -> tuple[object, ...]:
        """What changes between one formula of a page and the next."""
        return self.variable, self.discrete

    def styled(self, **style: bool) -> Self:
        """Return this printer in another style."""
        other = copy(self)
        vars(other).update(style)
        other.known = self.memory.setdefault(other.style, {})
        return other

    @abstractmethod
    def inline(self, item: Formula | Relation) -> str:
        """Return mathematics for a line of text, without delimiters."""

    @abstractmethod
    def display(self, relations: Sequence[Relation], *, boxed: int = 0, end: str = ".") -> str:
        """Return a whole display, lines broken where long; the last members of so many relations at the end are boxed."""

    # -- letters --------------------------------------------------------------------------------------------------

    def letter_latex(self, name: str) -> str:
        """Return the LaTeX of a letter, its variable put in, of a component `x[1` of a signal, or of a parameter."""
        if "[" in name:
            return _with_index(self.letter_latex(name.partition("[")[0]), name.partition("[")[2])
        form = self.letters.get(name)
        return form.latex.replace("{v}", self.variable) if form else symbol_latex(name, self.symbols.get(name))

    def letter_text(self, name: str) -> str:
        """Return a letter as a terminal shows it, its variable put in, or a parameter."""
        if "[" in name:
            text = self.letter_text(name.partition("[")[0])
            return text + ("," if text[-1].isnumeric() else "") + name.partition("[")[2].translate(_BELOW)
        form = self.letters.get(name)
        return form.text.replace("{v}", self.variable) if form else symbol_text(name)

    def function_latex(self, name: str) -> str:
        """Return the LaTeX of a function's name."""
        if name == "rank":
            return rf"\operatorname{{{self.language.words['rank']}}}"
        known = self.letters[name].latex if name in self.letters else FUNCTIONS.get(name, ("",))[0]
        return known or rf"\operatorname{{{name.replace('_', ' ')}}}"

    # -- the walk -------------------------------------------------------------------------------------------------

    def relation(self, item: Relation) -> B:
        """Print a chain of equations and comparisons."""
        item = with_zero(item)
        parts = [self.typeset(item.members[0])]
        for operator, member in zip(item.operators, item.members[1:], strict=True):
            parts += [self.comparison(operator), self.typeset(member)]
        return self.joined(parts, Level.SUM)

    def typeset(self, formula: Formula) -> B:
        """Print a formula; equal ones are printed once."""
        if isinstance(formula, Literal) and isinstance(formula.value, Scalar):
            return self.scalar(formula.value)
        box = self.known.get(formula)
        if box is None:
            box = self.known[formula] = self._printed(formula)
        return box

    def _printed(self, formula: Formula) -> B:
        match formula:
            case Sum() | Negative():
                return self.joined(self.sum_parts(formula), Level.SUM)
            case Product():
                return self.product(formula)
            case Quotient():
                return self.quotient(formula)
            case Power(base, exponent):
                return self.typeset(base) if exponent == 1 else self.raised(self.base(base), exponent)
            case Letter(name):
                return self.letter(name, "k" if self.discrete and name in SIGNALS else "")
            case Literal(Matrix(shape=(1, 1)) as value):
                return self.scalar(value[0, 0])
            case Literal(Matrix() as value):
                written = formula_of_matrix(value, self.variable)
                return self.product(written) if isinstance(written, Product) else self.plain_matrix(value)
            case Decimals(Scalar() as value):
                return self.decimals(value)
            case Decimals(Matrix(shape=(1, 1)) as value):
                return self.decimals(value[0, 0])
            case Decimals(Matrix() as value):
                return self.matrix([[self.decimals(entry) for entry in row] for row in value.rows])
            case Numeral(text=text):
                return self.numeral(text)
            case Identity():
                return self.identity()
            case Transpose(Literal(Matrix() as value)) if self.running and value.shape[1] == 1:
                return self.plain_matrix(value.T)
            case Transpose(operand):
                return self.transposed(self.base(operand))
            case Apply(function, argument):
                return self.application(function, argument)
            case Block(rows) if table := partitioned(rows):
                entries, rules = table
                return self.matrix([[self.typeset(entry) for entry in row] for row in entries], rules)
            case Block(((entry,),)):
                return self.block_entry(entry)
            case Block(rows):
                return self.matrix([[self.block_entry(entry) for entry in row] for row in rows])
            case Derivative(operand, name):
                return self.derivative(operand, name)
            case At(operand, name, instant):
                return self.at_instant(operand, {name: instant})
            case Integral(integrand, _, name, lower, upper):
                limits = self.scalar(lower), self.scalar(upper)
                return self.integral(limits, self.at_least(Level.PRODUCT, self.typeset(integrand)), self.symbol(name))
        raise TypeError(formula)

    def scalar(self, value: Scalar) -> B:
        """Return an exact scalar, spelled out once."""
        box = self.known.get(value)
        if box is None:
            box = self.known[value] = self.rational(value) if value.is_constant else self.expression(value)
        return box

    def rational(self, value: Scalar) -> B:
        """Return a number: a whole one or a fraction, its minus in front."""
        negative = is_negative(value)
        box = self.leaf(-value.numerator if negative else value.numerator)
        if not value.denominator_part.is_one():
            box = self.fraction(box, self.leaf(value.denominator))
        return self.joined([self.sign(negative=True, leading=True), box], Level.SUM) if negative else box

    def expression(self, value: Scalar) -> B:
        """Return what is no number: a symbol, a function of time, or what is made of them."""
        if not is_leaf(value):
            return self.typeset(formula_of(value, self.variable))
        function = function_named(next(iter(value.names)))
        return self.leaf(value) if function is None else self.function_of_time(function)

    def decimals(self, value: Scalar) -> B:
        """Return a number with its digits after the decimal mark of the language."""
        box = self.numeral(decimal_digits(value))
        return self.joined([self.sign(negative=True, leading=True), box], Level.SUM) if is_negative(value) else box

    def numeral(self, text: str) -> B:
        """Return decimals, 1.2346e-7 with its power of ten."""
        digits, _, power = text.partition("e")
        digits = self.language.decimal(digits)
        if not power:
            return self.digits(digits)
        ten = self.raised(self.digits("10"), int(power))
        return ten if digits == "1" else self.joined(self.spaced([self.digits(digits), ten]), Level.FRACTION)

    def function_of_time(self, function: Function) -> B:
        """Return a function of time or a root, e^{−t}, sin ωt, √3, or the letter defined for it."""
        if function.name in self.symbols:
            return self.named(self.symbols[function.name])
        if function.kind == "exp":
            return self.exponential(function.argument)
        if isinstance(function, RealRoot) and function.radicand is not None:
            return self.root(self.scalar(function.radicand), function.number.degree)
        if isinstance(function, RealRoot):
            digits = self.language.decimal(str(function.number.truncated())).replace(",", "{,}")
            return self.named(rf"{digits}\ldots")
        if isinstance(function, RootPart):
            return self.numeral(significant(function.value, function.digits) or "")
        if isinstance(function, RootSum):
            q, below = (self.typeset(formula_of(part, EIGENVALUE)) for part in (function.polynomial, function.slope))
            over = self.joined([q, self.comparison("="), self.scalar(Scalar.of(0))], Level.SUM)
            above, rising = function.numerator, function.summand * function.slope / function.numerator
            parts = (Literal(rising),) if above.is_one else (formula_of(above, EIGENVALUE), Literal(rising))
            return self.summed(over, self.fraction(self.typeset(Product(parts)), below))
        if isinstance(function, PowerOf):
            return self.power_of(function)
        argument = self.scalar(function.argument)
        if function.kind == "sqrt":
            inner = function_named(next(iter(function.argument.names), "")) if is_leaf(function.argument) else None
            if inner is not None and inner.kind == "sqrt" and inner.name not in self.symbols:
                return self.root(self.radicand(inner.argument), 4)
            return self.root(self.radicand(function.argument))
        is_plain = argument.level >= Level.PRODUCT and not isinstance(formula_of(function.argument, ""), Quotient)
        return self._wave(function, argument if is_plain else self.grouped(argument))

    def radicand(self, value: Scalar) -> B:
        """Return what stands under a root: a fraction of products with a slash."""
        written = formula_of(value, self.variable)
        is_short = isinstance(written, Quotient) and not any(isinstance(part, Sum) for part in children(written))
        return (self.styled(in_exponent=True) if is_short else self).scalar(value)

    def exponent(self, argument: Scalar) -> B:
        """Return the argument of an exponential: −s/2, whatever polynomials of s look like elsewhere."""
        return self.typeset(formula_of(argument, ""))

    def power_of(self, function: PowerOf) -> B:
        """Return λᵏ, Re (σ + iω)ᵏ, or δ(k, j)."""
        if function.kind == "KroneckerDelta":
            return self.called(self.named(r"\delta"), [self.symbol("k"), self.scalar(function.base)])
        if function.kind == "power":
            return self.to_the_instant(self.at_least(Level.ATOM, self.scalar(function.base)))
        turned = function.imaginary
        unit = self.named("i")
        parts = [] if function.base.is_zero else [self.scalar(function.base), self.sign(negative=False, leading=False)]
        parts += [unit] if turned.is_one else self.spaced([self.at_least(Level.PRODUCT, self.scalar(turned)), unit])
        whole = self.grouped(self.joined(parts, Level.SUM)) if len(parts) > 1 else parts[0]
        return self._wave(function, self.grouped(self.to_the_instant(whole)))

    def _wave(self, function: Function, argument: B) -> B:
        """Return cos ωt, which binds like a power."""
        return replace(self.applied(function.kind, argument), level=Level.POWER)

    def sum_parts(self, formula: Formula) -> list[B]:
        """Return the terms of a sum with their signs between them."""
        parts: list[B] = []
        for negative, term in signed_terms(formula, self.variable):
            if parts or negative:
                parts.append(self.sign(negative=negative, leading=not parts))
            parts.append(self.at_least(Level.PRODUCT, self.typeset(term)))
        return parts

    def product(self, formula: Product) -> B:
        """Return juxtaposed factors, with a dot before a number that is not the first."""
        ((negative, body),) = signed_terms(formula, self.variable, flat=False)
        parts = self.factor_boxes(body)
        sign = [self.sign(negative=True, leading=True)] if negative else []
        return self.joined([*sign, *self.spaced(parts)], Level.SUM if negative else Level.PRODUCT)

    def spaced(self, parts: Sequence[B]) -> list[B]:
        """Return factors with their separators."""
        row: list[B] = []
        for part in parts:
            between = self.between(row[-1], part) if row else None
            row += [part] if between is None else [between, part]
        return row

    def factor_boxes(self, formula: Formula) -> list[B]:
        """Return the factors of a product, parenthesised by precedence."""
        parts = factors(formula, self.variable)
        return [self.factor(part, after) for part, after in zip(parts, [*parts[1:], None], strict=True)]

    def factor(self, formula: Formula, after: Formula | None) -> B:
        """Return one factor; a function's argument is separated from what follows: cos(2t) I, but cos t sin t."""
        if isinstance(formula, Apply) and after is not None:
            return self.applied(formula.function, self.grouped(self.typeset(formula.argument)))
        turning = wave(formula)
        if turning is not None and after is not None and wave(after) is None:
            return self._wave(turning, self.grouped(self.scalar(turning.argument)))
        box = self.typeset(formula)
        return box if isinstance(formula, Apply) else self.at_least(Level.FRACTION, box)

    def quotient(self, formula: Quotient) -> B:
        """Return a fraction with the minus of its numerator in front."""
        ((negative, body),) = signed_terms(formula, self.variable, flat=False)
        if isinstance(body, Quotient):
            box = self.fraction(self.typeset(body.numerator), self.typeset(body.denominator))
        else:
            box = self.typeset(body)
        return self.joined([self.sign(negative=True, leading=True), box], Level.SUM) if negative else box

    def base(self, formula: Formula) -> B:
        """Return the base of an exponent or a transposition sign."""
        if isinstance(formula, Literal) and isinstance(formula.value, Matrix) and is_table(formula):
            return self.plain_matrix(formula.value)
        return self.at_least(Level.ATOM, self.typeset(formula))

    def application(self, function: str, argument: Formula) -> B:
        """Return det A, but det(sI − A); polynomials of a matrix always with parentheses."""
        is_matrix = is_table(argument)
        inner = self.base(argument) if is_matrix else self.typeset(argument)
        if inner.level < Level.POWER or (function.endswith("_at") and not is_matrix):
            inner = self.grouped(inner)
        return self.applied(function, inner)

    def derivative(self, operand: Formula, name: str) -> B:
        """Return ẋ, or d/dt of a stack, or ∂f/∂θ; in discrete time the next instant."""
        if isinstance(operand, Letter) and (name not in {"t", "s", "z"} or operand.name in {"f_x", "h_x"}):
            partial, above, below = self.letter("partial", ""), self.letter(operand.name, ""), self.symbol(name)
            return self.fraction(*(self.joined((partial, box), Level.ATOM) for box in (above, below)))
        if name != "t":
            return self.rate(self.at_least(Level.FRACTION, self.typeset(operand)), name)
        if isinstance(operand, Letter) and is_of_time(operand.name):
            return self.rate(self.letter(operand.name, ""))
        if self.discrete:
            if isinstance(operand, Letter):
                return self.letter(operand.name, "k+1")
            return self.typeset(shifted(operand))
        if isinstance(operand, Letter):
            return self.letter(operand.name, "dot")
        return self.rate(self.at_least(Level.FRACTION, self.typeset(operand)))

    def symbol(self, name: str) -> B:
        """Return a parameter's name."""
        return self.leaf(Scalar.symbol(name))

    def at_instant(self, operand: Formula, instants: dict[str, Scalar]) -> B:
        """Return the value at an instant: B(σ), Φ(t₁, t₀), else with t = t₁ behind a bar."""
        match operand:
            case At(inner, name, instant):
                return self.at_instant(inner, {name: instant, **instants})
            case Letter(name) if name in TIMED:
                shown = [self.scalar(instants.get(time, Scalar.symbol(time))) for time in TIMED[name]]
                return self.called(self.letter(f"{name}_", ""), shown)
            case Letter(name) if not shows_time(name):
                return self.called(self.letter(name, ""), [self.scalar(instant) for instant in instants.values()])
        return self.evaluated(self.at_least(Level.POWER, self.typeset(operand)), self.equations(instants))

    def equations(self, instants: Mapping[str, Scalar]) -> list[B]:
        """Return what stands behind the bar: θ = π, ω = u = 0."""
        shared: dict[Scalar, list[B]] = {}
        for name, instant in instants.items():
            shared.setdefault(instant, []).extend((self.symbol(name), self.comparison("=")))
        return [self.joined([*names, self.scalar(instant)], Level.SUM) for instant, names in shared.items()]

    def called(self, function: B, arguments: Sequence[B]) -> B:
        """Return a function before its arguments in parentheses."""
        inside = [arguments[0]]
        for argument in arguments[1:]:
            inside += [self.separators()[0], argument]
        return self.joined([function, self.grouped(self.joined(inside, Level.SUM))], Level.ATOM)

    def plain_matrix(self, matrix: Matrix) -> B:
        """Return a matrix, entry by entry."""
        if 0 in matrix.shape:
            return self.empty(matrix.shape)
        if self.running and matrix.shape[0] > ROWS_IN_A_LINE and matrix.shape[1] == 1:
            return self.transposed(self.plain_matrix(matrix.T))
        return self.matrix([[self.scalar(entry) for entry in row] for row in matrix.rows])

    def block_entry(self, formula: Formula) -> B:
        """Return a block; a zero matrix among blocks is 0."""
        if is_zero_table(formula):
            return self.leaf(Scalar.of(0))
        return self.typeset(formula)

    def at_least(self, level: Level, box: B) -> B:
        """Parenthesise a box that binds less tightly."""
        return box if box.level >= level else self.grouped(box)


def with_zero(relation: Relation) -> Relation:
    """Return a relation with 0 for a zero matrix, M v = 0, but where a letter is that matrix."""
    first = relation.members[0]
    while isinstance(first, Derivative | Transpose):
        first = children(first)[0]
    if isinstance(first, Letter | Literal):
        return relation
    zero = Literal(Scalar.of(0))
    members = (zero if is_zero_table(member) else member for member in relation.members[1:])
    return replace(relation, members=(relation.members[0], *members))


def is_zero_table(formula: Formula) -> bool:
    """Return whether a formula is a matrix of zeros."""
    return isinstance(formula, Literal) and isinstance(formula.value, Matrix) and formula.value.is_zero


def shifted(formula: Formula) -> Formula:
    """Return the formula of the next instant, with the shift moved one level inwards."""
    return with_children(formula, tuple(Derivative(part) for part in children(formula)))


def signed_terms(formula: Formula, variable: str, *, flat: bool = True) -> list[tuple[bool, Formula]]:
    """Return the terms of a sum as (whether subtracted, term); a minus inside a first factor counts.

    With `flat=False` a sum stays one term.
    """
    match formula:
        case Sum(terms) if flat:
            return [part for term in terms for part in signed_terms(term, variable)]
        case Negative(operand):
            return [(True, operand)]
        case Literal(Matrix(shape=(1, 1)) as value):
            return signed_terms(Literal(value[0, 0]), variable, flat=flat)
        case Literal(Scalar() as value) if not is_leaf(value):
            written = formula_of(value, variable)
            return signed_terms(written, variable) if flat or not isinstance(written, Sum) else [(False, formula)]
        case Product((first, *rest)):
            ((negative, body),) = signed_terms(first, variable, flat=False)
            unit = isinstance(first, Literal) and isinstance(first.value, Matrix) and body == Literal(Scalar.of(1))
            return (
                [(True, Product(tuple(rest) if unit and rest else (body, *rest)))] if negative else [(False, formula)]
            )
        case Quotient(above, below):
            ((negative, body),) = signed_terms(above, variable, flat=False)
            return [(True, Quotient(body, below))] if negative else [(False, formula)]
        case _:
            return [(False, formula)]
