// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <limits>
#include <utility>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "service/recording/record/check/motion/joint_check.hpp"
#include "service/recording/record/check/path/path_check.hpp"
#include "service/recording/record/check/path/rewind_check.hpp"
#include "service/recording/record/check/path/tip_box_check.hpp"

namespace meridian::record {
namespace {

/// Distances to the path's begin this close to the least count as there, in tip tolerances.
constexpr double kSameBegin = 0.1;
constexpr double kMmPerRad = 50;  ///< what a turn of the axis counts for in them

/// What the first reading of a recording finds: its grid, and where the cut begins and ends.
class Survey {
 public:
  Survey(const CheckedPath& path, const MachineModel& model, double tip_tolerance_mm)
      : path_(path), model_(model), slack_(kSameBegin * tip_tolerance_mm) {}

  void add(const RecordingRow& row) {
    if (rows_ == 0) first_cycle_ = row.cycle;
    if (rows_ > 0) check_grid(row);
    const bool has_moved = rows_ > 0 && row.joints != last_.joints;
    if (!begins_.empty() && !has_moved && begins_.back().cycle == last_.cycle) {
      begins_.back().cycle = row.cycle;  // still at rest there
    }
    for (int i = 0; i < limited_count(model_); ++i) {
      largest_[i] = std::max(largest_[i], std::abs(row.positions[i]));
    }
    if (path_.has_begin()) find_ends(row, has_moved);
    if ((row.flags & kSetpointDryEnabled) != 0 && dry_rows_++ == 0) first_dry_ = row.cycle;
    if ((row.flags & kSetpointEnabled) != 0) ++followed_rows_;
    last_ = row;
    ++rows_;
  }

  void finish(CheckReport& report, const CheckOptions& options) const {
    report.rows = rows_;
    report.missing = missing_;
    report.longest_gap = longest_gap_;
    report.has_later_program = has_later_program_;
    report.cycles = rows_ > 0 ? last_.cycle - first_cycle_ + 1 : 0;
    char text[256];
    const auto find = [&](Finding::Kind kind, std::uint64_t cycle, std::uint64_t count) {
      report.findings.push_back({kind, text, cycle, 0, count});
    };
    if (has_cut(options)) {
      report.begin_cycle = begins_.front().cycle;
      report.end_cycle = std::max(report.begin_cycle, last_move_);
    } else if (path_.has_begin() && rows_ > 0 && !options.allow_unfinished) {
      std::snprintf(text, sizeof text, "the begin of the path was never reached, %.6f mm off it",
                    begins_.back().distance);
      find(Finding::Kind::kUnfinished, 0, 1);
    }
    if (path_.has_begin() && dry_rows_ > 0 && followed_rows_ > 0) {
      std::snprintf(
          text, sizeof text,
          "a dry run and a run that drives followed are both in it: check each by itself, "
          "--from-cycle, --to-cycle");
      find(Finding::Kind::kDryAndFollowed, first_dry_, dry_rows_);
    }
    if (rows_ == 0) {
      std::snprintf(text, sizeof text, "the recording has no rows");
      find(Finding::Kind::kEmpty, 0, 1);
    }
    if (missing_ > options.max_missing) {
      std::snprintf(text, sizeof text, "%llu cycles are missing, %llu allowed",
                    static_cast<unsigned long long>(missing_),
                    static_cast<unsigned long long>(options.max_missing));
      find(Finding::Kind::kMissingCycles, first_gap_, missing_);
    }
    if (disorders_ > 0) {
      std::snprintf(text, sizeof text, "%llu rows do not count up",
                    static_cast<unsigned long long>(disorders_));
      find(Finding::Kind::kCycleOrder, disorder_, disorders_);
    }
    if (off_grid_ > 0) {
      std::snprintf(text, sizeof text, "%llu due times are off the grid of %.6g ms",
                    static_cast<unsigned long long>(off_grid_),
                    static_cast<double>(model_.cycle_ns) * 1e-6);
      find(Finding::Kind::kDueGrid, first_off_grid_, off_grid_);
    }
  }

