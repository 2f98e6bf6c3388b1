# SPDX-License-Identifier: Apache-2.0
"""What a CL file holds by plain text matching, without Meridian's reader.

  extract_cl.py FILE -> "goto3 goto6 circles xmin xmax ymin ymax zmin zmax" of its GOTO points, one line
"""
import re
import sys

text = open(sys.argv[1], encoding="latin-1").read().replace("\r", "")
text = re.sub(r"\$[ \t]*\n", " ", text)  # continuation
number = r"[-+]?(?:\d+\.?\d*|\.\d+)"
counts = {3: 0, 6: 0}
points = []
for arguments in re.findall(r"^\s*GOTO\s*/(.*)$", text, re.MULTILINE):
    values = [float(x) for x in re.findall(number, arguments)]
    counts[len(values)] += 1
    points.append(values[:3])
circles = len(re.findall(r"^\s*CIRCLE\s*/", text, re.MULTILINE))
box = [f(p[i] for p in points) for i in range(3) for f in (min, max)]
print(counts[3], counts[6], circles, *(repr(x) for x in box))
