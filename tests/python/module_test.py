# SPDX-License-Identifier: Apache-2.0
"""The Python module against the programs: the same numbers, bit for bit."""
import csv
import json
import math
import os
import subprocess
import tempfile
import unittest

import numpy as np

import meridian

SOURCE = os.environ["MERIDIAN_SOURCE_DIR"]
PROGRAM = os.environ["MERIDIAN_PROGRAM"]
MACHINES = os.path.join(SOURCE, "deploy", "machines")


def machine_file(name):
    return os.path.join(MACHINES, name + ".toml")


def run(*words):
    return subprocess.run([PROGRAM, *words], capture_output=True, text=True, check=False)


class Kinematics(unittest.TestCase):
    def test_forward_of_inverse_is_the_pose_on_every_shipped_machine(self):
        for name in sorted(os.listdir(MACHINES)):
            with self.subTest(name):
                machine = meridian.Machine(os.path.join(MACHINES, name))
                middle = machine.home + 0.05 * np.arange(1, len(machine.joint_names) + 1)
                joints = np.array([middle, middle + 0.01])
                poses = machine.forward(joints)
                again = machine.forward(machine.inverse(poses, near=middle))
                np.testing.assert_allclose(again, poses, atol=1e-9)

    def test_solutions_are_those_of_the_pose_command(self):
        machine = meridian.Machine(machine_file("lai"))
        pose = machine.forward([10, 20, 30, 0.4, 0.5])
        ran = run("pose", *(repr(float(x)) for x in pose), "--machine", machine_file("lai"),
                   "--json")
        self.assertEqual(ran.returncode, 0, ran.stderr)
        solutions = json.loads(ran.stdout)["solutions"]
        mine = machine.solutions(pose)
        self.assertEqual(len(solutions), len(mine))
        for theirs, solution in zip(solutions, mine):
            self.assertEqual(theirs["branch"], solution.branch)
            for joint, number in zip(theirs["joints"], solution.joints):
                wanted = number if joint["unit"] == "mm" else math.degrees(number)
                self.assertAlmostEqual(joint["value"], wanted, delta=1e-12 * (1 + abs(wanted)))
        self.assertTrue(any(np.allclose(s.joints, [10, 20, 30, 0.4, 0.5]) for s in mine))
        rows = machine.inverse([pose, pose])
        self.assertEqual(rows.shape, (2, 5))

    def test_a_pose_out_of_reach_is_no_number(self):
        machine = meridian.Machine(machine_file("robot-6r"))
        joints = machine.inverse([1e5, 0, 0, 0, 0, 1])
        self.assertTrue(np.isnan(joints).all())
        self.assertEqual(machine.solutions([1e5, 0, 0, 0, 0, 1]), [])

    def test_what_is_wrong_is_a_value_error_that_names_it(self):
        with self.assertRaisesRegex(ValueError, "nowhere.toml"):
            meridian.Machine("nowhere.toml")
        machine = meridian.Machine(machine_file("lai"))
        with self.assertRaisesRegex(ValueError, "5 numbers"):
            machine.forward([1, 2, 3])
        with self.assertRaisesRegex(ValueError, "length 2"):
            machine.inverse([0, 0, 0, 0, 0, 2])


class Simulated(unittest.TestCase):
    part = os.path.join(SOURCE, "deploy", "parts", "reference-patch.toml")

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.cl = os.path.join(self.folder.name, "part.apt")
        with open(self.cl, "w", encoding="ascii") as file:
            file.write("UNITS/MM\nMULTAX/ON\nFEDRAT/600,MMPM\n")
            for n in range(40):
                tilt = 0.3 * math.sin(n / 6)
                file.write(f"GOTO/{n:.3f},{5 * math.sin(n / 5):.3f},20,"
                           f"{math.sin(tilt):.9f},0,{math.cos(tilt):.9f}\n")
            file.write("FINI\n")

    def tearDown(self):
        self.folder.cleanup()

    def test_rows_are_those_of_the_recording_bit_for_bit(self):
        machine = meridian.Machine(machine_file("lai"))
        for transition in ("smooth", "exact_stop"):
            with self.subTest(transition):
                csv_file = os.path.join(self.folder.name, "run.csv")
                ran = run("simulate", self.cl, "--machine", machine_file("lai"), "--transition",
                           transition, "--record", csv_file)
                self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)
                mine = meridian.simulate(self.cl, machine, transition=transition)
                self.assertEqual(mine.outcome, "done", mine.reason)
                with open(csv_file, encoding="ascii") as file:
                    rows = list(csv.DictReader(file))
                self.assertEqual(len(rows), len(mine.cycles))
                names = [n for n in rows[0] if n.startswith(tuple(machine.joint_names))]
                for joint, name in enumerate(names[:len(machine.joint_names)]):
                    theirs = np.array([float(row[name]) for row in rows])
                    self.assertTrue((theirs == mine.joints[:, joint]).all(), name)
                self.assertEqual([row["kind"] for row in rows], mine.kinds)
                self.assertEqual([int(row["line"]) for row in rows], mine.lines.tolist())
                self.assertGreater(mine.program_s, 1)

    def test_a_file_that_cannot_run_is_refused_with_every_finding(self):
        with open(self.cl, "a", encoding="ascii") as file:
            file.write("GOTO/99999,0,0,0,0,1\n")
        bad = os.path.join(self.folder.name, "bad.apt")
        with open(bad, "w", encoding="ascii") as file:
            file.write("UNITS/MM\nMULTAX/ON\nFEDRAT/600,MMPM\nGOTO/0,0,0,0,0,1\n"
                       "GOTO/99999,0,0,0,0,1\nLOADTL/77\nGOTO/1,0,0,0,0,1\nFINI\n")
        with self.assertRaises(ValueError) as raised:
            meridian.simulate(bad, meridian.Machine(machine_file("lai")))
        self.assertRegex(str(raised.exception), "bad.apt")
        self.assertRegex(str(raised.exception), "5")
        self.assertRegex(str(raised.exception), "77")

    def test_arrays_outlive_the_run_and_cannot_be_written_to(self):
        joints = meridian.simulate(self.cl, meridian.Machine(machine_file("lai"))).joints
        self.assertEqual(joints.shape[1], 5)
        self.assertTrue(np.isfinite(joints).all())
        with self.assertRaises(ValueError):
            joints[0, 0] = 1


if __name__ == "__main__":
    unittest.main()