  /// Whether the path was begun at all: who comes near its begin in an approach has not.
  [[nodiscard]] bool has_cut(const CheckOptions& options) const noexcept {
    return has_run_ && !begins_.empty() &&
           begins_.back().distance <=
               options.tip_tolerance_mm + kMmPerRad * options.axis_tolerance_rad;
  }

  [[nodiscard]] const LimitedVector& largest() const noexcept { return largest_; }

 private:
  void check_grid(const RecordingRow& row) {
    if (row.cycle <= last_.cycle) {
      if (disorders_++ == 0) disorder_ = row.cycle;
      return;
    }
    const std::uint64_t gap = row.cycle - last_.cycle - 1;
    if (gap > 0 && missing_ == 0) first_gap_ = last_.cycle + 1;
    missing_ += gap;
    longest_gap_ = std::max(longest_gap_, gap);
    const std::int64_t wanted =
        static_cast<std::int64_t>(row.cycle - last_.cycle) * model_.cycle_ns;
    if (row.due_ns - last_.due_ns != wanted && off_grid_++ == 0) first_off_grid_ = row.cycle;
  }

  [[nodiscard]] double distance(const RecordingRow& row, double tool_length, const ToolPose& to) {
    const ToolPose pose = forward(model_, tool_length, row.joints);
    return (pose.tip - to.tip).norm() + kMmPerRad * angle_between(pose.axis, to.axis);
  }

  /// The cut begins where the joints leave the path's begin for the first time, as near to it as
  /// ever, and ends with the last motion of the program: that of the next begins with its approach.
  void find_ends(const RecordingRow& row, bool has_moved) {
    const bool is_led = is_leading(row.flags);
    // Where drives are switched on, the joints are led from where those stand: that is no motion.
    if (rows_ > 0 && is_led && !is_leading(last_.flags)) {
      if (has_run_) return;
      begins_.clear();
      has_moved = false;
    } else if (rows_ > 0 && (!has_moved || !is_led)) {
      return;
    }
    if (has_moved && row.kind != MotionKind::kApproach) has_run_ = true;
    if (has_moved && row.kind == MotionKind::kApproach && has_run_) has_later_program_ = true;
    if (has_later_program_) return;
    if (has_moved) last_move_ = row.cycle;
    // What lay beside the begin before the approach was the place of another program.
    if (has_moved && row.kind == MotionKind::kApproach) begins_.clear();
    const double to_begin = distance(row, path_.begin_tool_length_mm(), path_.begin());
    note_begin(to_begin, row.cycle);
  }

  /// Of each stay at the begin the nearest pose, of those that came nearer than the ones before.
  void note_begin(double distance, std::uint64_t cycle) {
    if (begins_.empty()) is_there_ = false;
    if (is_there_ && distance > begins_.back().distance + slack_) is_there_ = false;
    if (!begins_.empty() && distance >= begins_.back().distance) return;
    if (is_there_) begins_.pop_back();
    is_there_ = true;
    begins_.push_back({distance, cycle});
    while (begins_.front().distance > distance + slack_) begins_.pop_front();
  }

