// SPDX-License-Identifier: Apache-2.0
// G68.2: a tilted plane by angles, by three points or by two vectors.
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "service/programs/nc/state.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

constexpr const char* kByEuler = "output G68.2 with X Y Z and the angles I J K, without P";
constexpr double kApart_mm = 1e-3;  ///< points that are nearer have no direction between them

using Form = Expected<cl::Frame, cl::Refusal>;

double number_of(const Line& line, std::string_view address) {
  const Word* const word = line.find(address);
  return word == nullptr ? 0 : word->number;
}

Vector3 point_of(const Line& line) {
  return {number_of(line, "X"), number_of(line, "Y"), number_of(line, "Z")};
}

Vector3 vector_of(const Line& line) {
  return {number_of(line, "I"), number_of(line, "J"), number_of(line, "K")};
}

/// Turns about z by I, about the new x by J, about the new z by K.
Form by_euler_angles(const Line& line) {
  if (const Word* const q = line.find("Q"); q != nullptr && q->number != 313) {
    return refuse("G68.2 with Q" + std::string(q->digits) + ": angles about other axes than Z X Z",
                  kByEuler, "G68.2 Q");
  }
  const Vector3 deg = vector_of(line);
  return cl::compose(moved_by(point_of(line)), turned({{2, deg[0]}, {0, deg[1]}, {2, deg[2]}}));
}

/// The digits of Q are the axes in the order of their turns: Q123, as controls have it without Q.
Expected<std::array<std::size_t, 3>, cl::Refusal> order_of(const Line& line) {
  const Word* const q = line.find("Q");
  const std::string_view digits = q == nullptr ? std::string_view("123") : q->digits;
  std::array<std::size_t, 3> order{};
  std::array<bool, 3> seen{};
  for (std::size_t k = 0; k < order.size(); ++k) {
    const char c = digits.size() >= order.size() ? digits[k] : '0';
    const bool is_axis = c >= '1' && c <= '3' && !seen[static_cast<std::size_t>(c - '1')];
    if (!is_axis || digits.find_first_not_of("123.") != std::string_view::npos) {
      return refuse("G68.2 P1 with Q" + std::string(digits) + ", which is no order of three axes",
                    "Q123 or another order of 1, 2 and 3", "G68.2 Q");
    }
    order[k] = static_cast<std::size_t>(c - '1');
    seen[order[k]] = true;
  }
  return order;
}

/// Roll I about X, pitch J about Y, yaw K about Z in the order of Q. Whether the second and the
/// third turn are about the axes of the work or about those that the turn before has left differs
/// between controls: both have to give the same.
Form by_roll_pitch_yaw(const Line& line) {
  const auto order = order_of(line);
  if (!order) return tl::make_unexpected(order.error());
  const Vector3 deg = vector_of(line);
  const auto turn = [&](std::size_t k) {
    return Turn{(*order)[k], deg[static_cast<Eigen::Index>((*order)[k])]};
  };
  const cl::Frame moving = turned({turn(0), turn(1), turn(2)});
  const cl::Frame fixed = turned({turn(2), turn(1), turn(0)});
  if (!moving.rotation.isApprox(fixed.rotation, 1e-9)) {
    return refuse(
        "G68.2 P1 about more than one axis: whether the later turns are about the axes of the work "
        "or about the turned ones has two readings",
        kByEuler, "G68.2 P1");
  }
  return cl::compose(moved_by(point_of(line)), fixed);
}

/// A block of P2 or P3 has to come behind the one before it.
cl::Outcome begin_part(PlaneInParts& parts, int form, int q) {
  const bool is_first = q <= 1;
  if (is_first && parts.form == 0) {
    parts = {form, q};
    return {};
  }
  if (parts.form == form && q == parts.last + 1) {
    parts.last = q;
    return {};
  }
  parts = {};
  return refuse("G68.2 P" + std::to_string(form) + " Q" + std::to_string(q) +
                    " out of its order: Q1, Q2 and on, one after the other",
                kByEuler, "G68.2 Q");
}

