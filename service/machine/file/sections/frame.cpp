// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "meridian/units.hpp"
#include "service/machine/file/machine_file.hpp"

namespace meridian::config {
namespace {

/// Sine and cosine of an angle in degrees; exact at multiples of 90.
std::array<double, 2> sin_cos_deg(double deg) {
  const double quarter = std::nearbyint(deg / 90.0);
  const double rest = units::rad_from_deg(deg - 90.0 * quarter);
  const double s = std::sin(rest), c = std::cos(rest);
  switch (((static_cast<int>(quarter) % 4) + 4) % 4) {
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    case 3:
      return {-c, s};
    default:
      return {s, c};
  }
}

[[noreturn]] void refuse(std::string_view text) {
  throw ConfigError({.file = "--frame",
                     .key = "frame",
                     .value = "\"" + std::string(text) + "\"",
                     .allowed = "x,y,z or x,y,z,a,b,c: mm within 1e5, deg within 360",
                     .remedy = "write numbers with commas between and no spaces, such as "
                               "--frame 0,0,120 or --frame 10,0,120,0,0,90"});
}

}  // namespace

Eigen::Matrix3d rotation_from_deg(double a_deg, double b_deg, double c_deg) {
  const auto [sa, ca] = sin_cos_deg(a_deg);
  const auto [sb, cb] = sin_cos_deg(b_deg);
  const auto [sc, cc] = sin_cos_deg(c_deg);
  const Eigen::Matrix3d x{{1, 0, 0}, {0, ca, -sa}, {0, sa, ca}};
  const Eigen::Matrix3d y{{cb, 0, sb}, {0, 1, 0}, {-sb, 0, cb}};
  const Eigen::Matrix3d z{{cc, -sc, 0}, {sc, cc, 0}, {0, 0, 1}};
  return z * y * x;
}

std::array<double, 6> parse_frame_values(std::string_view text) {
  std::array<double, 6> values{};
  std::size_t count = 0;
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  while (true) {
    if (count == values.size()) refuse(text);
    const auto [next, code] = std::from_chars(at, end, values[count]);
    const double max = count < 3 ? 1e5 : 360;
    if (code != std::errc{} || !(std::abs(values[count]) <= max)) refuse(text);
    ++count;
    if (next == end) break;
    if (*next != ',') refuse(text);
    at = next + 1;
  }
  if (count != 3 && count != 6) refuse(text);
  return values;
}

RigidTransform parse_frame(std::string_view text) {
  const std::array<double, 6> values = parse_frame_values(text);
  return {rotation_from_deg(values[3], values[4], values[5]), {values[0], values[1], values[2]}};
}

RigidTransform frame_of(const WorkFrame& row) {
  const auto [a, b, c] = row.rotation_deg;
  return {rotation_from_deg(a, b, c), to_vector(row.origin_mm)};
}

void place_workpiece(MachineModel& model, const RigidTransform& X_MW) { model.X_MW = X_MW; }

}  // namespace meridian::config
