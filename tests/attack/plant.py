# SPDX-License-Identifier: Apache-2.0
"""Service, drives, station and the honest operator as processes, in a DDS domain of their own."""
import fcntl
import json
import os
import pathlib
import queue
import re
import shutil
import signal
import subprocess
import tempfile
import threading
import time

STATES = ("Off Enabling Ready Loaded Approaching Running Holding Held Starving Starved Aborting "
          "Disabling FaultStop Fault Jogging Homing Stepping").split()
VERBS = ("enable disable start hold resume abort reset feed_override rapid_override jog home "
         "single_block optional_stop dry_run").split()
SOURCE = pathlib.Path(__file__).resolve().parents[2]


class Domain:
    """A DDS domain that no other test of this host uses (service/host/process/claimed_domain.hpp)."""

    def __init__(self):
        for i in range(121):
            number = 100 + (os.getpid() + i) % 121
            file = os.open(f"/tmp/meridian-test-domain-{number}", os.O_RDONLY | os.O_CREAT, 0o644)
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                os.close(file)
                continue
            self.number, self.file = number, file
            return
        raise RuntimeError("no DDS domain is free")

    def close(self):
        os.close(self.file)


def wait_until(condition, patience_s):
    end = time.monotonic() + patience_s
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(0.002)
    return condition()


