#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The shortest path, end to end: peers_test.py MERIDIAN ours|linuxcnc. Exit code 77: what it needs is
not there. LinuxCNC's time is counted in its servo periods, so a busy host does not change it."""
import json
import pathlib
import subprocess
import sys
import tempfile
import xml.dom.minidom

try:
    import numpy  # of python3-numpy; figures.py needs it
except ImportError:
    print("python3-numpy is not there")
    sys.exit(77)

import figures
import linuxcnc_cut
import pictures
from linuxcnc_machine import Machine

HERE = pathlib.Path(__file__).resolve().parent
MACHINE = HERE.parents[1] / "deploy/machines/trunnion-bc.toml"
PATH = "fan"  # 100 mm straight at 50 mm/s, B from -30 to 30 degrees


def expect(what, value, low, high):
    if not low <= value <= high:
        sys.exit(f"{what}: {value}, expected {low} to {high}")


def expect_fan(found, slowest_s):
    expect("time, s", found.time_s, 2.0, slowest_s)
    expect("tip, um", found.tip_um, 0, 0.1)
    expect("axis, deg", found.axis_deg, 0, 0.01)
    expect("velocity of B", found.shares["B"][0], 0.49, 0.51)  # 60 degrees in 2 s, of 60 a second
    expect("velocity of C", found.shares["C"][0], 0, 0)


def expect_what_check_says(meridian, found, recording, file):
    """Compared is what holds of the cut alone. `check` weighs tip and axis against each other to find the
    nearest point of the path, figures.py takes the tip's: the axis differs a little."""
    said = json.loads(subprocess.run([meridian, "check", "--json", recording, file, "--machine", MACHINE],
                                     capture_output=True, text=True, check=False).stdout)
    expect("time beside check", found.time_s, said["cut_s"] - 0.002, said["cut_s"] + 0.002)
    axis_deg = said["axis_deg"]["value"]
    expect("axis beside check", found.axis_deg, 0.9 * axis_deg - 1e-5, 1.2 * axis_deg + 1e-5)
    return {joint["name"]: joint for joint in said["joints"]}


def main():
    meridian, which = sys.argv[1:3]
    machine = Machine(MACHINE)
    with tempfile.TemporaryDirectory(prefix="peers-") as name:
        folder = pathlib.Path(name)
        subprocess.run([meridian, "bench", PATH, "--pole-policy", "ease", "--machine", MACHINE,
                        "--write", folder], check=True, stdout=subprocess.DEVNULL)
        file, recording = folder / f"{PATH}.apt", folder / f"{PATH}.csv"
        points = linuxcnc_cut.points_of(meridian, file)
        ours = figures.read(recording)
        if which == "ours":
            found = figures.check(machine, points, ours)
            expect_fan(found, 2.3)
            expect_what_check_says(meridian, found, recording, file)
            off = numpy.array(points) + [0, 0, 0.05, 0, 0, 0, 0]
            expect("tip beside a path 50 um higher", figures.check(machine, off, ours).tip_um, 49, 51)
            return
        recording = folder / "linuxcnc.csv"
        cut = subprocess.run([HERE / "linuxcnc_cut.py", meridian, MACHINE, file, recording], check=False)
        if cut.returncode:
            sys.exit(cut.returncode)
        theirs = figures.read(recording)
        found = figures.check(machine, points, theirs)
        expect_fan(found, 2.2)
        for joint, said in expect_what_check_says(meridian, found, recording, file).items():
            velocity = said["velocity_use"]  # there is no approach in this one
            expect(f"velocity of {joint} beside check", found.shares[joint][0] - velocity, -1e-3, 1e-3)
        expect("where both begin, mm and rad", abs(ours[0] - theirs[0]).max(), 0, 1e-5)
        pictures.draw(folder / "fan.svg", PATH, machine, [("Meridian", ours), ("LinuxCNC", theirs)])
        drawn = xml.dom.minidom.parse(str(folder / "fan.svg")).getElementsByTagName("polyline")
        expect("curves", len(drawn), 10, 10)


if __name__ == "__main__":
    main()
