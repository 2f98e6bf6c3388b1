#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Station, service and drives are killed and stopped in a seeded order while parts are cut, and
recoveries are broken off again; what the journal says is done, until the part is finished. Then
tip_coverage.py finds what was skipped and what was cut again.

The whole campaign, an hour; what ctest runs:
    tests/attack/recovery.py --programs build/release/bin --kills 500 --minutes 60 --corpus FOLDER
    tests/attack/recovery.py --programs build/release/bin --kills 12 --minutes 1.2
Without --corpus a part of its own is cut. Exit code 1 where anything was skipped or cut again.
"""
import argparse
import json
import os
import pathlib
import random
import re
import signal
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import tip_coverage
from plant import Plant, wait_until

FRAME = "20,-30,50"
MAX_DEPTH = 5  # recoveries that are broken off one after the other
# Heads of real five-axis parts: strokes of 100 mm at 1000 mm/min.
CORPUS = (("ramsai_1-1_plan_3x.apt", 22), ("ramsai_1-2_plan_5x_depincage_lateral.apt", 36),
          ("ramsai_1-3_plan_5x_depincage_double.apt", 44))
TOOLS = "".join(f"[[tool]]\nnumber = {n}\nlength_mm = 110\nradius_mm = 5\n" for n in (1, 2, 45))
DONE = re.compile(r"go on with --from-line (\d+), or (\d+) if that was all")
LINE = re.compile(r"go on with --from-line (\d+)")
KINDS = ("service killed", "service killed", "service ended", "service stopped", "station killed",
         "station stopped", "drives killed", "drives stopped")


def write_parts(folder, corpus):
    """[(name, file)]"""
    parts = []
    if corpus:
        for name, lines in CORPUS:
            text = (pathlib.Path(corpus) / name).read_text(errors="replace").splitlines()
            while text[lines - 1].endswith("$"):
                lines += 1
            file = folder / name
            file.write_text("\n".join(text[:lines] + ["FINI"]) + "\n")
            parts.append((name, file))
        return parts
    lines = ["UNITS/MM", "LOADTL/1", "RAPID", "GOTO/0,0,60,0,.17364818,.98480775", "FEDRAT/1500,MMPM"]
    for n in range(14):
        lean = ".17364818,0,.98480775" if n % 4 < 2 else "0,.17364818,.98480775"
        lines.append(f"GOTO/{20 if n % 2 == 0 else 0},{n // 2},{30 + n % 3},{lean}")
    file = folder / "own.apt"
    file.write_text("\n".join(lines + ["FINI"]) + "\n")
    return [("own part", file)]


class Campaign:
    def __init__(self, arguments):
        self.arguments, self.draw = arguments, random.Random(arguments.seed)
        self.kills, self.wrong, self.parts_done = 0, [], 0
        self.counts, self.depths = {}, {}
        self.end = time.monotonic() + 60 * arguments.minutes
        self.accounts = []

    def is_over(self):
        return self.kills >= self.arguments.kills or time.monotonic() > self.end

    def run(self):
        folder = pathlib.Path(self.arguments.folder)
        folder.mkdir(parents=True, exist_ok=True)
        parts = write_parts(folder, self.arguments.corpus)
        round_ = 0
        while not self.is_over():
            name, file = parts[round_ % len(parts)]
            transition = ("smooth", "exact_stop")[(round_ // len(parts)) % 2]
            round_ += 1
            self.cut_part(name, file, transition)
        return self.report()

    def cut_part(self, name, file, transition):
        settings = f'tools = "{self.arguments.folder}/tools.toml"\nbridge_cycles = 50\n'
        (pathlib.Path(self.arguments.folder) / "tools.toml").write_text(TOOLS)
        plant = Plant(self.arguments.programs, settings=settings, cycle_us=2000,
                      drives=("--action-delay", "0.2"), keep_logs=self.arguments.keep)
        watch_file = plant.folder / "watch.csv"
        ends, story = [], []
        try:
            watch = plant.attack("watch", "--file", watch_file, "--for", 3600)
            time.sleep(0.3)
            from_line = self.follow(plant, file, transition, ends, story)
            watch.send_signal(signal.SIGTERM)
            watch.wait(5)
            account = tip_coverage.check(file, watch_file,
                                         tuple(float(x) for x in FRAME.split(",")), 110.0, ends)
            account.update(part=name, transition=transition, story=story)
            if from_line is not None:  # broken off by the campaign's end
                account["skipped"] = [s for s in account["skipped"] if s[0] < from_line]
            else:
                self.parts_done += 1
            self.accounts.append(account)
            for kind in ("skipped", "cut_again"):
                if account[kind]:
                    self.wrong.append(f"{name}, {transition}: {kind} {account[kind]}")
            print(f"{name}, {transition}: {len(story)} disturbances, {account['pieces']} pieces, "
                  f"skipped {account['skipped']}, cut again {account['cut_again']}; "
                  f"{self.kills} so far", flush=True)
        finally:
            if self.arguments.keep:
                print(f"  {plant.folder}")
            plant.close()

    def follow(self, plant, file, transition, ends, story):
        """Cuts the part as the journal says. None: to its end; else the line that comes next."""
        from_line, depth = 0, 0
        tries = 0
        while True:
            line = self.begin_service(plant, from_line)
            if line == "end":
                return None
            from_line = max(0, line) if line is not None else from_line
            if self.is_over() and from_line:
                return from_line
            words = ["--units", "mm", "--transition", transition]
            if from_line:
                words += ["--from-line", from_line]
            tries += 1
            if tries > 400:
                self.wrong.append(f"{file.name}: no end after {tries} pieces")
                return from_line
            # A recovery that is broken off in its preflight, first actions, approach or first cut.
            is_early = depth < MAX_DEPTH and self.draw.random() < 0.45
            delay_s = self.draw.uniform(0.0, 1.6) if is_early else self.draw.uniform(1.5, 6.0)
            depth = depth + 1 if is_early else 0
            self.depths[depth] = self.depths.get(depth, 0) + 1
            kind = self.draw.choice(KINDS)
            if not plant.enable(12):
                story.append("not enabled")
                self.stop_all(plant, ends, "killed")
                continue
            station = plant.start_station(file, words)
            begin = time.monotonic()
            wait_until(lambda: plant.operator.state == "Loaded" or station.poll() is not None or
                       (is_early and time.monotonic() - begin > delay_s), 5)
            if plant.operator.state == "Loaded":
                plant.operator.must("start", ("Approaching", "Running"), patience_s=3)
            wait_until(lambda: station.poll() is not None, delay_s)
            if station.poll() == 0 and plant.operator.state in ("Ready", "Off"):
                self.stop_all(plant, ends, "ended")
                return None
            self.disturb(plant, kind, story, from_line)
            self.stop_all(plant, ends, "kill" if kind == "service killed" else kind)

    def begin_service(self, plant, from_line):
        """The line that the new service says, "end", or None where it says nothing."""
        size = len(plant.log())
        plant.start_service(("--frame=" + FRAME,))
        if plant.drives is None or plant.drives.poll() is not None:
            plant.start_drives()
        plant.start_operator()
        wait_until(lambda: plant.operator.state is not None, 8)
        said = plant.log()[size:]
        at = said.rfind("last program: ")
        if at < 0:
            return None
        said_last = said[at:said.find("\n", at)]
        if "ran to its end" in said_last:
            return "end" if from_line else None
        done = DONE.search(said_last)
        if done:
            return int(done.group(2))  # a line is a block here
        line = LINE.search(said_last)
        return int(line.group(1)) if line else None

    def disturb(self, plant, kind, story, from_line):
        self.kills += 1
        self.counts[kind] = self.counts.get(kind, 0) + 1
        story.append(f"{kind} after --from-line {from_line} in {plant.operator.state}")
        who, how = kind.split(" ", 1)
        process = {"service": plant.service, "station": plant.station, "drives": plant.drives}[who]
        if process.poll() is not None:
            return
        if how == "killed":
            process.kill()
            process.wait()
            if who == "station":  # what was received is cut, then the machine waits
                wait_until(lambda: plant.operator.state not in ("Running", "Approaching",
                                                                "Starving"), 12)
        elif how == "stopped":
            process.send_signal(signal.SIGSTOP)
            time.sleep({"service": 0.4, "station": 1.0, "drives": 0.6}[who])
            process.send_signal(signal.SIGCONT)
            time.sleep(self.draw.uniform(0.1, 1.0))

    def stop_all(self, plant, ends, how):
        """Service and station end; drives that are not dead stay."""
        ends.append(how)
        if plant.station and plant.station.poll() is None:
            plant.station.kill()
            plant.station.wait()
        plant.stop_service(15)

    def report(self):
        again = sum(len(a["cut_again"]) for a in self.accounts)
        skipped = sum(len(a["skipped"]) for a in self.accounts)
        lines = sum(a["lines"] for a in self.accounts)
        print(f"\nseed {self.arguments.seed}: {self.kills} disturbances, {len(self.accounts)} parts "
              f"begun, {self.parts_done} finished, {lines} cut lines, "
              f"{sum(a['pieces'] for a in self.accounts)} pieces")
        for kind, count in sorted(self.counts.items()):
            print(f"  {kind}: {count}")
        print("  recoveries broken off in a row: " +
              ", ".join(f"{d}: {n}" for d, n in sorted(self.depths.items())))
        print(f"skipped lines {skipped}, finished lines cut again {again}")
        for wrong in self.wrong:
            print(f"wrong: {wrong}")
        if self.arguments.json:
            pathlib.Path(self.arguments.json).write_text(json.dumps(self.accounts, indent=1))
        return 1 if self.wrong else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--programs", required=True)
    parser.add_argument("--kills", type=int, default=500)
    parser.add_argument("--minutes", type=float, default=60, help="at the longest")
    parser.add_argument("--corpus", help="folder of CL files; without it a part of its own")
    parser.add_argument("--folder", help="for parts; default: one that is deleted")
    parser.add_argument("--seed", type=int, default=20260412)
    parser.add_argument("--json")
    parser.add_argument("--keep", action="store_true")
    arguments = parser.parse_args()
    if arguments.folder:
        return Campaign(arguments).run()
    with tempfile.TemporaryDirectory(prefix="meridian-recovery-") as arguments.folder:
        return Campaign(arguments).run()


if __name__ == "__main__":
    sys.exit(main())
