"""Random designs and analyses against independent systems: python -m tests.programs.campaign --designs 100000 --seed 1."""

from __future__ import annotations

import argparse
import sys
import time
import traceback
from pathlib import Path
from typing import TYPE_CHECKING

from tests.programs.campaign import discovery
from tests.programs.campaign.asked import Asked, Tables, to_toml
from tests.programs.campaign.figures import DIFFERS, Figures
from tests.programs.campaign.plants import drawn
from tests.programs.campaign.shrink import disagrees, shrunk
from tests.programs.campaign.solving import Refused, solved

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from tests.programs.campaign.discovery import Oracle


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a campaign; 1 where an oracle disagreed or symobs crashed."""
    options = _parser().parse_args(arguments)
    oracles, missing = discovery.found()
    chosen = {name: oracle for name, oracle in oracles.items() if not options.oracle or name in options.oracle}
    for name, reason in missing.items():
        print(f"{name}: not asked, {reason}", file=sys.stderr)
    folder: Path = options.out
    folder.mkdir(parents=True, exist_ok=True)
    kept = folder / "figures.json"
    figures = Figures.load(kept) if kept.exists() else Figures(options.seed)
    look_again(figures, chosen, folder, options.task)
    _keep(figures, folder)
    while figures.total + sum(figures.refused.values()) < options.designs:
        left = options.designs - figures.total - sum(figures.refused.values())
        run_batch(figures, chosen, folder, min(options.batch, left), options.task, options.seconds)
        _keep(figures, folder)
        print(_progress(figures, chosen), file=sys.stderr, flush=True)
    print(figures.table())
    wrong = sum(figures.count(name, DIFFERS) for name in chosen)
    return 1 if wrong or any((folder / "failures").glob("crash-*")) else 0


def _keep(figures: Figures, folder: Path) -> None:
    """Write down what is known so far, to read and to go on from."""
    figures.save(folder / "figures.json")
    (folder / "table.txt").write_text(figures.table() + "\n", encoding="utf-8")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tests.programs.campaign", description=__doc__)
    parser.add_argument("--designs", type=int, default=1000, help="how many problems, those of an earlier run included")
    parser.add_argument("--seed", type=int, default=1, help="the first seed")
    parser.add_argument("--batch", type=int, default=200, help="problems between two starts of the oracles")
    parser.add_argument("--seconds", type=float, default=4, help="time for one answer of symobs")
    parser.add_argument("--oracle", action="append", default=[], help="ask this oracle alone; may be repeated")
    parser.add_argument("--task", action="append", default=[], help="ask this task alone; may be repeated")
    parser.add_argument("--out", type=Path, default=Path("campaign"), help="figures and failures; a run there goes on")
    return parser


def _progress(figures: Figures, oracles: Mapping[str, Oracle]) -> str:
    wrong = {name: figures.count(name, DIFFERS) for name in oracles}
    rate = 60 * figures.total / figures.seconds
    said = ", ".join(f"{name} {number}" for name, number in wrong.items())
    return f"{figures.total} answers, {rate:.0f} a minute; disagreements: {said}"


def run_batch(
    figures: Figures, oracles: Mapping[str, Oracle], folder: Path, count: int, tasks: Sequence[str], seconds: float
) -> None:
    """Draw, solve and judge so many problems, and count them."""
    begun = time.perf_counter()
    answers: list[Asked] = []
    for seed in range(figures.next_seed, figures.next_seed + count):
        kind, problem = drawn(seed, tasks)
        answer = _answered(folder, kind, seed, problem, seconds)
        if answer is None:
            figures.refused[str(problem["task"]), "crashed"] += 1
        elif isinstance(answer, Asked):
            answers.append(answer)
            figures.answered(answer)
        else:
            figures.gave_up(answer)
    _judge(figures, oracles, answers, folder)
    figures.next_seed += count
    figures.seconds += time.perf_counter() - begun


def _answered(folder: Path, kind: str, seed: int, problem: Tables, seconds: float) -> Asked | Refused | None:
    """Return our answer; None where there was an exception that is no refusal, which is written down."""
    try:
        return solved(kind, seed, problem, seconds)
    except Exception:  # noqa: BLE001 - whatever it is, it is a bug of ours, and the campaign goes on
        _write(folder, f"crash-{seed}", problem, traceback.format_exc(limit=-3))
        return None


def _judge(figures: Figures, oracles: Mapping[str, Oracle], answers: Sequence[Asked], folder: Path) -> None:
    """Let every oracle judge what it covers."""
    for name, oracle in oracles.items():
        covered = [answer for answer in answers if oracle.covers(answer.problem)]
        judgements = discovery.judged(oracle, covered)
        for answer, judgement in zip(covered, judgements, strict=True):
            figures.judge(name, answer, judgement)
            if isinstance(judgement, str):
                report(folder, name, oracle, answer, judgement)


def look_again(figures: Figures, oracles: Mapping[str, Oracle], folder: Path, tasks: Sequence[str]) -> None:
    """Judge again what an earlier run of the same seeds found wrong; what is mended is counted as it is now."""
    mended = folder / "failures" / "mended"
    for path in sorted((folder / "failures").glob("*.toml")):
        name, _, number = path.stem.rpartition("-")
        if not number.isdigit():
            continue
        if int(number) >= figures.next_seed:  # of a batch that was not finished, which is drawn again
            path.unlink()
            continue
        kind, problem = drawn(int(number), tasks)
        answer = _answered(folder, kind, int(number), problem, 30)
        if not isinstance(answer, Asked):
            continue
        if name == "crash":
            figures.refused[answer.task, "crashed"] -= 1
            figures.answered(answer)
            _judge(figures, oracles, [answer], folder)
        elif (oracle := oracles.get(name.replace("-", " "), oracles.get(name))) is not None:
            (judgement,) = discovery.judged(oracle, [answer])
            if isinstance(judgement, str):
                continue
            figures.judge(oracle.NAME, answer, judgement)
            figures.withdraw(oracle.NAME, answer)
        mended.mkdir(exist_ok=True)
        for each in (path, path.with_stem(f"{path.stem}-small")):
            if each.exists():
                each.replace(mended / each.name)


def report(folder: Path, name: str, oracle: Oracle, answer: Asked, judgement: str) -> Tables:
    """Write a disagreement down as it came, and the smallest problem found that still shows one."""
    print(f"{name} disagrees about seed {answer.seed} ({answer.kind}, {answer.task}): {judgement}", file=sys.stderr)
    stem = f"{name.replace(' ', '-')}-{answer.seed}"
    _write(folder, stem, answer.problem, judgement)
    smaller = shrunk(answer.problem, lambda problem: disagrees(oracle, answer.kind, problem) is not None)
    _write(folder, f"{stem}-small", smaller, disagrees(oracle, answer.kind, smaller) or judgement)
    return smaller


def _write(folder: Path, stem: str, problem: Tables, said: str) -> None:
    failures = folder / "failures"
    failures.mkdir(exist_ok=True)
    remark = "".join(f"# {line}\n" for line in said.splitlines())
    (failures / f"{stem}.toml").write_text(remark + to_toml(problem), encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
