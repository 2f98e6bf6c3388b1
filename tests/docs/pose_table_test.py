# SPDX-License-Identifier: Apache-2.0
"""pose_table_test.py SOURCE BIN: the joints of docs/surface.md are what `meridian pose` prints for its poses."""
import csv
import pathlib
import re
import subprocess
import sys
import tempfile

source, bin_folder = map(pathlib.Path, sys.argv[1:3])
page = (source / "docs/surface.md").read_text()
poses = re.search(r"^x_mm,.*?(?=^```)", page, re.M | re.S).group()
wanted = [[float(cell) for cell in row.split("|")[2:-1]]
          for row in re.search(r"^\| contact \| yaw .*?(?=\n\n)", page, re.M | re.S).group().splitlines()[2:]]
with tempfile.NamedTemporaryFile("w", suffix=".csv") as table:
    table.write(poses)
    table.flush()
    printed = subprocess.run(
        [bin_folder / "meridian", "pose", "--machine", source / "deploy/machines/robot-5r.toml", "--frame", "0,0,0",
         "--pose-table", table.name], check=True, capture_output=True, text=True).stdout
inside = [row for row in csv.DictReader(printed.splitlines()) if row["outside_travel"] == "no"]
assert len(inside) == len(wanted) == 5, printed
for row, joints in zip(inside, wanted):
    for name, joint in zip(("yaw_deg", "shoulder_deg", "elbow_deg", "pitch_deg", "tilt_deg"), joints):
        assert abs(float(row[name]) - joint) <= 0.0005001, f"{name}: {row[name]}, the page says {joint}"
