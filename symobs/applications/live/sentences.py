"""The answer in a sentence: *Observable*, *Closed loop unstable: pole at 5*, *Gramian found*."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.exact.algebraic.polynomial_roots import Factored, factored, roots_of
from symobs.ground.dataclass import dataclass
from symobs.stability.criteria.stability import on_boundary, stability
from symobs.tasks.analysis.modes.modes import stable_modes

if TYPE_CHECKING:
    from symobs.exact import Root
    from symobs.pages.cards import CardPrinter
    from symobs.tasks.result import Result

#: What a verdict is about, where it is a property of the plant.
_PROPERTIES = {
    "observability": "observable",
    "time_varying_observability": "observable",
    "initial_state_covariance": "observable",
    "controllability": "controllable",
    "detectability": "detectable",
    "stabilizability": "stabilizable",
}
#: Answers whose negative is a fact of its own.
_NEGATIVES = {
    "initial_state": "no_initial_state",
    "lyapunov": "not_stable",
    "minimum_energy_input": "not_reachable",
    "stability_region": "nowhere_stable",
}
#: Tasks about the plant itself, whose polynomial is that of A.
_OF_A = {"characteristic_polynomial", "lyapunov"}
#: Tasks whose negative is that something is not stable.
_ABOUT_STABILITY = {"lyapunov", "margins", "stability_region"}


def sentence(result: Result, stable: Stability, printer: CardPrinter) -> str:
    """Return the answer in a sentence, without a full stop."""
    said = printer.language.phrases
    if result.verdict == "undecided":
        return said["said_undecided"]
    about, verdict = _property(result), result.verdict
    is_no = verdict == "no"
    if about and (is_no or result.task != "initial_state_covariance"):
        fact = said[f"said_{'not_' * is_no}{about}"]
        if result.fields.get("meaning") == "lyapunov":
            fact = said["said_lyapunov"].format(fact=fact)
    elif result.task == "margins" and not is_no:
        names = ("gain_down", "gain_up", "phase_deg")
        down, up, phase = (printer.language.decimal(str(result.fields[name])).replace("oo", "∞") for name in names)
        phase = phase if phase == "∞" else f"≈ {phase}°"
        fact = said["said_margins"].format(gain_down=down, gain_up=up, phase=phase)
    elif stable.known and (not is_no or result.task in _ABOUT_STABILITY):
        fact = stable.told(printer)
    elif result.task == "stability_region" and not is_no:
        return said["said_stable_where" if verdict == "conditional" else "said_stable"]
    elif is_no and result.task in _NEGATIVES:
        fact = said[f"said_{_NEGATIVES[result.task]}"]
    else:
        task = said.get(f"live_task_{result.task}", result.task.replace("_", " "))
        fact = (
            said["said_none"].format(task=task)
            if is_no
            else said["said_found"].format(task=task[:1].upper() + task[1:])
        )
    return said["said_conditional"].format(fact=fact) if verdict == "conditional" else fact


def _property(result: Result) -> str:
    if result.task == "pbh":
        return _PROPERTIES[result.fields["of"]]
    return _PROPERTIES.get(result.task, "")


@dataclass
class Stability:
    """Whether the roots of a polynomial are stable, of a loop, an error or A; `poles` are those that are not."""

    of: str
    known: bool
    poles: tuple[Root, ...] = ()
    grows: bool = False

    def told(self, printer: CardPrinter) -> str:
        """Return it in a sentence."""
        said = printer.language.phrases
        if not self.poles:
            return said[f"said_{self.of}stable"]
        fact = said[f"said_{self.of}{'unstable' if self.grows else 'not_stable'}"]
        if not all(pole.is_closed for pole in self.poles):  # their polynomial has stable roots, too
            return fact
        poles = said["said_at_pole" if len(self.poles) == 1 else "said_at_poles"]
        return poles.format(fact=fact, poles=printer.roots(self.poles))


def stability_of(result: Result) -> Stability:
    """Return whether a design's loop or error is stable, or the plant where that is asked; not known with parameters."""
    plant, fields = result.plant, result.fields
    variable, discrete, signs = plant.variable, plant.is_discrete, plant.symbols.signs
    is_loop = "K" in result.gains or result.task == "margins"
    of = "loop_" if is_loop else "error_" if result.gains else ""
    if result.gains or result.task == "margins":
        found = fields.get("closed_loop_polynomial") or fields.get("polynomial")
    elif result.task in _OF_A:
        found = plant.matrices.A.characteristic_polynomial(variable)
    else:
        found = fields.get("polynomial") if result.task == "stability_region" and not fields["parameters"] else None
    factors = found if isinstance(found, Factored) else factored(found, variable) if isinstance(found, Scalar) else None
    if factors is None:
        return Stability(of, known=False)
    outside, grows = [], False
    for factor, _ in factors.factors:
        if factor.names - {variable}:
            if stability(factor, variable, signs, discrete=discrete).verdict != "yes":
                return Stability(of, known=False)
            continue
        roots = roots_of(factor, variable)
        stable = stable_modes(roots, {}, discrete=discrete)
        beyond = [root for root, is_stable in zip(roots, stable, strict=True) if is_stable is False]
        grows |= bool(beyond) and not on_boundary(factor, variable, {}, discrete=discrete)
        outside += beyond
    return Stability(of, known=True, poles=tuple(outside), grows=grows)
