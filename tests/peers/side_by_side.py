#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Meridian and LinuxCNC on the same paths, the same machine and the same limits: recordings, tables in
Markdown and pictures of the joints, in FOLDER. Recordings that are there are not made again. Exit code
77: LinuxCNC is not there.
"""
import argparse
import pathlib
import subprocess
import sys

import figures
import pictures
from linuxcnc_cut import points_of, refuse_where_it_cannot_run
from linuxcnc_machine import Machine

SOURCE = pathlib.Path(__file__).resolve().parents[2]
PATHS = ("fan", "near_pole", "near_pole_coarse", "near_pole_rim", "blade", "dome")
PART = "blossom"
MODES = {"LinuxCNC G64 P0.01": ("g64", "G64 P0.01"), "LinuxCNC G61": ("g61", "G61")}
DRAWN = ("near_pole_rim", "blade")


class Bench:
    def __init__(self, asked):
        self.meridian, self.machine_file = asked.meridian, asked.machine
        self.machine = Machine(asked.machine)
        self.folder = pathlib.Path(asked.folder)
        self.folder.mkdir(parents=True, exist_ok=True)

    def file(self, path):
        return SOURCE / "deploy/parts" / f"{PART}.apt" if path == PART else self.folder / f"{path}.apt"

    def ours(self, path):
        out = self.folder / f"{path}.csv"
        if not out.exists():
            asked = (["simulate", self.file(path), "--tools", SOURCE / "deploy/tools.toml", "--record", out]
                     if path == PART else
                     ["bench", path, "--pole-policy", "ease", "--write", self.folder])
            done = subprocess.run([self.meridian, *asked, "--machine", self.machine_file],
                                  capture_output=True, text=True, check=False)
            if done.returncode:
                sys.exit(f"meridian: {done.stdout}{done.stderr}")
        return figures.read(out)

    def theirs(self, path, name, mode):
        out = self.folder / f"{path}.{name}.csv"
        if not out.exists():
            subprocess.run([pathlib.Path(__file__).with_name("linuxcnc_cut.py"), self.meridian,
                            self.machine_file, self.file(path), out, "--mode", mode], check=True)
        return figures.read(out)

    def cuts(self, path):
        yield "Meridian", self.ours(path)
        for control, (name, mode) in MODES.items():
            yield control, self.theirs(path, name, mode)


def main():
    reader = argparse.ArgumentParser(description=__doc__, allow_abbrev=False)
    reader.add_argument("meridian", help="the program")
    reader.add_argument("folder", help="where everything is kept")
    reader.add_argument("paths", nargs="*", metavar="path", help=f"of {', '.join((*PATHS, PART))}; else all")
    reader.add_argument("--machine", default=SOURCE / "deploy/machines/trunnion-bc.toml")
    asked = reader.parse_args()
    refuse_where_it_cannot_run()
    bench = Bench(asked)
    whole = ["| path | control | time s | tip µm | axis deg |", "|---|---|---|---|---|"]
    shares = ["| path | control | " + " | ".join(figures.JOINTS) + " | jerk |", "|---" * 8 + "|"]
    for path in asked.paths or (*PATHS, PART):
        cuts = list(bench.cuts(path))
        points = points_of(bench.meridian, bench.file(path))
        for control, joints in cuts:
            found = figures.check(bench.machine, points, joints)
            row = f"| {path} | {control} |"
            whole.append(f"{row} {found.time_s:.2f} | {found.tip_um:.1f} | {found.axis_deg:.3f} |")
            shares.append(row + "".join(f" {v:.2f}, {a:.2f} |" for v, a, _ in found.shares.values())
                          + f" {max(j for _, _, j in found.shares.values()):.1f} |")
        if path in DRAWN:
            pictures.draw(bench.folder / f"{path}.svg", path, bench.machine, cuts[:2])
    tables = "\n".join([*whole, "", *shares, ""])
    (bench.folder / "tables.md").write_text(tables, encoding="utf-8")
    print(tables, end="")


if __name__ == "__main__":
    main()
