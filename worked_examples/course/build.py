"""Build the course, `python build.py OUT`: every sheet, variant, question and mark comes from the command symobs."""

from __future__ import annotations

import argparse
import csv
import re
import shutil
import subprocess
import sys
import time
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

SYMOBS = (sys.executable, "-m", "symobs")
HERE = Path(__file__).resolve().parent
SHEETS = sorted(path.parent for path in HERE.glob("[0-9]*/sheet.toml"))
STUDENTS = HERE / "students.csv"
#: Of the numbers of their own: another term has others.
TERM = 2026
PLATFORMS = ("stack", "prairielearn", "moodle")
#: The marked class: a problem, and the table of the answers to it.
MARKED = (HERE / "09_compensator" / "motor.toml", HERE / "marking" / "answers.csv")
#: The note of a question that a platform takes with all its parts.
WHOLE = "all of it was exported\n"
REFUSED = 3  # the exit code of an input that cannot be used, here by a platform


class Job:
    """One command of symobs: what it writes, and what that is made of."""

    def __init__(self, target: Path, sources: list[Path], *command: object) -> None:
        self.target, self.sources = target, sources
        self.command = [*SYMOBS, *map(str, command)]

    def is_done(self) -> bool:
        """Return whether the target is younger than all that it is made of."""
        return self.target.exists() and self.target.stat().st_mtime >= max(p.stat().st_mtime for p in self.sources)

    def run(self) -> subprocess.CompletedProcess[str]:
        """Run the command."""
        self.target.parent.mkdir(parents=True, exist_ok=True)
        return subprocess.run(self.command, capture_output=True, text=True, check=False, cwd=HERE)


class Builder:
    """Runs jobs, so many at once, tells what is done, and goes on after one that fails."""

    def __init__(self, out: Path, workers: int) -> None:
        self.out, self.workers, self.failed, self.left_out = out, workers, 0, 0
        self.lock = Lock()

    def all(self, title: str, jobs: Sequence[Job]) -> None:
        """Run all jobs of a step that are not up to date."""
        waiting = [job for job in jobs if not job.is_done()]
        print(f"{title}: {len(waiting)} to build, {len(jobs) - len(waiting)} up to date", flush=True)
        with ThreadPoolExecutor(self.workers) as pool:
            list(pool.map(self.one, waiting))

    def one(self, job: Job) -> None:
        """Run a job, and tell how it went."""
        began = time.monotonic()
        done = job.run()
        name = job.target.relative_to(self.out)
        is_refused = isinstance(job, Export) and done.returncode == REFUSED
        if done.returncode == 0:
            said = f"{time.monotonic() - began:.1f} s"
            if isinstance(job, Export) and done.stderr:
                said += f", without {short(done.stderr)}"
        elif is_refused:
            said = f"left out, {short(done.stderr)}"
        else:
            said = f"FAILED with exit code {done.returncode}: {done.stderr.strip()}"
        with self.lock:
            self.left_out += is_refused
            self.failed += done.returncode != 0 and not is_refused
            print(f"  {name}  {said}", flush=True)


class Export(Job):
    """A question for a platform, without the parts that the platform refuses; the target is a note of what was left out."""

    def __init__(self, bank: Path, platform: str, name: str, source: Path, problem: Path) -> None:
        written = bank / platform if platform == "prairielearn" else bank / platform / "single" / f"{name}.xml"
        command = ("export", source, "--to", platform, "-o", written)
        super().__init__(bank / "notes" / platform / f"{name}.txt", [source, problem], *command)
        self.platform, self.problem = platform, problem
        written.parent.mkdir(parents=True, exist_ok=True)

    def run(self) -> subprocess.CompletedProcess[str]:
        """Run the command, and once more for the parts that the platform takes."""
        done = super().run()
        if done.returncode == REFUSED:
            refused = set(re.findall(r"\b\w+\.\w+(?=: )", done.stderr))
            left = [part for part in self.parts() if part not in refused]
            if left:
                self.command += [word for part in left for word in ("--asked", part)]
                reasons, done = done.stderr, super().run()
                done.stderr = "".join(dict.fromkeys((reasons + done.stderr).splitlines(keepends=True)))
        if done.returncode in {0, REFUSED}:
            self.target.write_text(done.stderr or WHOLE, "utf-8")
        return done

    def parts(self) -> list[str]:
        """Return what the problem asks for, as task.field: `symobs check --asked` lists it."""
        data = tomllib.loads(self.problem.read_text("utf-8"))
        task, found = data.get("task") or data["tasks"][0], []
        listed = subprocess.run([*SYMOBS, "check", self.problem, "--asked"], capture_output=True, text=True, check=True)
        for line in listed.stdout.partition("[[step]]")[0].splitlines():
            table, field = re.fullmatch(r"\[answer\.(\w+)\]", line), re.match(r"# (\w+) = ", line)
            task = table[1] if table else task
            found += [f"{task}.{field[1]}"] if field else []
        return found


