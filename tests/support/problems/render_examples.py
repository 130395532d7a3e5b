"""A derivation written by hand: the steps of the page to aim at, checked line by line as any other."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar
from symobs.exact.algebraic.polynomial_roots import roots_of
from symobs.formula.tree import (
    Apply,
    Block,
    Derivative,
    Environment,
    Evaluated,
    Formula,
    Identity,
    Letter,
    Literal,
    Negative,
    Power,
    Predicate,
    Product,
    Quotient,
    Relation,
    Roots,
    Sum,
    Transpose,
)
from symobs.ground.dataclass import dataclass
from symobs.proof.derivation import (
    CaseStep,
    Conclude,
    Define,
    Derivation,
    Diagram,
    Equal,
    Given,
    Note,
    Section,
    Sentence,
)
from symobs.tasks.result import Document

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.formula.tree import Fact

#: The sentences of the page; tests put them among the phrases while they run.
PHRASES = {
    "test_state_feedback": "State feedback.",
    "test_observer": "Observer.",
    "test_compensator": "Compensator.",
    "test_closed_loop": "Closed loop.",
    "test_poles": "control poles {control} and observer poles {observer}.",
    "test_canonical": (
        "The pair ($A$, $B$) is already in controllable canonical form, with {chi}, so the gain is the difference of "
        "coefficients. The control poles ask for"
    ),
    "test_as_required": "{check}, as required.",
    "test_full_rank": "The observability matrix has full rank,",
    "test_dual": (
        "so by Theorem 4.4 the poles of $A - L C$ can be placed at will. We place them for the dual pair ($Aᵀ$, $Cᵀ$), "
        "whose controllability matrix is {dual}:"
    ),
    "test_differences": (
        "With {phi}, the differences of coefficients, constant first, are {first} and {second}, hence"
    ),
    "test_separation": "By the separation principle the compensator is",
    "test_where": "where",
    "test_transfer": "Its transfer function from $Y$ to $−U$, equation (4.25), is",
    "test_proper": "It is strictly proper and stable: both coefficients of {polynomial} are positive.",
    "test_plant": "With {plant},",
    "test_both": "so the poles are those of the state feedback and those of the observer, as (4.29) says they must be.",
    "test_defective": (
        "The double pole at {pole} is defective, {defect}, so the transients contain {transient} times an exponential."
    ),
    "test_case": "the feedback gain loses an entry, and",
}


@dataclass(frozen=True)
class HandWritten(Document):
    """A document whose derivations were written by hand instead of by results."""

    written: tuple[Derivation, ...] = ()

    @property
    def derivations(self) -> tuple[Derivation, ...]:
        return self.written


def document(*derivations: Derivation, title: str = "", source: str = "") -> HandWritten:
    return HandWritten(title, source, (), written=derivations)


def target_document() -> HandWritten:
    """The page to aim at."""
    title = "Output feedback of 1/(s(s+1)) with a full-order observer"
    return document(target_derivation(), title=title, source="Example 4.2 of the source")


# -- small builders ---------------------------------------------------------------------------------------------------

s = Scalar.symbol("s")
A, B, C, K, L, x, x_hat, u, y = (Letter(name) for name in ("A", "B", "C", "K", "L", "x", "x_hat", "u", "y"))
ORDER = 2


def values(*rows: Sequence[Scalar | int]) -> Literal:
    return Literal(Matrix.of([list(row) for row in rows]))


def number(value: Scalar | int) -> Literal:
    return Literal(Scalar.of(value))


def alone(value: Scalar | int) -> Evaluated:
    """A value that a sentence only names."""
    return Evaluated(number(value), number(value))


def equals(*members: Formula) -> Relation:
    return Relation(members, ("=",) * (len(members) - 1))


def times(*factors: Formula) -> Product:
    return Product(factors)


def plus(*terms: Formula) -> Sum:
    return Sum(terms)


def minus(formula: Formula) -> Negative:
    return Negative(formula)


def squared(linear: Scalar) -> Power:
    return Power(Literal(linear), 2)


def say(key: str, **slots: Formula | Fact | str) -> Sentence:
    return Sentence(f"test_{key}", tuple(slots.items()))


def _environment() -> Environment:
    known: dict[str, Scalar | Matrix] = {
        "A": Matrix.of([[0, 1], [0, -1]]),
        "B": Matrix.of([[0], [1]]),
        "C": Matrix.of([[1, 0]]),
        "chi": s**2 + s,
        "P": 1 / (s**2 + s),
        "phi_c": (s + 2) ** 2,
        "phi_o": (s + 10) ** 2,
    }
    return Environment(
        values=known, signals={"x": None, "x_hat": None, "u": None}, sizes={"x": ORDER, "x_hat": ORDER, "u": 1}
    )


# -- the page ---------------------------------------------------------------------------------------------------------


def target_derivation() -> Derivation:
    steps = (given(), state_feedback(), observer(), compensator(), closed_loop())
    return Derivation(steps, _environment())


def given() -> Section:
    plant = equals(Derivative(x), plus(times(values((0, 1), (0, -1)), x), times(values((0,), (1,)), u)))
    output = equals(y, times(values((1, 0)), x))
    poles = say("poles", control=pole_list("phi_c", s + 2), observer=pole_list("phi_o", s + 10))
    return Section(Sentence("given"), (Given((plant, output)), Note(poles)))


def pole_list(letter: str, factor: Scalar) -> Roots:
    return Roots(Letter(letter), roots_of(factor**2, "s"))


def state_feedback() -> Section:
    phi = s**2 + 4 * s + 4
    gain = Block(((plus(number(4), minus(number(0))), plus(number(4), minus(number(1)))),))
    closed = plus(times(Letter("s"), Identity(ORDER)), minus(A), times(B, K))
    check = equals(Apply("det", closed), Literal(phi), squared(s + 2))
    return Section(
        say("state_feedback"),
        (
            Define(
                equals(Letter("phi_c"), squared(s + 2), Literal(phi)),
                say("canonical", chi=equals(Letter("chi"), Literal(s**2 + s))),
            ),
            Define(equals(K, gain, values((4, 3))), answer=True),
            Conclude(say("as_required", check=check), (check,), verified=True),
        ),
    )


def observer() -> Section:
    phi = s**2 + 20 * s + 100
    stacked = Block(((C,), (times(C, A),)))
    to_companion = values((1, 1), (1, 0))
    closed = plus(times(Letter("s"), Identity(ORDER)), minus(A), times(L, C))
    check = equals(Apply("det", closed), Literal(phi), squared(s + 10))
    one, zero = number(1), number(0)
    return Section(
        say("observer"),
        (
            Define(equals(Letter("O"), stacked, values((1, 0), (0, 1))), say("full_rank")),
            Equal((Relation((Apply("det", Letter("O")), one, zero), ("=", "!=")),)),
            Define(
                equals(Letter("V"), times(values((1, 0), (0, 1)), to_companion), to_companion),
                say(
                    "dual",
                    dual=equals(Transpose(Letter("O")), Identity(ORDER)),
                ),
            ),
            Define(equals(Letter("V_inv"), values((0, 1), (1, -1)))),
            Equal((equals(Apply("det", Letter("V")), number(-1)),)),
            Define(equals(Letter("phi_o"), squared(s + 10), Literal(phi)), silent=True),
            Define(
                equals(L, Transpose(times(values((100, 19)), values((0, 1), (1, -1)))), values((19,), (81,))),
                say(
                    "differences",
                    phi=equals(Letter("phi_o"), squared(s + 10), Literal(phi)),
                    first=Evaluated(number(100), plus(number(100), minus(number(0)))),
                    second=Evaluated(number(19), plus(number(20), minus(number(1)))),
                ),
                answer=True,
            ),
            Conclude(say("as_required", check=check), (check,), verified=True),
        ),
    )


def compensator() -> Section:
    gains = plus(A, minus(times(B, K)), minus(times(L, C)))
    written = plus(
        values((0, 1), (0, -1)),
        minus(values((0, 0), (4, 3))),
        minus(values((19, 0), (81, 0))),
    )
    pole_polynomial = s**2 + 23 * s + 161
    row, column = values((4, 3)), values((19,), (81,))
    resolvent = Power(values((s + 19, -1), (85, s + 4)), -1)
    adjugate = values((s + 4, 1), (-85, s + 19))
    front = Quotient(number(1), Literal(pole_polynomial))
    transfer = (319 * s + 400) / pole_polynomial
    determinant = Apply("det", plus(times(Letter("s"), Identity(ORDER)), minus(gains)))
    return Section(
        say("compensator"),
        (
            Define(equals(u, minus(times(K, x_hat))), say("separation")),
            Define(equals(Derivative(x_hat), plus(times(gains, x_hat), times(L, y)))),
            Equal((equals(gains, written, values((-19, 1), (-85, -4))),), say("where")),
            Define(
                equals(
                    Letter("F"),
                    times(row, resolvent, column),
                    times(front, row, adjugate, column),
                    times(front, row, values((19 * s + 157,), (81 * s - 76,))),
                    Literal(transfer),
                ),
                say("transfer"),
                answer=True,
            ),
            Conclude(
                say("proper", polynomial=Evaluated(determinant, Literal(pole_polynomial))),
                (Predicate("strictly_proper", Letter("F")), Predicate("stable", Letter("F"))),
            ),
        ),
    )


def closed_loop() -> Section:
    P, F = Letter("P"), Letter("F")
    top, bottom = s**2 + 23 * s + 161, s**4 + 24 * s**3 + 184 * s**2 + 480 * s + 400
    defect = Relation((plus(A, minus(times(B, K)), times(number(2), Identity(ORDER))), values((0, 0), (0, 0))), ("!=",))
    return Section(
        say("closed_loop"),
        (
            Equal(
                (
                    equals(
                        Quotient(P, plus(number(1), times(P, F))),
                        Quotient(Literal(top), Literal(bottom)),
                        Quotient(Literal(top), times(squared(s + 2), squared(s + 10))),
                    ),
                ),
                say("plant", plant=equals(P, Quotient(number(1), times(Letter("s"), Literal(s + 1))))),
                answer=True,
            ),
            Diagram(
                "loop",
                (
                    *((name, Letter(letter)) for name, letter in (("r", "r_in"), ("u", "u"), ("y", "y"))),
                    ("P", Quotient(number(1), times(Letter("s"), Literal(s + 1)))),
                    ("F", Negative(Literal((319 * s + 400) / (s**2 + 23 * s + 161)))),
                    ("response", Literal(top / bottom)),
                ),
            ),
            Conclude(say("both")),
            Note(
                say("defective", pole=alone(-2), defect=defect, transient=alone(Scalar.symbol("t"))),
                (defect,),
                caution=True,
            ),
        ),
    )


def with_a_case() -> Derivation:
    """A plant with a parameter, and what is special where it takes one value."""
    b = Scalar.symbol("b")
    start = Environment(values={"C": Matrix.of([[1, b]])})
    when = equals(Literal(b), number(0))
    special = Equal((equals(C, values((1, 0))),))
    steps = (
        Given((equals(C, values((1, b))),)),
        CaseStep(when, (("b", Scalar.of(0)),), (special,), say("case")),
    )
    return Derivation(steps, start)
