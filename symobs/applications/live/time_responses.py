"""Time responses as whole numbers over `parts`: each height is within 1/parts of the truth."""

from __future__ import annotations

from contextlib import suppress
from decimal import Decimal
from fractions import Fraction
from math import ceil, exp, isqrt, log, log10, pi
from operator import mul, sub
from typing import TYPE_CHECKING, Any

from symobs.applications.live.request import FieldError
from symobs.exact import Matrix
from symobs.exact.algebraic.enclosure import is_number
from symobs.ground.errors import InputError
from symobs.system import Symbols, read_matrix
from symobs.tasks.analysis.time_response.courses import rounded_up

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.applications.live.request import Responses
    from symobs.exact import Scalar
    from symobs.tasks.result import Result

#: States are enclosed in these parts; a response is rounded from them to coarser ones.
_FINE = 10**15
#: The slowest mode has fallen to e⁻⁶ at the end; one that grows has grown to e³.
_TIMES, _GROWN, _LONGER = 6.0, 3.0, Fraction(3, 2)
_LONGEST = Fraction(10**6)
#: Thousandths of the height of the picture, or finer.
_COARSE, _FINEST = 3, 9
_DEAD, _SAMPLES = 1e-9, 40
#: A segment is halved where a response may be further from its middle than this part of the height of the picture; so many
#: segments are drawn at most, one for each point of a screen.
_BETWEEN, _MOST_SEGMENTS = Fraction(1, 110), 512
#: What stays below this part of the peak has settled; nothing is read off a response whose second difference is a larger one.
_SETTLED, _COARSEST = Fraction(1, 50), Fraction(1, 3)
#: A mode that overshoots by less is not seen to.
_LEAST_PERCENT = 0.01
#: What is larger cannot be drawn beside numbers of usual size.
_LARGEST = 10**12
#: Why there is no response, as phrases.
_NEEDS_NUMBERS, _TOO_WIDE, _TOO_LARGE = "said_needs_numbers", "said_too_wide", "said_too_large"
_TOO_FAST = "said_too_fast"
#: The fastest mode turns by no more than this between two instants, in radians.
_TURN = 2.0


class NoResponse(Exception):
    """There is none, for a reason worth saying; its text is a phrase, or empty."""


class Signals:
    """A linear equation with its initial state, and the signals drawn: name, component, row of the state, dashed."""

    def __init__(
        self,
        loop: Matrix,
        start: Sequence[Fraction | Scalar],
        drawn: list[tuple[str, Matrix, bool]],
        driven: Matrix | None = None,
        *,
        discrete: bool,
    ) -> None:
        """Take the signals apart into rows; a reference that enters by `driven` and stays 1 is the last state."""
        from symobs.exact.time_functions.matrix_exponential import eigenvalues_near, fraction_near, fractions_near  # noqa: PLC0415 - FLINT

        order = self.order = loop.shape[0]
        self.matrix, self.start, self.modes = loop, start, eigenvalues_near(loop)
        self.converges = max(map(abs, self.modes)) < 1 if discrete else max(mode.real for mode in self.modes) < 0
        if driven is not None:
            held = Matrix.identity(1) if discrete else Matrix.zeros(1, 1)
            self.matrix = Matrix.block([[loop, driven], [Matrix.zeros(1, order), held]])
            self.start = [Fraction(0)] * order + [Fraction(1)]
        self.rows = [
            (name, place if table.shape[0] > 1 else 0, row, dashed)
            for name, table, dashed in drawn
            if not table.names
            or all(map(is_number, table.entries))  # a gain may have parameters where the loop has none
            for place, row in enumerate(fractions_near(table), 1)
        ]
        self.finals: list[int | None] = [0 if driven is None else None] * len(self.rows)
        self.ends: list[str] = []
        self.follows = False
        if driven is not None and self.converges:
            rest = (Matrix.identity(order) - loop if discrete else -loop).solve(driven)
            state = [*map(fraction_near, rest.entries), Fraction(1)]
            self.finals = [round(sum(map(mul, row, state), Fraction(0)) * _FINE) for _, _, row, _ in self.rows]
            (outputs,) = (table for name, table, _ in drawn if name == "y")
            ends = (outputs @ Matrix.block([[rest], [Matrix.identity(1)]])).entries
            self.ends = [_digits(fraction_near(end), 3) for end in ends]
            self.follows = all((end - 1).is_zero for end in ends)