def short(reasons: str) -> str:
    """Return the first of several reasons on one line."""
    lines = reasons.strip().splitlines() or ["no reason was given"]
    return lines[0].split(";")[0] + (f" (and {len(lines) - 1} more)" if len(lines) > 1 else "")


def sheet_jobs(out: Path) -> list[Job]:
    """Return the sheets: questions as PDF and page, and the key; the examination in two versions with one key."""
    jobs = []
    for folder in [*SHEETS, HERE / "exam"]:
        sheet, sources = folder / "sheet.toml", sorted(folder.glob("*.toml"))
        versions = ["--versions", 2] if folder.name == "exam" else []
        for name, half in (
            ("questions.pdf", "--questions"),
            ("questions.html", "--questions"),
            ("key.pdf", "--solutions"),
        ):
            target = out / folder.name / name
            jobs.append(Job(target, sources, "sheet", sheet, half, *versions, "-o", target))
    return jobs


def variant_jobs(out: Path) -> list[Job]:
    """Return the sets of problems with numbers of their own, and who gets which."""
    count = max(2, len(list(csv.DictReader(STUDENTS.read_text("utf-8-sig").splitlines()))))
    jobs = []
    for number, folder in enumerate(SHEETS, 1):
        problem, target = folder / "own_numbers.toml", out / folder.name / "own_numbers"
        options = ("--count", count, "--seed", 100 * TERM + number, "--assign", STUDENTS, "--workers", 1)
        jobs.append(Job(target / "manifest.json", [problem, STUDENTS], "variants", problem, *options, "-o", target))
    return jobs


def variant_sheet_jobs(out: Path) -> list[Job]:
    """Return the sheets of these sets: a page for every variant, and the key."""
    jobs = []
    for folder in SHEETS:
        own = out / folder.name / "own_numbers"
        title = tomllib.loads((folder / "sheet.toml").read_text("utf-8"))["title"]
        options = ("sheet", own / "sheet.toml", "--title", f"{title}: numbers of your own")
        made = [own / "manifest.json"]
        jobs.append(Job(own / "questions.pdf", made, *options, "--questions", "-o", own / "questions.pdf"))
        jobs.append(Job(own / "key.pdf", made, *options, "--solutions", "--detail", "outline", "-o", own / "key.pdf"))
    return jobs


def export_jobs(out: Path) -> list[Export]:
    """Return the questions of the learning platforms: every problem, and every set of variants as one question."""
    jobs = []
    for platform in PLATFORMS:
        for folder in SHEETS:
            for problem in sorted(set(folder.glob("*.toml")) - {folder / "sheet.toml"}):
                is_set = problem.stem == "own_numbers"
                source = out / folder.name / "own_numbers" / "manifest.json" if is_set else problem
                asked = source.parent / "variants" / "v001.toml" if is_set else problem
                jobs.append(Export(out / "banks", platform, f"{folder.name}_{problem.stem}", source, asked))
    return jobs


def bank_jobs(out: Path) -> list[Job]:
    """Return one file for each platform that imports files: all questions that it takes whole."""
    jobs = []
    for platform in ("stack", "moodle"):
        whole = [job for job in export_jobs(out) if job.platform == platform and job.target.read_text("utf-8") == WHOLE]
        target, sources = out / "banks" / platform / "bank.xml", [job.sources[0] for job in whole]
        jobs.append(
            Job(target, [*sources, *(job.target for job in whole)], "export", *sources, "--to", platform, "-o", target)
        )
    return jobs


def marking_jobs(out: Path) -> list[Job]:
    """Return the marked class."""
    problem, answers = MARKED
    target = out / "marking"
    command = ("check", problem, "--submissions", answers, "--feedback", "--workers", 1, "-o", target)
    return [Job(target / "marks.csv", [problem, answers], *command)]


def main() -> int:
    """Build what is not up to date; the exit code is 1 where something failed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=Path, help="the folder of what is built")
    parser.add_argument("--workers", type=int, default=2, help="so many commands at once (2)")
    given = parser.parse_args()
    if shutil.which("latexmk") is None:
        print("PDF files need TeX: latexmk is not installed", file=sys.stderr)
        return 1
    began, builder = time.monotonic(), Builder(given.out.resolve(), given.workers)
    for title, jobs in (
        ("sheets", sheet_jobs),
        ("numbers of their own", variant_jobs),
        ("sheets of these", variant_sheet_jobs),
        ("questions of the platforms", export_jobs),
        ("question banks", bank_jobs),
        ("marking", marking_jobs),
    ):
        builder.all(title, jobs(builder.out))
    print(f"{time.monotonic() - began:.0f} s, {builder.failed} failed; {builder.left_out} questions left out")
    return 1 if builder.failed else 0


if __name__ == "__main__":
    sys.exit(main())
