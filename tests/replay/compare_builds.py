#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Two builds of `meridian`, the same motion: every recording bit for bit the same.

    tests/replay/compare_builds.py OLD NEW [--files DIR...] [--old-machines DIR] [--jobs N] [--only TEXT]

OLD and NEW are two programs `meridian`. Each simulates the same programs: the test pattern of every
machine file on that machine, the sample part, and all CL files under --files on every machine file,
smooth and with exact stop. A program that both refuse with the same exit code and words is the same.
Where keys of machine files were renamed, OLD reads those of --old-machines.
For changes that must not change behaviour: rooms, names, states. Exit code 1 where anything differs.
"""
import argparse
import concurrent.futures
import hashlib
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SUFFIXES = {".apt", ".cl", ".cls", ".cldata", ".aptsource"}
TIME_LIMIT_S = 300


def run(program, cl_file, machine, transition, folder):
    """What a build makes of a program: exit code, words of the report, checksum of the recording."""
    recording = folder / "recording.csv"
    command = [program, "simulate", str(cl_file), "--machine", str(machine), "--record", str(recording),
               "--transition", transition, "--unknown-tool-length", "100"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=TIME_LIMIT_S, check=False)
    except subprocess.TimeoutExpired:
        return "no end", "", ""
    text = re.sub(r"computed in .*", "", (done.stdout + done.stderr).replace(str(folder), ""))
    rows = hashlib.sha256(recording.read_bytes()).hexdigest() if recording.exists() else "none"
    return done.returncode, text, rows


def compare(job):
    old, new, cl_file, machine, transition, old_machine = job
    results = []
    for program, file in ((old, old_machine), (new, machine)):
        with tempfile.TemporaryDirectory() as name:
            results.append(run(program, cl_file, file, transition, pathlib.Path(name)))
    return job, results


def pattern_of(program, machine, folder):
    """The machine's own test pattern, as the old build writes it; None where there is none."""
    path = folder / f"{machine.stem}.apt"
    done = subprocess.run([program, "machine", str(machine), "--pattern", str(path)],
                          capture_output=True, check=False)
    return path if done.returncode in (0, 1) and path.exists() else None


def jobs_of(arguments, folder):
    machines = sorted((ROOT / "deploy/machines").glob("*.toml"))
    files = [file for folder in arguments.files for file in sorted(pathlib.Path(folder).rglob("*"))
             if file.suffix.lower() in SUFFIXES]
    for machine in machines:
        old_machine = pathlib.Path(arguments.old_machines) / machine.name if arguments.old_machines else machine
        pattern = pattern_of(arguments.old, old_machine, folder)
        for file in ([pattern] if pattern else []) + files:
            for transition in ("smooth", "exact_stop"):
                if arguments.only in f"{machine.stem} {file.name} {transition}":
                    yield arguments.old, arguments.new, file, machine, transition, old_machine


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--files", action="append", default=[], help="folder of CL files")
    parser.add_argument("--old-machines", default="", help="folder of machine files for OLD")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", default="", help="part of 'machine file transition'")
    arguments = parser.parse_args()
    total = recorded = 0
    different = []
    with tempfile.TemporaryDirectory() as name, \
            concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for job, (old, new) in pool.map(compare, jobs_of(arguments, pathlib.Path(name))):
            total += 1
            recorded += old[2] not in ("none", "")
            if old[0] != new[0] or old[2] != new[2]:
                different.append(job)
                print(f"differs: {job[2].name} on {job[3].stem}, {job[4]}: exit {old[0]} and {new[0]}")
            elif old[1] != new[1]:
                print(f"other words: {job[2].name} on {job[3].stem}, {job[4]}")
    print(f"{total} runs, {recorded} recordings, {len(different)} differ")
    return 1 if different or not recorded else 0


if __name__ == "__main__":
    sys.exit(main())