def responses_of(result: Result, asked: Responses) -> dict[str, Any]:
    """Return the responses of a design, those of the input apart; raises `NoResponse` or, for what was asked, `InputError`.

    Where modes beside the slowest one add up, so that a response that converges has not settled by the usual end, it is
    drawn for half as long again, or longer.
    """
    signals, discrete = _signals(result, asked), result.plant.is_discrete
    end = _end(signals, asked.end, discrete=discrete)
    found = _drawn(signals, end, asked, discrete=discrete)
    lines = found["lines"] + found.get("effort", {}).get("lines", [])
    is_open = any(line.get("peak", "0") != "0" and "settles" not in line for line in lines)
    if asked.end is None and is_open and signals.converges:
        later = Fraction(min(ceil(end * _LONGER), _SAMPLES)) if discrete else rounded_up(float(end * _LONGER))
        if end < later <= _LONGEST:
            with suppress(NoResponse):  # fast beside it
                found = _drawn(signals, later, asked, discrete=discrete)
    return found


def _drawn(signals: Signals, end: Fraction, asked: Responses, *, discrete: bool) -> dict[str, Any]:
    """Return the responses up to an instant."""
    if discrete:
        last = int(end)
        values = _stepped(signals, 2 * last + 1)
        every, seen, behind = 1, [line[: last + 1] for line in values], [line[last:] for line in values]
    else:
        every, seen, behind = _enclosed(signals, end, asked)
    told = [
        (name, place, dashed, line[::every], _read_off(line, after, end, final, is_continuous=not discrete))
        for (name, place, _, dashed), line, after, final in zip(signals.rows, seen, behind, signals.finals, strict=True)
    ]
    head: dict[str, Any] = {"end": str(end), "discrete": discrete, "step": asked.step}
    if asked.step:
        head |= {"ends": signals.ends, "follows": signals.follows}
    effort = [each for each in told if each[0] == "u"]
    found = head | _picture([each for each in told if each[0] != "u"], end, reference=asked.step)
    return found | ({"effort": head | _picture(effort, end)} if effort else {})


