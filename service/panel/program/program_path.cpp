// SPDX-License-Identifier: Apache-2.0
#include "service/panel/program/program_path.hpp"

#include <bit>

namespace meridian::panel {
namespace {

static_assert(sizeof(ProgramPath::Point) == 4 * (14 + kMaxJoints) &&
                  std::endian::native == std::endian::little,
              "the page reads points as they lie here: service/panel/page/src/program_path.js");

[[nodiscard]] std::array<float, 3> to_float(const Vector3& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

}  // namespace

void ProgramPath::add(const CycleRecord& record, const Cause& cause) {
  constexpr double kPerMinute = 60;
  time_s_ += cause.time_s;
  path_mm_ += cause.path_mm;
  if (++since_ < every_ && !points_.empty()) return;
  const Pose<double> pose = forward(model_, cause.tool_length_mm, record.joints);
  const double passed_s = time_s_ - point_s_;
  Point point;
  point.time_s = static_cast<float>(time_s_);
  point.plan_time_s = static_cast<float>(record.plan_time_s);
  point.tip_mm = to_float(pose.tip);
  point.axis = to_float(pose.axis);
  point.feed_mm_per_min = static_cast<float>(passed_s > 0 ? kPerMinute * path_mm_ / passed_s : 0);
  point.programmed_mm_per_min = static_cast<float>(kPerMinute * cause.programmed_mm_per_s);
  point.line = record.setpoint.line;
  point.block = static_cast<std::uint32_t>(record.sequence);
  point.limit = cause.limit;
  point.cause = cause.cause;
  for (std::size_t i = 0; i < point.joints.size(); ++i) {
    point.joints[i] = static_cast<float>(record.joints[i]);
  }
  points_.push_back(point);
  point_s_ = time_s_;
  path_mm_ = 0;
  since_ = 0;
  if (points_.size() >= kMaxPoints) halve();
}

void ProgramPath::decide(std::uint32_t cause) noexcept {
  for (auto point = points_.rbegin(); point != points_.rend(); ++point) {
    if (point->cause != kUndecided) return;
    point->cause = cause;
  }
}

/// The second of every two points stays, with the feed of both.
void ProgramPath::halve() {
  std::size_t kept = 1;
  for (std::size_t i = 2; i < points_.size(); i += 2) {
    Point point = points_[i];
    const Point& gone = points_[i - 1];
    const float begin_s = points_[kept - 1].time_s;
    const float path = point.feed_mm_per_min * (point.time_s - gone.time_s) +
                       gone.feed_mm_per_min * (gone.time_s - begin_s);
    if (point.time_s > begin_s) point.feed_mm_per_min = path / (point.time_s - begin_s);
    points_[kept++] = point;
  }
  points_.resize(kept);
  every_ *= 2;
}

std::string ProgramPath::bytes() const {
  return {reinterpret_cast<const char*>(points_.data()), points_.size() * sizeof(Point)};
}

}  // namespace meridian::panel
