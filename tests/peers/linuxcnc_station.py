#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""LinuxCNC's operator, in place of its screen: enables, homes, runs program.ngc of its folder and
keeps every servo period in samples.txt. LinuxCNC's start script runs it; exit code 1 says why."""
import pathlib
import subprocess
import sys
import time

import linuxcnc  # of linuxcnc-uspace

PATIENCE_S = 60


def wait(what, is_done):
    end = time.monotonic() + PATIENCE_S
    while not is_done():
        if time.monotonic() > end:
            sys.exit(f"LinuxCNC: no {what} after {PATIENCE_S} s")
        time.sleep(0.02)


class Station:
    def __init__(self):
        self.ask, self.status, self.errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()
        wait("status", self.is_heard)

    def is_heard(self):
        try:
            self.status.poll()
            return True
        except linuxcnc.error:
            return False

    def sees(self, test):
        def look():
            self.status.poll()
            return test(self.status)
        return look

    def enable(self):
        self.ask.state(linuxcnc.STATE_ESTOP_RESET)
        wait("reset", self.sees(lambda s: s.task_state == linuxcnc.STATE_ESTOP_RESET))
        self.ask.state(linuxcnc.STATE_ON)
        wait("drives", self.sees(lambda s: s.task_state == linuxcnc.STATE_ON))
        self.ask.mode(linuxcnc.MODE_MANUAL)
        self.ask.wait_complete(PATIENCE_S)
        self.ask.home(-1)
        wait("reference", self.sees(lambda s: all(s.homed[:5])))
        self.ask.teleop_enable(1)

    def run(self, program):
        self.ask.mode(linuxcnc.MODE_AUTO)
        self.ask.wait_complete(PATIENCE_S)
        self.ask.program_open(str(program))
        self.ask.auto(linuxcnc.AUTO_RUN, 0)
        wait("program", self.sees(lambda s: s.interp_state != linuxcnc.INTERP_IDLE))
        is_idle = self.sees(lambda s: s.interp_state == linuxcnc.INTERP_IDLE)
        while not is_idle():
            time.sleep(0.1)
        fault = self.errors.poll()
        if fault:
            sys.exit(f"LinuxCNC: {fault[1].strip()}")


def main():
    folder = pathlib.Path.cwd()
    station = Station()
    station.enable()
    with open(folder / "samples.txt", "w", encoding="ascii") as out:
        sampler = subprocess.Popen(["halsampler", "-t"], stdout=out)
        subprocess.run(["halcmd", "setp", "sampler.0.enable", "1"], check=True)
        station.run(folder / "program.ngc")
        time.sleep(1)  # halsampler looks every few milliseconds
        sampler.terminate()
        sampler.wait()


if __name__ == "__main__":
    main()
