"""Compares two versions of the program, scene by scene; scripts/compare-versions starts it."""

import argparse
import shutil
import subprocess
import sys
import time
from pathlib import Path

from . import inputs, motions, ranks, rests, rules, runs, scene, selftest, tools

GROUPS = {inputs.NAME: inputs.compare, tools.NAME: tools.compare}


def arguments():
    """What the front passes on."""
    parser = argparse.ArgumentParser(prog="scripts/compare-versions")
    parser.add_argument("--old", type=Path)
    parser.add_argument("--new", type=Path)
    parser.add_argument("--work", type=Path, required=True)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--only", default="")
    parser.add_argument("--lines", type=int, default=12)
    parser.add_argument("--mpi", nargs=2, type=Path, metavar=("OLD", "NEW"))
    parser.add_argument("--undeformed", action="store_true")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--self-test", action="store_true")
    return parser.parse_args()


def chosen(only, has_mpi, from_undeformed):
    """Names of scenes and groups to compare, with how; empty when a name is unknown."""
    cases = motions.CASES + rests.CASES
    if from_undeformed:
        cases = [scene.undeformed(case) for case in motions.CASES]
    jobs = {case.name: (lambda s, case=case: runs.compare(s, case)) for case in cases}
    jobs.update({} if from_undeformed else GROUPS)
    if has_mpi:
        jobs[ranks.NAME] = ranks.compare
    names = [name for name in only.split(",") if name]
    unknown = [name for name in names if name not in jobs]
    if unknown:
        print(f"compare-versions: no scene {', '.join(unknown)}; known are {', '.join(jobs)}", file=sys.stderr)
        return {}
    return {name: job for name, job in jobs.items() if not names or name in names}


def attempt(job, setting, name):
    """The verdict; a program that hangs or results that cannot be read are no result."""
    try:
        return job(setting)
    except (OSError, ValueError, LookupError, StopIteration, subprocess.TimeoutExpired) as error:
        return rules.Verdict(name, rules.MISSING, f"{type(error).__name__}: {error}")


def show(verdict, seconds, lines):
    """A line per scene; below it what differs and by how much."""
    size = f" ({verdict.size})" if verdict.size else ""
    print(f"{verdict.name:20} {verdict.word}{size}  {seconds:.1f} s", flush=True)
    for note in verdict.notes:
        print(f"    note: {note}")
    for difference in verdict.differences[:lines]:
        print(f"    {difference.line()}")
    if len(verdict.differences) > lines:
        print(f"    and {len(verdict.differences) - lines} more places; --lines shows more", flush=True)


def exit_code(verdicts):
    """0 all good, 1 differences, 2 something is missing."""
    if any(v.word == rules.MISSING for v in verdicts):
        return 2
    return 0 if all(v.is_good() for v in verdicts) else 1


def main():
    """Exit code as above."""
    options = arguments()
    jobs = chosen(options.only, options.mpi is not None, options.undeformed)
    if options.list:
        print("\n".join(jobs))
        return 0
    if not jobs:
        return 2
    shutil.rmtree(options.work, ignore_errors=True)
    options.work.mkdir(parents=True)
    old, new = options.old.resolve(), options.new.resolve()
    setting = runs.Setting(old, new, options.threads, options.work, options.mpi)
    if options.self_test:
        return selftest.run(setting)
    verdicts = []
    for name, job in jobs.items():
        clock = time.monotonic()
        verdicts.append(attempt(job, setting, name))
        show(verdicts[-1], time.monotonic() - clock, options.lines)
    words = (rules.SAME, rules.WITHIN, rules.DIFFERS, rules.MISSING)
    counts = [f"{sum(v.word == word for v in verdicts)} {word}" for word in words]
    print(f"compare-versions: {', '.join(counts)}")
    return exit_code(verdicts)


if __name__ == "__main__":
    sys.exit(main())