class Operator:
    """The honest operator's process (operator.cpp): writes it lines, keeps what it says."""

    def __init__(self, command):
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        text=True, bufsize=1)
        self.state, self.epoch, self.alarm, self.line, self.session = None, None, 0, 0, 0
        self.replies, self.measured, self.reports = {}, queue.Queue(), queue.Queue()
        self.said = queue.Queue()
        self.reader = threading.Thread(target=self._read, daemon=True)
        self.reader.start()

    def _read(self):
        for text in self.process.stdout:
            said = json.loads(text)
            if "state" in said and "epoch" in said:
                self.epoch, self.alarm, self.line = said["epoch"], said["alarm"], said["line"]
                self.session = said["session"]
                self.state = STATES[said["state"]]
            elif "reply" in said:
                self.replies[said["reply"]] = said
            elif "said" in said:
                self.said.put(said["request"])
            elif "measured" in said:
                self.measured.put(said)
            elif "report" in said:
                self.reports.put(said)

    def write(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def say(self, verb, argument=0, patience_s=1.0):
        """Says it once; whether it was accepted (None: no reply)."""
        self.write(f"say {VERBS.index(verb)} {argument}")
        request = self.said.get(timeout=5)
        wait_until(lambda: request in self.replies, patience_s)
        reply = self.replies.get(request)
        return None if reply is None else reply["accepted"] == 1 and \
            reply["verb"] == VERBS.index(verb)

    def must(self, verb, then, argument=0, patience_s=8.0):
        """Says it until the machine is in one of the states `then`."""
        end = time.monotonic() + patience_s
        while time.monotonic() < end:
            self.say(verb, argument, 0.3)
            if wait_until(lambda: self.state in then, 0.3):
                return True
        return False

    def stop(self, verb, limit_ms, cruise=False):
        """Says a stop, and measures it."""
        self.write(f"stop {VERBS.index(verb)} {limit_ms}" + (" cruise" if cruise else ""))
        return self.measured.get(timeout=limit_ms / 1000 + 10)

    def report(self):
        self.write("report")
        return self.reports.get(timeout=10)

    def close(self):
        try:
            self.process.stdin.close()
            self.process.wait(3)
        except (OSError, subprocess.TimeoutExpired):
            self.process.kill()
            self.process.wait()


class Plant:
    def __init__(self, programs, machine="lai", settings="", cycle_us=1000, drives=(),
                 keep_logs=False):
        self.programs = pathlib.Path(programs)
        self.domain = Domain()
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="meridian-attack-"))
        self.machine, self.keep_logs = machine, keep_logs
        text = (SOURCE / f"deploy/machines/{machine}.toml").read_text()
        for pattern, value in ((r"approach_feed_mm_per_min = \d+", "approach_feed_mm_per_min = 12000"),
                               (r"clearance_mm = \d+", "clearance_mm = 5"),
                               (r"cycle_us = \d+", f"cycle_us = {cycle_us}")):
            text = re.sub(pattern, value, text)
        self.machine_file = self.folder / "machine.toml"
        self.machine_file.write_text(text)
        bridge = 100_000 // cycle_us if "bridge_cycles" not in settings else None
        self.service_file = self.folder / "service.toml"
        self.service_file.write_text(
            f'[service]\nmachine = "{self.machine_file}"\nfeedback_timeout_s = 0.3\n'
            + (f"bridge_cycles = {bridge}\n" if bridge else "") + settings)
        self.drives_words = list(drives)
        self.service = self.drives = self.station = self.operator = None
        self.others = []
        self.runs = 0

    # ---- processes
    def start(self, words, log, **more):
        out = open(self.folder / log, "ab")
        more.setdefault("stdout", out)
        more.setdefault("stderr", out)
        more.setdefault("stdin", subprocess.DEVNULL)
        process = subprocess.Popen([str(w) for w in words], **more)
        out.close()
        return process

    def start_service(self, words=(), record=True, **more):
        self.runs += 1
        self.recording = self.folder / f"run{self.runs}.csv"
        record_words = ["--record", self.recording] if record else []
        self.service = self.start(
            [self.programs / "meridiand", "--service", self.service_file, "--domain",
             self.domain.number, "--state", self.folder / "state", "--best-effort",
             *record_words, *words], "service.log", **more)
        return self.service

    def start_drives(self, words=()):
        self.drives = self.start(
            [self.programs / "meridian", "drives", "--machine", self.machine_file, "--domain",
             self.domain.number, "--console", *self.drives_words, *words], "drives.log",
            stdin=subprocess.PIPE)
        return self.drives

    def inject(self, line):
        self.drives.stdin.write(line.encode() + b"\n")
        self.drives.stdin.flush()

    def start_operator(self, words=()):
        if self.operator:
            self.operator.close()
        self.operator = Operator(
            [str(w) for w in (self.programs / "attacker", "operate", "--domain", self.domain.number,
                              "--machine", self.machine, "--for", 3600, "--service-process",
                              self.service.pid, "--drives-process", self.drives.pid, *words)])
        return self.operator

    def start_station(self, part, words=()):
        if self.station and self.station.poll() is None:
            self.station.send_signal(signal.SIGCONT)
            self.station.kill()
        self.station = self.start(
            [self.programs / "meridian", "stream", part, "--domain", self.domain.number,
             "--machine-name", self.machine, "--wait-end", *words], "station.log")
        return self.station

    def attack(self, *words, seed=1, **more):
        """Starts an attacker of the domain; it ends with the plant at the latest."""
        process = self.start(
            [self.programs / "attacker", words[0], "--domain", self.domain.number, "--machine",
             self.machine, "--seed", seed, *words[1:]], "attackers.log", **more)
        self.others.append(process)
        return process

    # ---- what an operator does
    def enable(self, patience_s=12):
        end = time.monotonic() + patience_s
        while time.monotonic() < end:
            if self.operator.state == "Ready":
                return True
            # Drives that a service left in fault are reset in Off too.
            if self.operator.state == "Fault" or self.operator.say("enable", 0, 0.3) is False:
                self.operator.say("reset", 0, 0.8)
                continue
            if wait_until(lambda: self.operator.state == "Ready", 0.5):
                return True
        return False

    def load(self, part, words=(), patience_s=12):
        end = time.monotonic() + patience_s
        while time.monotonic() < end:
            station = self.start_station(part, words)
            if wait_until(lambda: self.operator.state == "Loaded" or station.poll() is not None, 4) \
                    and self.operator.state == "Loaded":
                return True
        return False

    def run(self, part, words=(), patience_s=20):
        return self.load(part, words, patience_s) and \
            self.operator.must("start", ("Approaching", "Running"))

    # ---- end
    def stop_others(self):
        for process in self.others:
            if process.poll() is None:
                process.send_signal(signal.SIGCONT)
                process.kill()
            process.wait()
        self.others = []

    def stop_service(self, patience_s=8):
        """In order, so that the recording is whole."""
        if self.service is None or self.service.poll() is not None:
            return
        self.service.send_signal(signal.SIGCONT)
        self.service.terminate()
        try:
            self.service.wait(patience_s)
        except subprocess.TimeoutExpired:
            self.service.kill()
            self.service.wait()

    def log(self, name="service.log"):
        file = self.folder / name
        return file.read_text(errors="replace") if file.exists() else ""

    def close(self):
        self.stop_others()
        if self.operator:
            self.operator.close()
        self.stop_service()
        for process in (self.station, self.drives):
            if process and process.poll() is None:
                process.send_signal(signal.SIGCONT)
                process.kill()
                process.wait()
        self.domain.close()
        if not self.keep_logs:
            shutil.rmtree(self.folder, ignore_errors=True)
