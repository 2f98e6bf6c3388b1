// SPDX-License-Identifier: Apache-2.0
// Frames that a program puts between its points and its zero, and tilted planes.
#include "service/programs/nc/frames/frames.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "meridian/units.hpp"
#include "service/programs/nc/state.hpp"

namespace meridian::nc {
namespace {

using cl::refuse;

constexpr double kSameAxis = 1e-6;  // of the sine: 0.2 arc seconds

/// What is known of the tool's position, as the frames of now say it.
void restate_position(State& s, const cl::Frame& from_before) {
  ToolPosition& position = s.position;
  if (position.is_known()) {
    const Vector3 tip =
        from_before.point(Vector3(*position.tip[0], *position.tip[1], *position.tip[2]));
    for (std::size_t k = 0; k < 3; ++k) position.tip[k] = tip[static_cast<Eigen::Index>(k)];
  } else if (from_before.rotation.isIdentity()) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (position.tip[k]) *position.tip[k] += from_before.origin[static_cast<Eigen::Index>(k)];
    }
  } else {
    position.forget();
  }
  if (position.vector)
    position.vector = to_array(from_before.direction(to_vector(*position.vector)));
}

void set_frames(State& s, const Line& line, const cl::Frame& shift, const cl::Frame& plane) {
  ProgramFrames& frames = s.frames;
  const cl::Frame before = frames.now;
  frames.shift = shift;
  frames.plane = plane;
  frames.now = s.modes.language == Language::kSiemens ? cl::compose(plane, shift)
                                                      : cl::compose(shift, plane);
  if (cl::is_identity(cl::relative(before, frames.now))) return;
  restate_position(s, cl::relative(frames.now, before));
  begin_cycle(s, 0);
  s.modes.pole = {};
  if (s.cl.path.has_moved()) ++s.cl.summary.frame_changes;
  s.cl.remarks.warn("frame", line.number, [] {
    return std::string("the program changes its frame: points after it are put through it");
  });
}

bool is_along(const Vector3& a, const Vector3& b) {
  return a.cross(b).norm() < kSameAxis && a.dot(b) > 0;
}

bool are_all_reported(const State& s, const ToolPosition& position) {
  const std::size_t needed = s.axes ? s.axes->rotary_count() : 2;
  return position.rotary.size() >= needed;
}

}  // namespace

cl::Frame turned_about(std::size_t axis, double deg) {
  cl::Frame out;
  const auto at = static_cast<Eigen::Index>(axis);
  // Quarter turns to the last digit, so that a plane along the axes stays along them.
  const double quarters = deg / 90;
  double c = std::cos(units::rad_from_deg(deg)), sn = std::sin(units::rad_from_deg(deg));
  if (quarters == std::round(quarters)) {
    c = std::round(c);
    sn = std::round(sn);
  }
  const Eigen::Index a = (at + 1) % 3, b = (at + 2) % 3;
  out.rotation(a, a) = c;
  out.rotation(b, a) = sn;
  out.rotation(a, b) = -sn;
  out.rotation(b, b) = c;
  return out;
}

cl::Frame moved_by(const Vector3& offset) {
  cl::Frame out;
  out.origin = offset;
  return out;
}

cl::Frame turned(std::initializer_list<Turn> turns) {
  cl::Frame out;
  for (const Turn& turn : turns) out = cl::compose(out, turned_about(turn.axis, turn.deg));
  return out;
}

cl::Frame frame_along(const Vector3& origin, const Vector3& x, const Vector3& z) {
  cl::Frame out;
  out.rotation.col(2) = z.normalized();
  out.rotation.col(1) = z.cross(x).normalized();
  out.rotation.col(0) = out.rotation.col(1).cross(out.rotation.col(2));
  out.origin = origin;
  return out;
}

bool are_square(const Vector3& a, const Vector3& b) {
  constexpr double kCosine = 1e-3;
  return std::abs(a.normalized().dot(b.normalized())) <= kCosine;
}

void set_shift(State& s, const Line& line, const cl::Frame& shift) {
  set_frames(s, line, shift, s.frames.plane);
}

void set_plane(State& s, const Line& line, const cl::Frame& plane, Tilt tilt) {
  set_frames(s, line, s.frames.shift, plane);
  s.frames.tilt = tilt;
  if (tilt == Tilt::kTurned) turn_to_plane(s, line);
}

