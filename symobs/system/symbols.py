"""The symbols of a problem: names, signs, printed forms, and the caller's SymPy objects."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import field, replace
from typing import TYPE_CHECKING, Any

from symobs.formula.expression import declared_name, typed_name
from symobs.formula.expression.names import NAME
from symobs.formula.expression.source import shown
from symobs.formula.notation import GREEK, symbol_latex
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError
from symobs.system.conditions import SIGNS

if TYPE_CHECKING:
    from symobs.exact import Scalar


@dataclass
class Symbols:
    """The symbols of a problem: names, signs, printed forms, and the caller's SymPy objects.

    `closed` means that only these names exist; otherwise every well-formed name is a real symbol.  A text may have the names
    of `constants` in it: their values take their place when it is read.  The `named` ones are known by a list of names alone.
    """

    signs: Mapping[str, str] = field(default_factory=dict)
    latex: Mapping[str, str] = field(default_factory=dict)
    objects: Mapping[str, Any] = field(default_factory=dict)
    closed: bool = False
    constants: Mapping[str, Scalar] = field(default_factory=dict)
    named: frozenset[str] = frozenset()

    @property
    def names(self) -> Mapping[str, object] | None:
        """The declared names, each with its sign, or for a constant its value; None if every name is admitted."""
        if not self.closed:
            return None
        return {**self.signs, **self.constants} if self.constants else self.signs

    def sign(self, name: str) -> str:
        """Return the sign of a symbol, `real` if undeclared."""
        return self.signs.get(name, "real")

    @staticmethod
    def of(declared: Mapping[Any, Any] | None, where: str = "symbols") -> Symbols:
        """Read `{"omega": "positive", "b": {"sign": "positive", "latex": "b"}}`; None leaves the names open."""
        if declared is None:
            return Symbols()
        signs: dict[str, str] = {}
        latex: dict[str, str] = {}
        objects: dict[str, Any] = {}
        for key, entry in declared.items():
            name = typed_name(key) if isinstance(key, str) else _name_of(key)
            place = f"{where}.{shown(name, 40)}"
            name = declared_name(name, place)
            if name in signs:
                raise _alike(name, place)
            details = entry if isinstance(entry, Mapping) else {"sign": entry}
            unknown = [str(k) for k in details if k not in {"sign", "latex"}]
            if unknown:
                raise InputError(f"unknown key {unknown[0]!r}", where=place, repair="use sign and latex")
            signs[name] = _sign(details.get("sign", "real"), place)
            if not isinstance(key, str):
                objects[name] = key
                _require_parameter(key, name, signs.get(name), place)
            if "latex" in details:
                latex[name] = _latex(details["latex"], f"{place}.latex")
        known = Symbols(signs, latex, objects, closed=True)
        known.refuse_alike(signs, where)
        return known

    def refuse_alike(self, names: Iterable[str], where: str) -> None:
        """Raise `InputError` if two names are printed alike, such as x1 and x_1."""
        printed: dict[str, str] = {}
        for name in sorted(filter(NAME.fullmatch, names)):  # others are generators of our own
            form = re.sub(r"[{}\s]", "", symbol_latex(name, self.latex.get(name)))
            if printed.setdefault(form, name) != name:
                message = f"{printed[form]} and {name} are printed alike"
                raise InputError(message, where=where, repair="give one of them another name, or a latex of its own")

    def with_time(self) -> Symbols:
        """Return these symbols with the time t added."""
        return replace(self, signs={**self.signs, "t": self.sign("t")}) if self.closed else self

    def naming(self, names: object, where: str) -> Symbols:
        """Return these symbols with the names of a list or a text added, real unless declared."""
        listed = re.split(r"[,;\s]+", names.strip(" []")) if isinstance(names, str) else names
        if not self.closed or not isinstance(listed, (list, tuple)):
            return self
        fresh = {
            typed_name(str(name)): "real" for name in listed if str(name) and typed_name(str(name)) not in self.signs
        }
        signs = {**self.signs, **{declared_name(name, where): sign for name, sign in fresh.items()}}
        return replace(self, signs=signs, named=self.named.union(fresh))

    def seen(self, values: object, variable: str = "") -> Symbols:
        """Return these symbols with those of SymPy objects in `values` added, except the variable of polynomials.

        Their assumptions are read as signs.  Raises `InputError` where two of one name are different symbols, and where
        one is no real parameter or cannot have the sign that is declared.
        """
        found = {name: symbol for name, symbol in sympy_symbols(values).items() if name != variable}
        if not found:
            return self
        from symobs.exact.sympy_bridge.conversion import sign_from_assumptions  # noqa: PLC0415 - SymPy only where it came in

        for name, symbol in found.items():
            declared_name(name, "symbols")
            _require_parameter(symbol, name, self.signs.get(name), f"symbols.{name}")
            if self.objects.get(name, symbol) != symbol:
                raise _alike(name, f"symbols.{name}")

        signs = {**{name: sign_from_assumptions(symbol) for name, symbol in found.items()}, **self.signs}
        return replace(self, signs=signs, objects={**found, **self.objects})


def _name_of(symbol: Any) -> str:
    """Return the name of a SymPy symbol, of a Dummy without the underscore of its printed form."""
    return str(getattr(symbol, "name", symbol))


def _alike(name: str, place: str) -> InputError:
    """Return the error for two different SymPy symbols with one printed form."""
    message = f"two different symbols are both called {name}"
    repair = "give each a name of its own, or use one symbol everywhere (symbols with other assumptions are others)"
    return InputError(message, where=place, repair=repair)


def _require_parameter(symbol: Any, name: str, sign: str | None, place: str) -> None:
    """Raise `InputError` if the assumptions of a SymPy symbol contradict a real parameter of this sign."""
    if symbol.is_commutative is False:
        raise InputError(f"{name} does not commute", where=place, repair="parameters are real numbers: declare it anew")
    if symbol.is_real is False:
        raise InputError(f"{name} is not real by its assumptions", where=place, repair="a parameter is a real number")
    if sign is not None and getattr(symbol, f"is_{sign}") is False:
        message = f"{name} is declared {sign}, which the assumptions of the SymPy symbol contradict"
        raise InputError(message, where=place, repair="declare the sign in one place")


#: Signs as relations: omega = "> 0".
_RELATIONS = {">0": "positive", "<0": "negative", "!=0": "nonzero", "≠0": "nonzero"}
_RELATIONS |= {">=0": "nonnegative", "≥0": "nonnegative", "<=0": "nonpositive", "≤0": "nonpositive"}


def _sign(entry: object, place: str) -> str:
    entry = _RELATIONS.get(entry.replace(" ", ""), entry) if isinstance(entry, str) else entry
    if entry not in SIGNS:
        sign, repair = place.rpartition(".")[2], f"write one of {', '.join(SIGNS)}"
        if sign in SIGNS and isinstance(entry, list) and 0 < len(entry) <= _FEW:
            repair = "write " + ", ".join(f'{str(name)[:20]} = "{sign}"' for name in entry)
        raise InputError(f"{str(entry)[:40]!r} is not a sign", where=place, repair=repair)
    return str(entry)


_LATEX_LIMIT = 40

#: Names that a repair repeats.
_FEW = 8


def _latex(entry: object, place: str) -> str:
    """Return a declared LaTeX form; only letters, digits, sub- and superscripts and named letters are admitted."""
    allowed = isinstance(entry, str) and 0 < len(entry) <= _LATEX_LIMIT and _is_plain_latex(entry)
    if not allowed:
        message = f"{str(entry)[:40]!r} is not a printed form of a symbol"
        repair = "write letters and digits with ^, _, braces, or a named letter such as \\omega_0"
        raise InputError(message, where=place, repair=repair)
    return str(entry)


_NAMED = rf"\\(?:{'|'.join(sorted({*GREEK, 'varepsilon', 'vartheta', 'varphi', 'ell'}))})(?![A-Za-z])"
_GROUP = "\N{BULLET}"
_LETTER = rf"(?:[A-Za-z0-9]|{_NAMED}|{_GROUP})"
_ACCENTED = rf"\\(?:bar|tilde|dot|hat|mathrm|mathit)(?![A-Za-z]) ?{_LETTER}"
_BELOW, _ABOVE = rf"_ ?{_LETTER}", rf"\^ ?{_LETTER}"
_SCRIPTS = rf"(?:'{{1,3}}|{_BELOW}(?:{_ABOVE}|'{{1,3}})?|{_ABOVE}(?:{_BELOW})?)?"
_FORM = rf"(?:(?:{_ACCENTED}|{_LETTER}){_SCRIPTS}|[ ,])+"
_INNERMOST = re.compile(rf"\{{{_FORM}\}}")


def _is_plain_latex(text: str) -> bool:
    """Return whether a LaTeX form is safe: named commands, balanced groups, no double script, no `^^` code."""
    if _GROUP in text or text != text.strip() or not re.search("[A-Za-z]", text):
        return False
    shorter = _INNERMOST.sub(_GROUP, text)
    while shorter != text:
        text, shorter = shorter, _INNERMOST.sub(_GROUP, shorter)
    return re.fullmatch(_FORM, text) is not None


def sympy_symbols(values: object) -> dict[str, Any]:
    """Return the free SymPy symbols in a value, or in lists or arrays of values, by name.

    Raises `InputError` where two different ones have one name.
    """
    found: dict[str, Any] = {}
    for symbol in _symbols_in(values) if "sympy" in sys.modules else ():
        name = _name_of(symbol)
        if found.setdefault(name, symbol) != symbol:
            raise _alike(name, f"symbols.{shown(name, 40)}")
    return found


def _symbols_in(values: object) -> Iterator[Any]:
    if is_sympy(values):
        yield from sorted(getattr(values, "free_symbols", ()), key=str)
    elif isinstance(values, (list, tuple, Mapping)):
        for value in values.values() if isinstance(values, Mapping) else values:
            yield from _symbols_in(value)
    elif getattr(getattr(values, "dtype", None), "kind", "") == "O":
        yield from _symbols_in(values.tolist())  # type: ignore[attr-defined]  # an array of objects has it


def is_sympy(value: object) -> bool:
    """Return whether a value is a SymPy object, without importing SymPy."""
    # an undefined function of SymPy makes a class that says of no module
    return "sympy" in sys.modules and (type(value).__module__ or "sympy").startswith("sympy")
