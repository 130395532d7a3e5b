"""Which relations and facts the words of a sentence accept: each test fails where one of the demands is weaker."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar, roots_of
from symobs.exact.core.generators import function
from symobs.formula.tree import Apply, Environment, Letter, Literal, Power, Predicate, Product, Relation, Roots, Sum
from symobs.proof.derivation.sentence_context import SentenceContext
from symobs.proof.derivation.wording_check import meets_obligations as rests_on

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.formula.tree import Fact, Formula


def meets_obligations(key: str, facts: Sequence[Fact], here: Environment) -> bool:
    return rests_on(key, SentenceContext(facts, here))


E = Environment(
    values={
        "sigma_d": Scalar.of(2),
        "omega_d": Scalar.of(Fraction(52, 25)),
        "T_s": Scalar.of(3),
        "O": Matrix.of([[Scalar.of(entry) for entry in row] for row in ([1, 0], [0, 1], [1, 1])]),
        "Ctr": Matrix.of([[Scalar.of(entry) for entry in row] for row in ([1, 2, 0], [2, 4, 0])]),
    }
)


def compared(first: Scalar | str, *rest: object) -> Relation:
    """Return a relation of a number, or of the rank of a letter, with what follows."""
    start = Apply("rank", Letter(first)) if isinstance(first, str) else Literal(first)
    return Relation((start, *(Literal(Scalar.of(part)) for part in rest[1::2])), rest[::2])  # type: ignore[arg-type]


FULL = compared("O", "=", 2)
LOW = compared("Ctr", "=", 1)


def test_a_pole_is_defective_where_it_has_fewer_eigenvectors_than_places() -> None:
    s = Scalar.symbol("s")
    chain = Matrix.of([[0, 1, 0], [0, 0, 0], [0, 0, -1]])  # -2, -2 in one chain and -3, each moved by 2
    apart = Matrix.of([[0, 0, 0], [0, 0, 0], [0, 0, -1]])
    values: dict[str, Scalar | Matrix] = {"phi_c": (s + 2) * (s + 2) * (s + 3), "M": chain, "N": apart, "O": chain * 2}
    here = Environment(values=values)

    def held(letter: str, pole: Scalar, *more: Relation) -> bool:
        return defective([compared(letter, "=", 2), *more, Roots(Literal(pole), roots_of(pole, "s"))])

    def defective(facts: list[Fact], known: Environment = here, **other: Scalar) -> bool:
        mode = function("exp", -2 * t)
        slots = {"mode": mode, "times": t * mode, **other}
        return rests_on(
            "defective", SentenceContext(facts, known, {name: Literal(value) for name, value in slots.items()})
        )

    t = Scalar.symbol("t")
    assert held("M", s + 2)
    assert not held("N", s + 2)  # two eigenvectors
    assert not held("O", s + 2)  # another matrix
    assert not held("M", s + 3)  # another pole
    assert not held("M", (s + 2) * (s + 3))  # which of them?
    assert not held("M", s + 2, compared("N", "=", 1))  # rank of which?
    poles = Roots(Literal(s + 2), roots_of(s + 2, "s"))
    assert not defective([poles])
    assert not defective([compared("M", "=", 2)])
    assert not defective([compared("M", "=", 2), poles], Environment(values={"M": chain}))
    assert not defective([compared(Scalar.of(1), "=", 1), poles])
    assert not defective([compared("M", "=", 2), poles], mode=function("exp", -3 * t))
    assert not defective([compared("M", "=", 2), poles], times=t * t * function("exp", -2 * t))


def test_a_pair_has_the_damping_ratio_and_the_frequency_told() -> None:
    two, ratio, frequency = (Literal(Scalar.of(Fraction(number))) for number in ("2", "4/5", "3"))
    s, phi = Letter("s"), Letter("phi_c")
    pair = Sum((Power(s, 2), Product((two, ratio, frequency, s)), Power(frequency, 2)))

    def told(damping: Formula, speed: Formula, said: Formula) -> bool:
        slots = {"damping": damping, "frequency": speed, "pair": Relation((phi, said), ("=",))}
        return rests_on("pattern_damping", SentenceContext([], E, slots))

    assert told(ratio, frequency, pair)
    assert told(ratio, frequency, Product((pair, Sum((s, two)))))
    assert not told(frequency, ratio, pair)
    assert not told(ratio, two, pair)
    assert not told(ratio, frequency, phi)


def test_shared_roots_are_roots_of_both_polynomials() -> None:
    s = Scalar.symbol("s")
    here = Environment(values={"A": Matrix.of([[-1, 0], [0, -2]]), "phi_o": (s + 1) * (s + 3)})

    def shared(polynomial: Scalar) -> bool:
        return meets_obligations("spectra_meet_observer", [Roots(Literal(polynomial), roots_of(polynomial, "s"))], here)

    assert shared(s + 1)
    assert not any(map(shared, (s + 2, s + 3, (s + 1) ** 2)))


def test_a_loop_is_stable_where_both_its_polynomials_are() -> None:
    s = Scalar.symbol("s")
    here = Environment(values={"phi_c": s + 2, "phi_o": s + 10, "F": 1 / (s - 1)})
    whole = Product((Letter("phi_c"), Letter("phi_o")))
    for key in ("compensator_unstable_alone", "compensator_unstable_low_alone", "minimal_unstable_alone"):
        own = Predicate("unstable", Letter("F"))
        assert meets_obligations(key, [own, Predicate("stable", whole)], here)
        assert not meets_obligations(key, [Predicate("unstable", whole), Predicate("stable", whole)], here)
        for fact in (
            Predicate("stable", Letter("phi_c")),
            Predicate("stable", Letter("phi_o")),
            Predicate("unstable", whole),
            Predicate("stable", Product((Letter("phi_c"), Letter("phi_c")))),
        ):
            assert not meets_obligations(key, [own, fact], here)
        assert not meets_obligations(key, [], here)
        assert not meets_obligations(key, [compared("O", "=", 1)], here)
        assert not meets_obligations(key, [Predicate("stable", Letter("phi_c"))], Environment(values={"phi_c": s + 2}))
        assert not meets_obligations(key, [Predicate("stable", Letter("phi_o"))], Environment(values={"phi_o": s + 2}))


def test_a_zero_is_named_only_beside_a_full_rank() -> None:
    here = E.extended_by(values={"w_0": Matrix.row([0, 1]), "G_0": Matrix.of([[1], [0]])})
    assert meets_obligations("no_feedforward_zero", [FULL], here)
    for facts in ([LOW], []):
        assert not meets_obligations("no_feedforward_zero", facts, here)
    for name, value in (("w_0", [0, 0]), ("w_0", [1, 0])):
        assert not meets_obligations("no_feedforward_zero", [FULL], here.extended_by(values={name: Matrix.row(value)}))
