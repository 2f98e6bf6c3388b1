# SPDX-License-Identifier: Apache-2.0
"""A trunnion table (C on B) as a LinuxCNC configuration: its own kinematics module, the limits of a
Meridian machine file, simulated drives, every joint command sampled in the servo thread.

LinuxCNC has X, Y, Z, B, C: the tip where tool and table stand at home, mm, and degrees. The machine
file counts X, Y, Z, C, B of the slides; `columns` turns the one into the other.
"""
import math
import pathlib
import shutil
import tomllib

JOINTS = "XYZBC"  # LinuxCNC's joints, in its order
STATION = pathlib.Path(__file__).resolve().parent / "linuxcnc_station.py"

HAL = """loadrt [KINS]KINEMATICS
loadrt motmod servo_period_nsec=1000000 num_joints=5 num_dio=1
loadrt limit3 names=drive-0,drive-1,drive-2,drive-3,drive-4
loadrt sampler depth=60000 cfg=fffffb
addf motion-command-handler servo-thread
addf motion-controller servo-thread
addf sampler.0 servo-thread
setp xyzbc-trt-kins.z-offset {pivot_mm}
net ready iocontrol.0.user-enable-out iocontrol.0.emc-enable-in
net prepare iocontrol.0.tool-prepare iocontrol.0.tool-prepared
net change iocontrol.0.tool-change iocontrol.0.tool-changed
net begun motion.digital-out-00 => sampler.0.pin.5
setp sampler.0.enable 0
"""

DRIVES = {
    "perfect": """net at-{n} joint.{n}.motor-pos-cmd => joint.{n}.motor-pos-fb sampler.0.pin.{n}
""",
    "real": """setp drive-{n}.maxv {maxv}
setp drive-{n}.maxa {maxa}
addf drive-{n} servo-thread
net to-{n} joint.{n}.motor-pos-cmd => drive-{n}.in sampler.0.pin.{n}
net at-{n} drive-{n}.out => joint.{n}.motor-pos-fb
"""}

INI = """[EMC]
VERSION = 1.1
MACHINE = {name}
[DISPLAY]
DISPLAY = ./linuxcnc_station.py
[KINS]
KINEMATICS = xyzbc-trt-kins
JOINTS = 5
[HAL]
HALFILE = machine.hal
[TRAJ]
COORDINATES = XYZBC
LINEAR_UNITS = mm
ANGULAR_UNITS = deg
MAX_LINEAR_VELOCITY = {fastest}
DEFAULT_LINEAR_VELOCITY = {fastest}
[EMCMOT]
EMCMOT = motmod
SERVO_PERIOD = 1000000
COMM_TIMEOUT = 10
[RS274NGC]
PARAMETER_FILE = machine.var
[TASK]
TASK = milltask
CYCLE_TIME = 0.001
[EMCIO]
EMCIO = io
CYCLE_TIME = 0.1
TOOL_TABLE = machine.tbl
"""

SECTION = """MAX_VELOCITY = {velocity}
MAX_ACCELERATION = {acceleration}
MIN_LIMIT = -36000
MAX_LIMIT = 36000
"""


class Machine:
    """What both controls know of the machine. Only tables with C on B about y, tool along z."""

    def __init__(self, file):
        with open(file, "rb") as text:
            self.table = tomllib.load(text)
        kinematics = self.table["kinematics"]
        if kinematics.get("chain") != ["C", "B", "Y", "X", "Z"]:
            raise SystemExit(f"{file}: LinuxCNC's xyzbc-trt-kins moves a table with C on B")
        self.name = self.table["machine"]["name"]
        self.pivot_mm = self.table["joints"]["B"]["point_mm"][2]
        self.tip_at_home_mm = kinematics["gauge_mm"][2] - self.table["machine"]["tool_length_mm"]

    def limits(self, joint):
        """Velocity, acceleration and jerk in mm or degrees and s."""
        row = self.table["joints"][joint]
        unit = "mm" if joint in "XYZ" else "deg"
        return tuple(row[f"{what}_{unit}_per_s{power}"] for what, power in
                     (("velocity", ""), ("acceleration", 2), ("jerk", 3)))

    def following_error(self, joint):
        row = self.table["joints"][joint]
        return row["following_error_mm" if joint in "XYZ" else "following_error_deg"]

    def columns(self, joints):
        """Columns of a recording of Meridian from LinuxCNC's five joints."""
        x, y, z, b, c = joints
        return x, -y, z - self.tip_at_home_mm, math.radians(c), math.radians(b)

    def write(self, folder, drives):
        """machine.ini, machine.hal and the files beside them. Drives that are "perfect" are where they
        are sent; "real" ones keep the joints' limits, and LinuxCNC stops at the following error."""
        hal = HAL.format(pivot_mm=self.pivot_mm)
        for n, joint in enumerate(JOINTS):
            maxv, maxa, _ = self.limits(joint)
            hal += DRIVES[drives].format(n=n, maxv=maxv, maxa=maxa)
        shutil.copy(STATION, folder)
        (folder / "machine.hal").write_text(hal)
        (folder / "machine.tbl").write_text("T1 P1 Z0 ;\n")
        (folder / "machine.var").write_text("")
        ini = INI.format(name=self.name, fastest=self.limits("X")[0])
        for n, joint in enumerate(JOINTS):
            velocity, acceleration, _ = self.limits(joint)
            limits = SECTION.format(velocity=velocity, acceleration=acceleration)
            ini += f"[AXIS_{joint}]\n{limits}[JOINT_{n}]\n{limits}"
            ini += f"TYPE = {'LINEAR' if joint in 'XYZ' else 'ANGULAR'}\nHOME = 0\n"
            error = self.following_error(joint)
            ini += f"HOME_SEARCH_VEL = 0\nHOME_SEQUENCE = 0\nFERROR = {error}\nMIN_FERROR = {error}\n"
        (folder / "machine.ini").write_text(ini)