void turn_to_plane(State& s, const Line& line) {
  s.frames.tilt = Tilt::kTurned;
  s.position.forget();
  s.position.rotary.clear();
  s.position.is_by_control = !s.frames.plane.rotation.isIdentity();
  if (!s.cl.path.has_moved()) return;
  s.cl.remarks.warn("plane", line.number, [] {
    return std::string(
        "the control turns the tool across a tilted plane: how it gets there is not in the "
        "program; the next motion goes straight from the point before; see that nothing is in "
        "the way");
  });
}

bool is_across_plane(const State& s, const ToolPosition& position) {
  const ProgramFrames& frames = s.frames;
  if (frames.tilt == Tilt::kTurned || s.modes.has_dynamic_offset) return true;
  if (frames.tilt == Tilt::kNone) return false;
  const Vector3 wanted = tool_of_plane(s);
  if (!position.is_turned()) return is_along(wanted, Vector3::UnitZ());
  if (!s.axes || !s.axes->refusal().empty() || !are_all_reported(s, position)) return false;
  return is_along(s.axes->to_program() * s.axes->axis(position.rotary), wanted);
}

Vector3 tool_of_plane(const State& s) {
  const cl::Frame& shift = s.frames.shift;
  const Vector3 z = s.frames.plane.rotation.col(2);
  return s.modes.language == Language::kSiemens ? z : shift.direction(z);
}

void note_rotary_words(State& s, ToolPosition& to) {
  if (s.frames.tilt == Tilt::kTurned && !holds_tip(s.modes.control)) {
    s.frames.tilt = Tilt::kDefined;
  }
  if (are_all_reported(s, to)) to.is_by_control = false;
}

Vector3 in_program(const State& s, const Vector3& written) {
  return s.frames.now.point(written) + s.frames.zero_mm / s.cl.units.to_mm;
}

Vector3 as_written(const State& s, const Vector3& p_w) {
  const Vector3 from_zero = s.axes ? Vector3(s.axes->to_program() * p_w) : p_w;
  const Vector3 program = (from_zero - s.frames.zero_mm) / s.cl.units.to_mm;
  return cl::relative(s.frames.now, moved_by(program)).origin;
}

Vector3 direction_in_w(const State& s, const Vector3& program) {
  return s.axes ? Vector3(s.axes->to_program().transpose() * program) : program;
}

void set_zero(State& s, const Line& line, const Vector3& zero_mm) {
  if (zero_mm == s.frames.zero_mm) return;
  const Vector3 back = (s.frames.zero_mm - zero_mm) / s.cl.units.to_mm;
  s.frames.zero_mm = zero_mm;
  const cl::Frame& now = s.frames.now;
  restate_position(s, moved_by(now.rotation.transpose() * back));
  begin_cycle(s, 0);
  s.modes.pole = {};
  if (!s.cl.path.has_moved()) return;
  ++s.cl.summary.frame_changes;
  s.cl.remarks.warn("zero", line.number, [] {
    return std::string(
        "another work offset: the next motion goes straight there from the point "
        "before; see that nothing is in the way");
  });
}

/// G53.1: the rotary axes turn the tool across the plane.
cl::Outcome follow_plane(State& s, const Line& line) {
  if (auto done = check_plane_is_whole(s); !done) return done;
  if (s.frames.tilt == Tilt::kNone)
    return refuse("G53.1, but no G68.2 defines a plane", "write G68.2 before it");
  turn_to_plane(s, line);
  return {};
}

/// G52: a zero beside the zero; axes that are left out keep theirs.
cl::Outcome set_local_zero(State& s, const Line& line) {
  if (s.frames.tilt != Tilt::kNone) {
    return refuse("G52 in a tilted plane", "write it before G68.2");
  }
  cl::Frame shift = s.frames.shift;
  for (std::size_t k = 0; k < 3; ++k) {
    const Word* const word = line.find(k == 0 ? "X" : k == 1 ? "Y" : "Z");
    if (word != nullptr) shift.origin[static_cast<Eigen::Index>(k)] = word->number;
  }
  set_shift(s, line, shift);
  return {};
}

}  // namespace meridian::nc