/// Q1 is the origin, Q2 lies along x, Q3 on the side of y. Nothing: more blocks have to come.
Expected<std::optional<cl::Frame>, cl::Refusal> by_three_points(State& s, const Line& line, int q) {
  PlaneInParts& parts = s.frames.parts;
  const Vector3 point = point_of(line);
  if (q == 0 && (!point.isZero(0) || number_of(line, "R") != 0)) {
    return refuse("G68.2 P2 Q0 with a shift or a turn, which controls count from different places",
                  "write the origin as Q1, and zeros in Q0", "G68.2 Q0");
  }
  if (q == 0) return std::nullopt;
  if (q == 1) parts.origin = point;
  if (q == 2) parts.second = point;
  if (q < 3) return std::nullopt;
  const Vector3 x = parts.second - parts.origin, side = point - parts.origin;
  const double width = x.norm(), area = x.cross(side).norm();
  const double apart = kApart_mm / s.cl.units.to_mm;
  if (!(width > apart && area > apart * width)) {
    return refuse("G68.2 P2: its three points lie on a line", {}, "G68.2 P2");
  }
  return frame_along(parts.origin, x, x.cross(side));
}

/// Q1 is the origin and the direction of x, Q2 that of z.
Expected<std::optional<cl::Frame>, cl::Refusal> by_two_vectors(State& s, const Line& line, int q) {
  PlaneInParts& parts = s.frames.parts;
  const Vector3 direction = vector_of(line);
  if (!(direction.norm() > 1e-6)) {
    return refuse("G68.2 P3: I J K is no direction", {}, "G68.2 P3");
  }
  if (q == 1) {
    parts.origin = point_of(line);
    parts.x_axis = direction.normalized();
    return std::nullopt;
  }
  if (!are_square(parts.x_axis, direction)) {
    return refuse("G68.2 P3: its two vectors do not stand square on each other", {}, "G68.2 P3");
  }
  return frame_along(parts.origin, parts.x_axis, direction);
}

cl::Outcome define_part(State& s, const Line& line, int form) {
  const Word* const q_word = line.find("Q");
  const int first = form == 2 ? 0 : 1, last = form == 2 ? 3 : 2;
  const double number = q_word == nullptr ? -1 : q_word->number;
  if (!(number >= first && number <= last && number == std::floor(number))) {
    return refuse("G68.2 P" + std::to_string(form) + " needs Q" + std::to_string(first) + " to Q" +
                      std::to_string(last),
                  {}, "G68.2 Q");
  }
  const int q = static_cast<int>(number);
  if (auto done = begin_part(s.frames.parts, form, q); !done) return done;
  const auto plane = form == 2 ? by_three_points(s, line, q) : by_two_vectors(s, line, q);
  if (!plane) {
    s.frames.parts = {};
    return tl::make_unexpected(plane.error());
  }
  if (!*plane) return {};
  s.frames.parts = {};
  set_plane(s, line, **plane, Tilt::kDefined);
  return {};
}

}  // namespace

cl::Outcome check_plane_is_whole(const State& s) {
  const PlaneInParts& parts = s.frames.parts;
  if (parts.form == 0) return {};
  return refuse(
      "G68.2 P" + std::to_string(parts.form) + " without its Q" + std::to_string(parts.last + 1),
      kByEuler, "G68.2 Q");
}

cl::Outcome define_plane(State& s, const Line& line) {
  if (s.modes.is_incremental()) return refuse("G68.2 under G91", "write G90 before it");
  if (s.modes.has_dynamic_offset) return refuse("G68.2 under G254", "write G255 before it");
  if (holds_tip(s.modes.control)) {
    return refuse("G68.2 while tool-centre control is on", "write G49 before it");
  }
  const double form = number_of(line, "P");
  if (form == 2 || form == 3) return define_part(s, line, static_cast<int>(form));
  if (auto done = check_plane_is_whole(s); !done) return done;
  if (form != 0 && form != 1) {
    return refuse("G68.2 P" + std::string(line.find("P")->digits) +
                      ": a plane by angles of its projections, whose meaning differs",
                  kByEuler, "G68.2 P");
  }
  if (number_of(line, "R") != 0) {
    return refuse("G68.2 with R, a turn that controls count differently", kByEuler, "G68.2 R");
  }
  const auto plane = form == 0 ? by_euler_angles(line) : by_roll_pitch_yaw(line);
  if (!plane) return tl::make_unexpected(plane.error());
  set_plane(s, line, *plane, Tilt::kDefined);
  return {};
}

}  // namespace meridian::nc