  const CheckedPath& path_;
  const MachineModel& model_;
  RecordingRow last_;
  std::uint64_t rows_ = 0, first_cycle_ = 0, missing_ = 0, longest_gap_ = 0, first_gap_ = 0;
  std::uint64_t disorders_ = 0, disorder_ = 0, off_grid_ = 0, first_off_grid_ = 0;
  std::uint64_t dry_rows_ = 0, first_dry_ = 0, followed_rows_ = 0;
  std::uint64_t last_move_ = 0;
  bool has_run_ = false, has_later_program_ = false;
  struct Begin {
    double distance;
    std::uint64_t cycle;  ///< the last one at rest there
  };
  std::deque<Begin> begins_;  ///< nearer and nearer to the path's begin, all as near as the last
  double slack_;
  bool is_there_ = false;  ///< the last of them has not been left
  LimitedVector largest_{};
};

/// Calls `use(row)` for every row in the range of the options.
template <class Use>
[[nodiscard]] Expected<bool, RecordError> for_each(RecordingReader& recording,
                                                   const CheckOptions& options, Use&& use) {
  recording.rewind();
  RecordingRow row;
  for (;;) {
    auto read = recording.next(row);
    if (!read) return tl::make_unexpected(std::move(read.error()));
    if (!*read) return true;
    if (row.cycle >= options.from_cycle && row.cycle <= options.to_cycle) use(row);
  }
}

}  // namespace

double CheckOptions::max_feed_factor() const noexcept {
  if (overrides.empty()) return feed_factor;
  double highest = 1;
  for (const FeedOverride& set : overrides) highest = std::max(highest, set.factor);
  return highest;
}

Expected<CheckReport, RecordError> check(RecordingReader& recording, const CheckedPath& path,
                                         const MachineModel& model, const CheckOptions& wanted) {
  CheckOptions options = wanted;
  if (!(options.tip_tolerance_mm > 0)) options.tip_tolerance_mm = model.tolerances.tip_mm;
  if (options.axis_tolerance_rad > 0) {
    options.pole_tolerance_rad = options.axis_tolerance_rad;
  } else {
    options.axis_tolerance_rad = model.tolerances.axis_rad;
    options.pole_tolerance_rad = axis_tolerance_beside_pole(model);
  }
  CheckReport report;
  report.tip_tolerance_mm = options.tip_tolerance_mm;
  report.axis_tolerance_rad = options.axis_tolerance_rad;
  report.pole_tolerance_rad = options.pole_tolerance_rad;
  report.recording = recording.path();
  report.motion_blocks = path.motion_block_count();
  report.tip_length_mm = path.tip_length_mm();
  report.cycle_s = static_cast<double>(model.cycle_ns) * 1e-9;

  Survey survey(path, model, options.tip_tolerance_mm);
  auto read = for_each(recording, options, [&survey](const RecordingRow& row) { survey.add(row); });
  if (!read) return tl::make_unexpected(std::move(read.error()));
  survey.finish(report, options);
  report.span_s = static_cast<double>(report.cycles) * report.cycle_s;
  report.cut_s = static_cast<double>(report.end_cycle - report.begin_cycle) * report.cycle_s;
  if (report.rows == 0) return report;

  JointCheck joints(model, survey.largest(), options.soft_limits);
  PathCheck tool(model, path, options);
  RewindCheck rewind(model, path, options);
  TipBoxCheck tip_box(model, path, options.soft_limits);
  const bool has_cut = survey.has_cut(options);
  std::uint64_t next_cycle = report.begin_cycle, missing = 0;
  read = for_each(recording, options, [&](const RecordingRow& row) {
    joints.add(row, recording.has_velocity());
    const bool is_before_cut = row.cycle < report.begin_cycle;
    if (has_cut && row.cycle <= report.end_cycle) tip_box.add(row, !is_before_cut);
    if (has_cut && row.cycle >= report.begin_cycle && row.cycle <= report.end_cycle) {
      if ((row.flags & kSetpointDryEnabled) != 0) ++report.dry_cut_cycles;
      missing += row.cycle > next_cycle ? row.cycle - next_cycle : 0;
      next_cycle = row.cycle + 1;
      if (rewind.add(row)) return;
      tool.add(row, missing);
      missing = 0;
    }
  });
  if (!read) return tl::make_unexpected(std::move(read.error()));
  if (has_cut) {
    tool.finish(report);
    rewind.finish(report);
  }
  joints.finish(report);
  tip_box.finish(report);
  return report;
}

}  // namespace meridian::record
