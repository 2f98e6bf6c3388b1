// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdio>
#include <random>
#include <string>

namespace meridian::test {

/// Six cuts about a place of the table, the axis tilted by up to 40 degrees.
[[nodiscard]] inline std::string drawn_program(std::mt19937_64& engine) {
  std::uniform_real_distribution<double> place(-80, 80), tilt(0, 0.7), around(-3.1, 3.1);
  std::string text = "PARTNO LIMITS\nUNITS/MM\nFEDRAT/20000,MMPM\n";
  for (int block = 0; block < 6; ++block) {
    const double t = tilt(engine), a = around(engine);
    char line[160];
    std::snprintf(line, sizeof line, "GOTO/%.4f,%.4f,%.4f,%.6f,%.6f,%.6f\n", place(engine),
                  place(engine), place(engine) / 4, std::sin(t) * std::cos(a),
                  std::sin(t) * std::sin(a), std::cos(t));
    text += line;
  }
  return text + "FINI\n";
}

}  // namespace meridian::test
