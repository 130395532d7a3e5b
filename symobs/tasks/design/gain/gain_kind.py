"""Kinds of gains: given, assigned, small, decoupled, with zeros, algebraic, or nonexistent."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, TypeAlias

from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from symobs.exact import Matrix
    from symobs.system.specification import DesiredPolynomial
    from symobs.tasks.design.pole_placement.zero_pattern import RootGain

#: Entries of a gain: (row, column), from 0.
Places: TypeAlias = tuple[tuple[int, int], ...]


@dataclass
class GivenGain:
    """A gain that was given: its polynomial is found, and nothing is asked of it."""

    desired: ClassVar[None] = None
    zero: ClassVar[Places] = ()
    exists: ClassVar[bool] = True


@dataclass
class AssignedGain:
    """A gain that assigns φ."""

    desired: DesiredPolynomial

    zero: ClassVar[Places] = ()
    exists: ClassVar[bool] = True


@dataclass
class SmallGain:
    """A gain that assigns φ near the best conditioned placement, and the simple one L in whose place it was taken.

    `vectors` are Ψ, f = LᵀΨ and J with (A − L C)ᵀ Ψ = Ψ J where it was found by them.  All are of the observer problem.
    """

    desired: DesiredPolynomial
    simple: Matrix
    vectors: tuple[Matrix, Matrix, Matrix] | None = None

    zero: ClassVar[Places] = ()
    exists: ClassVar[bool] = True


@dataclass
class DecoupledGain:
    """The member of the family of gains whose output errors (whose inputs' parts) are decoupled."""

    desired: DesiredPolynomial

    zero: ClassVar[Places] = ()
    exists: ClassVar[bool] = True


@dataclass
class GainWithZeros:
    """A gain that assigns φ and has zeros in given places."""

    desired: DesiredPolynomial
    zero: Places

    exists: ClassVar[bool] = True


@dataclass
class AlgebraicGain:
    """A gain with zeros in given places whose entries no square roots write: it stands beside the answer None."""

    desired: DesiredPolynomial
    zero: Places
    found: RootGain

    exists: ClassVar[bool] = False


@dataclass
class NoGainWithZeros:
    """φ can be assigned, but no gain was found that has zeros in these places, or there is none."""

    desired: DesiredPolynomial
    zero: Places

    exists: ClassVar[bool] = False


@dataclass
class UnassignableGain:
    """No gain assigns φ, with zeros in these places or without: a fixed mode is not among its roots."""

    desired: DesiredPolynomial
    zero: Places = ()

    exists: ClassVar[bool] = False


#: What can become of the wish for a polynomial.
AskedGain: TypeAlias = (
    AssignedGain | SmallGain | DecoupledGain | GainWithZeros | AlgebraicGain | NoGainWithZeros | UnassignableGain
)
GainKind: TypeAlias = GivenGain | AskedGain