def _picture(told: list[Any], end: Fraction, *, reference: bool = False) -> dict[str, Any]:
    """Return lines with a window around them, and around a reference of 1."""
    peak = max(_largest(heights) for _, _, _, heights, _ in told)
    if peak > _LARGEST * _FINE:
        raise NoResponse(_TOO_LARGE)
    digits = _COARSE if not peak else min(_FINEST, max(_COARSE, _COARSE - int(log10(peak / _FINE))))
    parts = 10**digits
    coarser = _FINE // parts
    half = coarser // 2
    lines = [
        {
            "signal": name,
            "component": place,
            "dashed": dashed,
            "heights": [(v + half) // coarser for v in heights],
            **read,
        }
        for name, place, dashed, heights, read in told
    ]
    low, high = min(min(line["heights"]) for line in lines), max(max(line["heights"]) for line in lines)
    high = max(high, parts) if reference else high
    room = Fraction(max(high - low, 1), 20)
    window = [["0", str(end)], [_decimal((low - room) / parts), _decimal((high + room) / parts)]]
    return {"parts": parts, "window": window, "lines": lines}


# -- which ------------------------------------------------------------------------------------------------------------


def _signals(result: Result, asked: Responses) -> Signals:
    """Return what is drawn of a design."""
    fields, order, is_discrete = result.fields, result.plant.order, result.plant.is_discrete
    loop = fields.get({"observer": "A", "reduced_order_observer": "F"}.get(result.task, "closed_loop_matrix"))
    if loop is None or "responses" not in result.panels:
        raise NoResponse
    if (loop.names and not all(map(is_number, loop.entries))) or result.plant.relations:
        raise NoResponse(_NEEDS_NUMBERS)
    if asked.step:
        return Signals(loop, [], *_of_a_step(result, loop.shape[0]), discrete=is_discrete)
    state = _vector(asked.start, order, Fraction(1), "courses.start")
    estimate = _vector(asked.estimate, order, Fraction(0), "courses.estimate")
    error = [a - b for a, b in zip(state, estimate, strict=True)]
    size = loop.shape[0]
    match result.task:
        case "observer":
            return Signals(loop, error, [("e", Matrix.identity(order), False)], discrete=is_discrete)
        case "reduced_order_observer":
            drawn = [("e_2", Matrix.identity(size), False)]
            return Signals(loop, _below(fields["T"], error, size), drawn, discrete=is_discrete)
        case "state_feedback":
            x = Matrix.identity(order)
            return Signals(loop, state, [("x", x, False), _input(fields["K"] @ x)], discrete=is_discrete)
        case "integral_action":
            x = Matrix.identity(size).select(range(order), range(size))
            gains = Matrix.block([[fields["K"], -fields["k_I"]]])
            start = [*state, *[Fraction(0)] * (size - order)]
            return Signals(loop, start, [("x", x, False), _input(gains)], discrete=is_discrete)
    unseen, hidden = _unseen(result, order, size - order)
    start = [*state, *([] if not hidden else error if unseen is None else _below(unseen, error, hidden))]
    x, x_hat = _state_and_estimate(order, unseen, hidden)
    drawn = [("x", x, False)] + ([("x_hat", x_hat, True)] if hidden else [])
    return Signals(loop, start, [*drawn, _input(fields["K"] @ x_hat)], discrete=is_discrete)


def _input(gain: Matrix) -> tuple[str, Matrix, bool]:
    """Return u = −K x̂ as a signal."""
    return "u", -gain, False


def has_step(result: Result) -> bool:
    """Return whether a design has a response to a step of its reference."""
    size = getattr(result.fields.get("closed_loop_matrix"), "shape", (0,))[0]
    is_full = result.task == "compensator" and size == 2 * result.plant.order and result.plant.matrices.D.is_zero
    return size > 0 and (is_full or result.task in {"feedforward", "integral_action"})


def _of_a_step(result: Result, size: int) -> tuple[list[tuple[str, Matrix, bool]], Matrix]:
    """Return output and input after a step of every component of the reference, and how the reference enters the loop.

    It enters as F w beside −K x̂, as the integrated error r − y, or, in unity feedback, by y − r into the observer.
    """
    if not has_step(result):
        raise NoResponse
    fields, m, order = result.fields, result.plant.matrices, result.plant.order
    K, ones = fields["K"], Matrix.column([1] * result.plant.outputs)
    pick = Matrix.identity(size).select(range(order), range(size))
    if result.task == "integral_action":
        below = Matrix.identity(size).select(range(order, size), range(size))
        driven = Matrix.block([[Matrix.zeros(order, 1)], [ones]])
        law = Matrix.block([[fields["k_I"] @ below - K @ pick, Matrix.zeros(K.shape[0], 1)]])
    else:
        unseen, hidden = _unseen(result, order, size - order)
        _, x_hat = _state_and_estimate(order, unseen, hidden)
        gain = fields["F"] if isinstance(fields["F"], Matrix) else Matrix.of([[fields["F"]]])
        through = gain @ ones if result.task == "feedforward" else Matrix.zeros(K.shape[0], 1)
        law = Matrix.block([[Matrix.zeros(K.shape[0], size) - K @ x_hat, through]])
        entering = [m.B @ through, *([Matrix.zeros(hidden, 1)] if hidden else [])]
        if result.task == "compensator":
            entering = [Matrix.zeros(order, 1), fields["L"] @ ones]
        driven = Matrix.block([[part] for part in entering])
    y = Matrix.block([[m.C @ pick, Matrix.zeros(m.C.shape[0], 1)]])
    if m.has_feedthrough:
        y = y + m.D @ law
    return [("y", y, False), ("u", law, False)], driven


def _unseen(result: Any, order: int, size: int) -> tuple[Matrix | None, int]:
    """Return T of an observer of reduced order, None for one of full order, and the size of the error."""
    T = (result.loop if result.task == "feedforward" else result).fields.get("T")
    return (T if 0 < size < order else None), size


def _state_and_estimate(order: int, T: Matrix | None, size: int) -> tuple[Matrix, Matrix]:
    """Return x and x̂ = x − e, or x̂ = x − T⁻¹ [0; e₂]."""
    whole = Matrix.identity(order) if T is None else T.inverse().select(range(order), range(order - size, order))
    plain = Matrix.block([[Matrix.identity(order), Matrix.zeros(order, size)]])
    return plain, plain if not size else Matrix.block([[Matrix.identity(order), -whole]])


def _below(T: Matrix, error: list[Fraction], size: int) -> list[Scalar]:
    """Return the last components of T e."""
    if not all(map(is_number, T.entries)):
        raise NoResponse(_NEEDS_NUMBERS)
    return list((T @ Matrix.column(error)).entries)[-size:]


def _vector(text: str, size: int, otherwise: Fraction, where: str) -> list[Fraction]:
    """Return an initial state: numbers with commas between, or the same for every component."""
    if not text.strip():
        return [otherwise] * size
    entries = read_matrix(f"[{text.strip().strip('[]')}]", Symbols.of({}), where).entries
    if len(entries) != size or any(not entry.is_constant or entry.names for entry in entries):
        raise FieldError("said_no_state", where, count=size)
    return [entry.fraction() for entry in entries]


# -- when -------------------------------------------------------------------------------------------------------------


def _end(signals: Signals, asked: str | None, *, discrete: bool) -> Fraction:
    """Return the last instant: as it was asked for, or where the slowest mode has converged."""
    if asked is not None:
        (value,) = _vector(asked, 1, Fraction(1), "courses.end")
        if not 0 < value <= _LONGEST or (discrete and (value.denominator != 1 or value > 1000)):
            raise InputError("no such last instant", where="courses.end", repair='write a positive number: "3"')
        return value
    if discrete:
        radius, order = max(map(abs, signals.modes)), signals.order
        usual = order + 2 if radius < _DEAD else ceil(_TIMES / -log(radius)) if radius < 1 else _SAMPLES
        return Fraction(max(6, min(usual, _SAMPLES)))
    parts = [mode.real for mode in signals.modes]
    largest, smallest = max(parts), min(parts)
    if largest > 0:
        return rounded_up(_GROWN / largest)
    slowest = -largest if largest < 0 else max(-smallest, 0.0) / 4
    return min(rounded_up(_TIMES / slowest), _LONGEST) if slowest > 0 else Fraction(10)


# -- how --------------------------------------------------------------------------------------------------------------


def _enclosed(signals: Signals, end: Fraction, asked: Responses) -> tuple[int, list[list[int]], list[list[int]]]:
    """Return the heights of every signal in fine parts, within a quarter of the finest ones that are shown.

    There are as many as were asked for, and as many again up to twice the end.  Where they are to be fine there are twice as
    many or more: segments are halved where a response changes fast, and heights stand closer where it could not be read off.
    The first number tells how many heights there are to a segment.
    """
    segments, fastest = asked.count - 1, max(map(abs, signals.modes)) * float(end)
    while 2 * segments <= _MOST_SEGMENTS and fastest > _TURN * segments:
        segments *= 2
    if fastest > _TURN * segments:  # a mode might turn unseen between two instants
        raise NoResponse(_TOO_FAST)
    instants = 2 * segments if asked.fine else segments
    lines = _at_instants(signals, end / instants, 2 * instants + 1)
    seen, after = [line[: instants + 1] for line in lines], [line[instants:] for line in lines]
    if asked.fine:
        height, bend = max(map(max, seen)) - min(map(min, seen)), 4 * max(map(_bend, seen))
        while 2 * segments <= _MOST_SEGMENTS and bend > 8 * _BETWEEN * height:
            segments, bend = 2 * segments, bend // 4
        while instants < segments or (instants < 2 * _MOST_SEGMENTS and any(map(_is_coarse, seen))):
            instants *= 2
            seen = _at_instants(signals, end / instants, instants + 1)
    return instants // segments, seen, after


def _bend(line: Sequence[int]) -> int:
    """Return the largest modulus of the second differences."""
    slopes = list(map(sub, line[1:], line))
    return _largest(list(map(sub, slopes[1:], slopes)))


def _is_coarse(line: Sequence[int]) -> bool:
    """Return whether nothing is read off a line, whose second differences are large beside its values."""
    return _bend(line) > _COARSEST * _largest(line)


def _largest(line: Sequence[int]) -> int:
    """Return the largest modulus."""
    return max(max(line), -min(line))  # noqa: PLW3301 - the other form copies the line


def _at_instants(signals: Signals, step: Fraction, count: int) -> list[list[int]]:
    """Return the heights of every signal in fine parts."""
    from symobs.exact.time_functions.matrix_exponential import state_response  # noqa: PLC0415 - FLINT

    try:
        return state_response(signals.matrix, signals.start, step, count, _FINE, [row for _, _, row, _ in signals.rows])
    except ArithmeticError:
        raise NoResponse(_TOO_WIDE) from None


def _stepped(signals: Signals, count: int) -> list[list[int]]:
    """Return the values at 0, 1, 2, … in fine parts, rounded from exact ones."""
    from symobs.exact.time_functions.matrix_exponential import fraction_near  # noqa: PLC0415 - FLINT

    state, states = Matrix.column(list(signals.start)), []
    for _ in range(count):
        states.append([fraction_near(entry) for entry in state.entries])
        state = signals.matrix @ state
    return [
        [round(sum(map(mul, row, state), Fraction(0)) * _FINE) for state in states] for _, _, row, _ in signals.rows
    ]


def _decimal(value: Fraction) -> str:
    return f"{float(value):.6g}"


# -- readouts ---------------------------------------------------------------------------------------------------------


def _read_off(
    line: Sequence[int], after: Sequence[int], end: Fraction, final: int | None, *, is_continuous: bool
) -> dict[str, str]:
    """Return the peak and the last value up to the end, and when the response settles, if that is before the end.

    It has settled from an instant on if its distance from the final value stays below a fiftieth of the largest one up to
    twice the end, between the instants too if time is continuous.  Where a response by itself is drawn too coarsely to see
    that, nothing is read off.
    """
    last = len(line) - 1
    peak = _peak(line, is_continuous=is_continuous)
    if peak is None:
        return {}
    found = {"peak": _digits(peak / _FINE, 3), "last": _digits(Fraction(line[last], _FINE), 2)}
    if final is None:
        return found
    distance = [value - final for value in line] if final else line
    largest = _peak(distance, is_continuous=is_continuous) if final else peak
    if largest is None:
        return found
    if final and peak / final > 0:
        percent = 100 * (peak / final - 1)
        found["overshoot"] = _digits(Fraction(percent), 3) if percent >= _LEAST_PERCENT else "0"
    band = int(_SETTLED * abs(largest)) - 1
    if _last_above(band, [value - final for value in after] if final else after, is_continuous=is_continuous):
        return found
    settled = _last_above(band, distance, is_continuous=is_continuous)
    return found | {"settles": _digits(settled * end / last, 3)}


def _peak(line: Sequence[int], *, is_continuous: bool) -> Fraction | None:
    """Return the value of largest modulus, between the instants too; None where the line is too coarse."""
    last, largest = len(line) - 1, _largest(line)
    place = next(k for k, value in enumerate(line) if abs(value) == largest)
    peak = Fraction(line[place])
    if is_continuous:
        if _is_coarse(line):
            return None
        if 0 < place < last and (bend := line[place - 1] - 2 * line[place] + line[place + 1]):
            peak -= Fraction((line[place + 1] - line[place - 1]) ** 2, 8 * bend)  # of the parabola through three
    return peak


def _last_above(band: int, line: Sequence[int], *, is_continuous: bool) -> int:
    """Return the number of the last segment on which a response may leave a band, counted from 1; 0 where there is none.

    It may bulge out of a segment by an eighth of the second difference.
    """
    last = start = len(line) - 1
    if 2 * _largest(line) < band - 1:
        return 0
    if is_continuous:  # no second difference is larger than four times the values
        while start >= 0 and -band < 2 * line[start] < band - 1:
            start -= 1
        start = min(last, start + 2) if start >= 0 else 0
    for k in range(start, 0, -1):
        a, b = line[k - 1], line[k]
        most = max(abs(a), abs(b))
        if is_continuous:
            bends = [line[at - 1] - 2 * line[at] + line[at + 1] for at in (k - 1, k) if 0 < at < last]
            most += max(map(abs, bends)) // 8 + 1
        if most > band:
            return k
    return 0


def _digits(value: Fraction, count: int) -> str:
    """Return a decimal with so many digits, without a power of ten."""
    return f"{Decimal(f'{float(value):.{count}g}'):f}"


def readout(real: Fraction, imaginary: Fraction, *, discrete: bool) -> dict[str, str]:
    """Return natural frequency, damping ratio and settling time of a pole, or its modulus in discrete time."""
    square = real * real + imaginary * imaginary
    if discrete:
        return {"exact": f"|z|² = {square}", "modulus": _places(_root(square))}
    root = _root(square)
    whole = f"{square}" if square.denominator == 1 else f"({square})"
    found = {"exact": f"ωₙ = {root}" if root * root == square else f"ωₙ = √{whole}"}
    if root:
        found["damping"] = _places(-real / root)
    if real < 0:
        if imaginary and (percent := 100 * exp(pi * float(real / abs(imaginary)))) >= _LEAST_PERCENT:
            found["overshoot"] = _digits(Fraction(percent), 3)
        found["settles"] = _digits(Fraction(log(50)) / -real, 3)
    return found


def _root(square: Fraction) -> Fraction:
    """Return the square root, to twelve places."""
    scale = 10**24
    return Fraction(isqrt(square.numerator * scale // square.denominator), 10**12)


def _places(value: Fraction) -> str:
    return f"{float(value):.3f}".rstrip("0").rstrip(".")
