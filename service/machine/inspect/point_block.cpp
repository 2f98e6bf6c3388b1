// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/point_block.hpp"

#include <limits>

namespace meridian::inspect {

void print_point(std::FILE* out, const Vector3& p) {
  std::fprintf(out, "%.6g %.6g %.6g", p[0], p[1], p[2]);
}

Vector3 gap_of_block() { return Vector3::Constant(std::numeric_limits<double>::quiet_NaN()); }

void print_block(std::FILE* out, const std::string& name, const std::vector<Vector3>& points) {
  std::fprintf(out, "$%s << EOD\n", name.c_str());
  for (const Vector3& p : points) {
    if (p.allFinite()) print_point(out, p);
    std::fputs(p.allFinite() ? "\n" : "\n\n", out);  // one blank line would weave a surface
  }
  std::fputs(points.empty() ? "NaN NaN NaN\nEOD\n" : "EOD\n", out);
}

std::string View::points() const {
  return is_in_space ? "1:2:3" : std::to_string(across + 1) + ":" + std::to_string(up + 1);
}

std::string View::vectors() const {
  if (is_in_space) return "1:2:3:4:5:6";
  return points() + ":" + std::to_string(across + 4) + ":" + std::to_string(up + 4);
}

void print_four_views(std::FILE* out, const Vector3& middle, double half,
                      const std::function<std::string(const char* verb, const View& view)>& plot) {
  const auto range = [&](char name, int axis) {
    std::fprintf(out, "set %crange [%.6g:%.6g]\n", name, middle[axis] - half, middle[axis] + half);
  };
  for (int i = 0; i < 3; ++i) range("xyz"[i], i);
  std::fputs(
      "set origin 0.11,0.5\nset size 0.4,0.46\nset view equal xyz\nset view 65,30,1.5\n"
      "set xyplane relative 0\nset key at screen 0.01,0.96 left top samplen 2\n"
      "set xlabel 'x'\nset ylabel 'y'\nset zlabel 'z'\n",
      out);
  std::fputs(plot("splot", View{}).c_str(), out);
  std::fputs("unset key\nset size ratio -1\nset grid lc '#e4e4e4'\n", out);
  struct Sheet {
    const char *title, *position;
    View view;
  };
  constexpr Sheet kSheets[] = {{"front", "0.5,0.49", {false, 0, 2}},
                               {"side", "0.5,0.0", {false, 1, 2}},
                               {"top", "0.0,0.0", {false, 0, 1}}};
  for (const auto& [title, position, view] : kSheets) {
    std::fprintf(out,
                 "set origin %s\nset size 0.49,0.47\nset title '%s'\nset xlabel '%c, mm'\n"
                 "set ylabel '%c, mm'\n",
                 position, title, "xyz"[view.across], "xyz"[view.up]);
    range('x', view.across);
    range('y', view.up);
    std::fputs(plot("plot", view).c_str(), out);
  }
}

}  // namespace meridian::inspect
