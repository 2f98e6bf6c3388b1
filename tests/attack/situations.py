# SPDX-License-Identifier: Apache-2.0
"""What the machine does when it is to be stopped, and the stops that are measured in it."""
import math
import time

from plant import wait_until

LIMIT_MS = 3000  # what is not obeyed within it counts as not obeyed
STOPPED = {"hold": ("holding", "held", "aborting", "ready"), "abort": ("aborting", "ready")}


def write_parts(folder):
    """Long straight cuts with a leaning tool axis, so that the joints' speed is constant between
    corners; and short ones with a tool change between them. Both for the machine lai."""
    axis = f"{math.sin(math.radians(10)):.12f},0,{math.cos(math.radians(10)):.12f}"
    head = ["PARTNO ATTACKED", "UNITS/MM", "SPINDL/8000,RPM,CLW", "FEDRAT/3000,MMPM"]
    long_cuts, tools = list(head), list(head) + ["LOADTL/1"]
    for n in range(400):
        x = 250 if n % 2 else -250
        long_cuts += [f"GOTO/{x},{-60 + n * 0.2:.3f},150,{axis}",
                      f"GOTO/{x},{-60 + (n + 1) * 0.2:.3f},150,{axis}"]
    for n in range(300):
        tools += [f"GOTO/{n % 10},{-60 + n % 7},150,{axis}", f"LOADTL/{2 if n % 2 == 0 else 1}"]
    for name, lines in (("long.cls", long_cuts), ("tools.cls", tools)):
        (folder / name).write_text("\n".join(lines + ["FINI"]) + "\n")


class Situations:
    """Each function measures stops until its time is over, and adds them to `samples`."""

    def __init__(self, plant, draw):
        self.plant, self.draw, self.samples = plant, draw, []
        self.op = plant.operator
        self.failed = []  # what could not be brought about
        self.is_reusing = False

    # ---- to a state
    def to_cut(self, part, fresh=False):
        op, end = self.op, time.monotonic() + 15
        while time.monotonic() < end:
            if op.state in ("Running", "Approaching"):
                return True
            if op.state in ("Held", "Starved", "Stepping"):
                op.must("resume", ("Running",), patience_s=1.5)
            elif op.state in ("Ready",):
                self.plant.run(part, patience_s=8)
            elif op.state == "Loaded":
                op.must("start", ("Approaching", "Running"), patience_s=1.5)
            elif op.state in ("Off", "Fault"):
                self.plant.enable(6)
            else:
                time.sleep(0.01)
        self.failed.append(f"no cut: {op.state}")
        return False

    def to_ready(self):
        op, end = self.op, time.monotonic() + 12
        while time.monotonic() < end:
            if op.state == "Ready":
                return True
            if op.state in ("Off", "Fault"):
                self.plant.enable(6)
            elif op.state in ("Running", "Approaching", "Held", "Loaded", "Starved", "Jogging",
                              "Homing", "Starving", "Holding", "Stepping"):
                op.must("abort", ("Ready", "Aborting"), patience_s=2)
            else:
                time.sleep(0.01)
        self.failed.append(f"not ready: {op.state}")
        return False

    def stop(self, situation, verb, cruise=False):
        if self.is_reusing:
            self.op.write("renumber 1")
        one = self.op.stop(verb, LIMIT_MS, cruise)
        if self.is_reusing:  # what is no stop is not said twice
            self.op.write(f"renumber {1000 * (len(self.samples) + 1)}")
        one.update(situation=situation, verb=verb)
        self.samples.append(one)
        return one

    # ---- situations
    def cut_hold(self, until):
        part, n = self.plant.folder / "long.cls", 0
        while time.monotonic() < until and self.to_cut(part):
            time.sleep(self.draw.uniform(0.05, 0.15))
            # A resume takes a second to full feed: every fourth stop comes after it, where the
            # wire alone shows when the machine slows down.
            self.stop("cutting", "hold", cruise=n % 4 == 0)
            n += 1
            wait_until(lambda: self.op.state in ("Held", "Fault", "Ready"), 2)

    def cut_abort(self, until):
        part = self.plant.folder / "long.cls"
        while time.monotonic() < until and self.to_cut(part):
            time.sleep(self.draw.uniform(0.02, 0.08))
            self.stop("cutting", "abort", cruise=True)
            wait_until(lambda: self.op.state in ("Ready", "Fault"), 2)

    def hold_abort(self, until):
        """An abort while the machine decelerates for a hold."""
        part = self.plant.folder / "long.cls"
        while time.monotonic() < until and self.to_cut(part):
            time.sleep(0.3)
            self.op.write("say 3")
            time.sleep(self.draw.uniform(0.001, 0.04))
            self.stop("holding", "abort")
            wait_until(lambda: self.op.state in ("Ready", "Fault"), 2)

    def jog(self, until):
        n = 0
        while time.monotonic() < until and self.to_ready():
            n += 1
            if not self.op.must("jog", ("Jogging",), 0, 2):
                self.failed.append("no jog")
                continue
            self.op.write(f"jog 0 {40 if n % 2 else -40}")
            time.sleep(self.draw.uniform(0.25, 0.35))
            self.stop("jogging", "hold" if n % 4 < 2 else "abort", cruise=True)
            self.op.write("letgo")
            wait_until(lambda: self.op.state in ("Ready", "Fault"), 2)

    def change_tools(self, until):
        part = self.plant.folder / "tools.cls"
        log = self.plant.folder / "drives.log"
        begun = True
        while time.monotonic() < until and begun:
            if self.op.state not in ("Running", "Approaching", "Held"):
                if not self.to_ready():
                    return
            size = log.stat().st_size if log.exists() else 0
            begun = self.to_cut(part)
            is_changing = wait_until(
                lambda: b"tool" in log.read_bytes()[size:] or self.op.state != "Running", 3)
            if not is_changing:
                continue
            time.sleep(self.draw.uniform(0.01, 0.15))
            self.stop("tool change", "hold")
            wait_until(lambda: self.op.state in ("Held", "Fault"), 2)

    def home(self, until):
        """The last: joints that were broken off have no reference."""
        n = 0
        while time.monotonic() < until and self.to_ready():
            n += 1
            if not self.op.must("home", ("Homing",), 0, 2):
                self.failed.append("no homing")
                continue
            time.sleep(self.draw.uniform(0.05, 0.3))
            self.stop("homing", "hold" if n % 2 else "abort")
            wait_until(lambda: self.op.state in ("Ready", "Fault"), 3)

    def rest(self, until):
        """Ready, Off and Fault for a while each: nothing may move, and drives are off."""
        op = self.op
        if self.to_cut(self.plant.folder / "long.cls"):
            self.plant.inject("emergency")
            if not wait_until(lambda: op.state == "Fault", 3):
                self.failed.append(f"no Fault at a stop input: {op.state}")
            time.sleep(0.6)
            self.plant.inject("mend")
            self.plant.enable(6)
        if self.to_ready():
            time.sleep(max(0.8, min(2.0, (until - time.monotonic()) / 3)))
            for _ in range(2):
                op.must("disable", ("Off",), patience_s=2)
                time.sleep(0.5)
                self.plant.enable(6)


# name, share of the time
ALL = (("cut_hold", 0.42), ("cut_abort", 0.14), ("hold_abort", 0.1), ("jog", 0.12),
       ("change_tools", 0.1), ("rest", 0.05), ("home", 0.07))
