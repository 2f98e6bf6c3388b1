// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/picture/picture_data.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "meridian/kinematics/kinematics.hpp"

namespace meridian::record {
namespace {

/// A point of the tip's way is kept where it is this far from the last one kept, as a part of the
/// whole way, or where the kind changes.
constexpr double kPointsOnPath = 20000;

struct Span {
  std::uint64_t first = 0, last = 0;
  double distance_mm = 0;
};

template <class Use>
[[nodiscard]] std::optional<RecordError> for_each(RecordingReader& recording, Use&& use) {
  recording.rewind();
  RecordingRow row;
  for (;;) {
    auto read = recording.next(row);
    if (!read) return std::move(read.error());
    if (!*read) return std::nullopt;
    if (is_leading(row.flags)) use(row);
  }
}

/// Fills the columns: the last four rows give the differences.
class Filler {
 public:
  Filler(const CheckedPath& path, const MachineModel& model, const Span& span, PictureData& data)
      : model_(model), span_(span), data_(data), length_(path.begin_tool_length_mm()) {
    for (const PathElement& element : path.elements()) {
      double& feed = feeds_[element.line];
      if (std::isfinite(element.feed_mm_per_s)) feed = std::max(feed, element.feed_mm_per_s);
    }
  }

  void add(const RecordingRow& row) {
    if (row.cycle < span_.first || row.cycle > span_.last) return;
    std::rotate(rows_.begin(), rows_.begin() + 1, rows_.end());
    rows_.back() = row;
    run_ = run_ > 0 && row.cycle == rows_[2].cycle + 1 ? std::min(run_ + 1, 4) : 1;
    const double share = static_cast<double>(row.cycle - span_.first) /
                         static_cast<double>(span_.last - span_.first + 1);
    const auto last = data_.columns.size() - 1;
    PictureColumn& column = data_.columns[std::min(
        last, static_cast<std::size_t>(share * static_cast<double>(data_.columns.size())))];
    const double period = static_cast<double>(model_.cycle_ns) * 1e-9;
    for (int i = 0; i < model_.joint_count; ++i) {
      const auto q = [&](int back) { return rows_[3 - back].joints[i]; };
      const JointLimits& limits = model_.joints[i].limits;
      column.position[i].add(q(0));
      if (run_ > 1) column.rate[0][i].add((q(0) - q(1)) / (period * limits.velocity));
      if (run_ > 2) {
        column.rate[1][i].add((q(0) - 2 * q(1) + q(2)) / (period * period * limits.acceleration));
      }
      if (run_ > 3) {
        column.rate[2][i].add((q(0) - 3 * q(1) + 3 * q(2) - q(3)) /
                              (period * period * period * limits.jerk));
      }
    }
    const ToolPose pose = forward(model_, length_, row.joints);
    const Vector3 tip = pose.tip;
    if (run_ > 1) column.tip_speed_mm_per_s.add((tip - tip_).norm() / period);
    const auto feed = feeds_.find(row.line);
    if (row.kind == MotionKind::kCut && feed != feeds_.end() && feed->second > 0) {
      column.feed_mm_per_s.add(feed->second);
    }
    tip_ = tip;
    auto& points = data_.tip;
    if (points.empty() || points.back().kind != row.kind ||
        (tip - points.back().tip).norm() >= span_.distance_mm / kPointsOnPath) {
      if (!points.empty() && points.back().kind != row.kind)
        points.push_back({tip, pose.axis, points.back().kind});
      points.push_back({tip, pose.axis, row.kind});
    }
  }

 private:
  const MachineModel& model_;
  const Span& span_;
  PictureData& data_;
  double length_;
  std::unordered_map<std::uint32_t, double> feeds_;
  std::array<RecordingRow, 4> rows_{};
  int run_ = 0;
  Vector3 tip_ = Vector3::Zero();
};

}  // namespace

std::optional<RecordError> gather(RecordingReader& recording, const CheckedPath& path,
                                  const MachineModel& model, std::size_t columns,
                                  PictureData& data) {
  Span span;
  RecordingRow before;
  bool has_before = false, has_moved = false;
  auto error = for_each(recording, [&](const RecordingRow& row) {
    if (has_before && row.joints != before.joints) {
      if (!has_moved) span.first = before.cycle;
      has_moved = true;
      span.last = row.cycle;
      span.distance_mm += (forward(model, path.begin_tool_length_mm(), row.joints).tip -
                           forward(model, path.begin_tool_length_mm(), before.joints).tip)
                              .norm();
    }
    before = row;
    has_before = true;
  });
  if (error) return error;
  if (!has_moved) {
    return RecordError{recording.path(), 0, "nothing moves in it", "there is nothing to draw"};
  }
  const double period = static_cast<double>(model.cycle_ns) * 1e-9;
  const std::uint64_t cycles = span.last - span.first + 1;
  data.columns.assign(std::min<std::uint64_t>(columns, cycles), {});
  for (std::size_t i = 0; i < data.columns.size(); ++i) {
    data.columns[i].time_s = period * static_cast<double>(cycles) * static_cast<double>(i) /
                             static_cast<double>(data.columns.size());
  }
  Filler filler(path, model, span, data);
  return for_each(recording, [&filler](const RecordingRow& row) { filler.add(row); });
}

}  // namespace meridian::record
