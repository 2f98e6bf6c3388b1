// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "meridian/geometry/vector3.hpp"

/// What pictures of machines share: points as gnuplot reads them, and four views of a cube.
namespace meridian::inspect {

/// "x y z", mm.
void print_point(std::FILE* out, const Vector3& p);

/// A gap in a line of print_block().
[[nodiscard]] Vector3 gap_of_block();

/// A data block `name`; a point that is no number is a gap. Never empty.
void print_block(std::FILE* out, const std::string& name, const std::vector<Vector3>& points);

/// Which coordinates a view shows.
struct View {
  bool is_in_space = true;
  int across = 0, up = 1;  ///< of a view that is not in space: x 0, y 1, z 2

  /// Columns of a point ("1:2:3"), and of an arrow: a point and a vector.
  [[nodiscard]] std::string points() const;
  [[nodiscard]] std::string vectors() const;
};

/// The cube about `middle` in space, from the front, the side and the top. `plot` gives the command
/// for each, which begins with its `verb`.
void print_four_views(std::FILE* out, const Vector3& middle, double half,
                      const std::function<std::string(const char* verb, const View& view)>& plot);

}  // namespace meridian::inspect
