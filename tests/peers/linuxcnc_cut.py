#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""LinuxCNC cuts a CL file on the machine of a Meridian machine file, recorded through HAL: one row for
each servo period of the cut, in the columns of Meridian's recordings. Exit code 1: it did not reach
the end; the rows until then are kept. 77: LinuxCNC is not there.
"""
import argparse
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from linuxcnc_machine import Machine

APART = ("unshare", "-imnp", "--fork", "--mount-proc", "--kill-child")


def refuse_where_it_cannot_run():
    why = ""
    if not shutil.which("linuxcnc"):
        why = "LinuxCNC (package linuxcnc-uspace) is not there"
    elif os.getuid() == 0 and subprocess.run([*APART, "true"], check=False).returncode:
        why = "LinuxCNC refuses root, and there are no namespaces here"
    if why:
        print(why)
        sys.exit(77)


def points_of(meridian, file):
    rows = subprocess.run([meridian, "cl", file], capture_output=True, text=True, check=True).stdout
    return [[float(word) for word in row.split()] for row in rows.splitlines()]


def rotary(axis, before):
    """B and C in degrees that turn the table under the tool: the pair nearest to the one before."""
    i, j, k = axis
    tilt = math.degrees(math.hypot(i, j) and math.atan2(math.hypot(i, j), k))
    turn = math.degrees(math.atan2(j, -i)) if tilt else before[1]
    pairs = [(b, c + 360 * round((before[1] - c) / 360))
             for b, c in ((tilt, turn), (-tilt, turn + 180))]
    return min(pairs, key=lambda bc: abs(bc[0] - before[0]) + abs(bc[1] - before[1]))


def program(points, mode):
    """One block for each point. Rests before the cut, raises the marker, rests behind it. A path that
    begins with the tool upright begins with C as its first tilted point has it."""
    lines = ["G21 G90 G94 G17 G40 G49", mode]
    tilted = [rotary(point[3:6], (0, 0)) for point in points if math.hypot(*point[3:5]) > 1e-9]
    at = (0.0, tilted[0][1] if tilted else 0.0)
    for n, (x, y, z, i, j, k, feed) in enumerate(points):
        at = rotary((i, j, k), at)
        words = f"X{x:.6f} Y{y:.6f} Z{z:.6f} B{at[0]:.6f} C{at[1]:.6f}"
        if n == 0:
            lines += [f"G0 {words}", "G4 P0.3", "M62 P0"]
        else:
            lines.append(f"G1 {words} F{feed:.3f}" if feed else f"G0 {words}")
    return "\n".join(lines + ["G4 P0.3", "M2", ""])


def start(folder):
    """LinuxCNC in `folder` until its program has ended; returns why it stopped before the end, no line
    where it did not. It refuses root: then it runs as nobody, with memory, processes, network and /tmp
    of its own, so that it neither meets nor ends another one."""
    command = ["linuxcnc", "-r", str(folder / "machine.ini")]
    home = folder
    if os.getuid() == 0:
        for one in [folder, *folder.iterdir()]:
            shutil.chown(one, "nobody")
        apart = (f"mount --bind '{folder}' /tmp && mount -t tmpfs tmpfs /dev/shm && cd /tmp &&"
                 " exec setpriv --reuid=nobody --regid=nogroup --clear-groups"
                 " linuxcnc -r /tmp/machine.ini")
        command = [*APART, "sh", "-c", apart]
        home = "/tmp"
    with open(folder / "log", "w", encoding="utf-8") as log:
        code = subprocess.run(command, cwd=folder, stdout=log, stderr=log, check=False,
                              env={**os.environ, "HOME": str(home), "DISPLAY": ""}).returncode
    said = (folder / "log").read_text(errors="replace").splitlines()
    return [line for line in said if line.startswith("LinuxCNC: ")] if code else []


def rows_of(folder, machine):
    """The cut alone: from the marker to the last period that moves."""
    samples = folder / "samples.txt"
    text = samples.read_text(encoding="ascii") if samples.exists() else ""
    rows = [[float(word) for word in line.split()] for line in text.splitlines() if "overrun" not in line]
    cut = [row[:6] for row in rows if len(row) == 7 and row[6]]
    while len(cut) > 1 and cut[-1][1:] == cut[-2][1:]:
        cut.pop()
    if len(cut) < 2:
        sys.exit(f"LinuxCNC did not cut:\n{(folder / 'log').read_text(errors='replace')[-3000:]}")
    if cut[-1][0] - cut[0][0] != len(cut) - 1:
        sys.exit("LinuxCNC: halsampler lost samples")
    return [machine.columns(row[1:]) for row in cut]


def main():
    reader = argparse.ArgumentParser(description=__doc__, allow_abbrev=False)
    reader.add_argument("meridian", help="the program; it reads the CL file as points")
    reader.add_argument("machine", help="machine file (TOML): a table with C on B")
    reader.add_argument("file", help="CL file")
    reader.add_argument("out", help="recording (CSV)")
    reader.add_argument("--mode", default="G64 P0.01", help="path mode and its tolerance, mm")
    reader.add_argument("--drives", choices=["perfect", "real"], default="perfect",
                        help="real ones keep the limits; more than the following error ends the cut")
    asked = reader.parse_args()
    refuse_where_it_cannot_run()
    machine = Machine(asked.machine)
    with tempfile.TemporaryDirectory(prefix="linuxcnc-") as name:
        folder = pathlib.Path(name)
        machine.write(folder, asked.drives)
        (folder / "program.ngc").write_text(program(points_of(asked.meridian, asked.file), asked.mode))
        fault = start(folder)
        rows = rows_of(folder, machine)
    with open(asked.out, "w", encoding="ascii") as table:
        table.write("cycle,due_ns,X_mm,Y_mm,Z_mm,C_rad,B_rad\n")
        for n, row in enumerate(rows, 1):
            table.write(f"{n},{n}000000," + ",".join(f"{value!r}" for value in row) + "\n")
    print(f"{asked.out}: {(len(rows) - 1) / 1000:.3f} s", *fault, sep="\n")
    sys.exit(1 if fault else 0)


if __name__ == "__main__":
    main()
