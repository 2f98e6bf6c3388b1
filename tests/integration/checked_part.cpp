// SPDX-License-Identifier: Apache-2.0
#include "integration/checked_part.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "meridian/expected.hpp"
#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "service/recording/record/file/read_path.hpp"

namespace meridian::test {
namespace {

constexpr double kMmPerRad = 50;  ///< what a turn of the axis counts for

/// How far `row` is from the end of line `line`, mm.
[[nodiscard]] double distance_to_end(const record::CheckedPath& path, std::uint32_t line,
                                     const MachineModel& model, const JointVector& joints) {
  double min = std::numeric_limits<double>::infinity();
  const auto look = [&](const ToolPose& end, double tool_length) {
    const ToolPose pose = forward(model, tool_length, joints);
    min =
        std::min(min, (pose.tip - end.tip).norm() + kMmPerRad * angle_between(pose.axis, end.axis));
  };
  if (line == path.begin_line()) look(path.begin(), path.begin_tool_length_mm());
  for (const record::PathElement& element : path.elements()) {
    if (element.line == line && element.is_block_end) look(element.pose(1), element.tool_length_mm);
  }
  return min;
}

/// The part's way, what was recorded of a stretch of it, and how the two are compared.
struct ReadCut {
  record::CheckedPath path;
  record::RecordingReader recording;
  record::CheckOptions options;
};

/// Reads both with `tool_mm` in the spindle at the begin of the cut; else why not.
[[nodiscard]] Expected<ReadCut, std::string> read_both(const PartAsked& part, const PartCut& cut,
                                                       double tool_mm) {
  record::CheckedPath path(tool_mm, part.model.max_feed_mm_per_s);
  cl::ClReaderOptions reader;
  reader.first_line = cut.from_line;
  if (const auto refusal = record::read_path(part.file, reader, part.tools, path);
      !refusal.empty()) {
    return tl::make_unexpected(refusal);
  }
  auto recording = record::RecordingReader::open(cut.recording.string(), part.model);
  if (!recording) return tl::make_unexpected(recording.error().text());
  record::CheckOptions options;
  options.max_missing = cut.max_missing;
  options.allow_unfinished = !cut.is_finished;
  options.from_cycle = cut.from_cycle;
  options.to_cycle = cut.to_cycle;
  return ReadCut{std::move(path), std::move(*recording), std::move(options)};
}

/// Limits of every joint and the order of cycles, without the path.
void expect_joints_inside(const MachineModel& model, record::RecordingReader& recording,
                          const record::CheckOptions& options) {
  const record::CheckedPath none(model.tool_length_mm, model.max_feed_mm_per_s);
  const auto report = record::check(recording, none, model, options);
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_TRUE(report->passed()) << to_text(*report);
}

/// The last cycle in front of the first FaultStop since `from`.
[[nodiscard]] std::uint64_t last_on_path(record::RecordingReader& recording, std::uint64_t from,
                                         std::uint64_t to) {
  recording.rewind();
  std::uint64_t last = from;
  for (record::RecordingRow row; recording.next(row).value_or(false);) {
    if (row.cycle < from) continue;
    if (row.cycle > to || (row.flags & kSetpointFaultStop) != 0) break;
    last = row.cycle;
  }
  return last;
}

}  // namespace

std::vector<std::uint32_t> motion_lines(const MachineModel& model, const ToolTable& tools,
                                        const std::filesystem::path& file) {
  record::CheckedPath path(model.tool_length_mm, model.max_feed_mm_per_s);
  EXPECT_EQ(record::read_path(file, {}, tools, path), "");
  std::vector<std::uint32_t> lines{path.begin_line()};
  for (const record::PathElement& element : path.elements()) {
    if (element.line != lines.back()) lines.push_back(element.line);
  }
  return lines;
}

bool passes_with(const PartAsked& part, const PartCut& cut, double tool_mm) {
  auto read = read_both(part, cut, tool_mm);
  if (!read) return false;
  const auto report = record::check(read->recording, read->path, part.model, read->options);
  return report && report->passed();
}

LinesCut check(const PartAsked& part, const PartCut& cut) {
  LinesCut lines;
  auto read = read_both(part, cut, cut.tool_mm > 0 ? cut.tool_mm : part.model.tool_length_mm);
  if (!read) {
    ADD_FAILURE() << read.error();
    return lines;
  }
  auto& [path, recording, options] = *read;
  if (cut.has_left_path) {
    expect_joints_inside(part.model, recording, options);
    options.to_cycle = last_on_path(recording, cut.from_cycle, cut.to_cycle);
  }
  const auto report = record::check(recording, path, part.model, options);
  if (!report) {
    ADD_FAILURE() << report.error().text();
    return lines;
  }
  EXPECT_TRUE(report->passed()) << to_text(*report);

  recording.rewind();
  JointVector rest{};
  for (record::RecordingRow row; recording.next(row).value_or(false);) {
    if (row.cycle < report->begin_cycle || row.cycle < cut.from_cycle) continue;
    if (row.cycle > options.to_cycle || (row.flags & kSetpointEnabled) == 0) continue;
    if ((row.flags & kSetpointMoving) == 0 || row.kind == MotionKind::kApproach) continue;
    if (!std::binary_search(part.motions.begin(), part.motions.end(), row.line)) continue;
    if (row.line < lines.last) {
      ADD_FAILURE() << "line " << row.line << " after line " << lines.last << " in cycle "
                    << row.cycle;
      break;
    }
    if (lines.first == 0) lines.first = row.line;
    lines.last = row.line;
    rest = row.joints;
  }
  if (lines.last != 0) {
    const double tolerance = report->tip_tolerance_mm + kMmPerRad * report->axis_tolerance_rad;
    lines.is_last_done = distance_to_end(path, lines.last, part.model, rest) <= tolerance;
  }
  return lines;
}

void expect_seam(const PartAsked& part, const LinesCut& before, const LinesCut& after,
                 std::uint32_t from_line, bool is_late) {
  const auto first = std::lower_bound(part.motions.begin(), part.motions.end(), from_line);
  ASSERT_NE(first, part.motions.end());
  const std::uint32_t one_before = first == part.motions.begin() ? 0 : first[-1];
  const bool is_all_before = one_before == 0 || before.last > one_before ||
                             (before.last == one_before && before.is_last_done) ||
                             // The begin of the program is where its approach ends.
                             (one_before == part.motions.front() && before.last == 0);
  EXPECT_TRUE(is_all_before) << "lost between them: the first came to line " << before.last
                             << (before.is_last_done ? ", all of it" : "")
                             << ", the second begins with line " << *first;
  if (!is_late) {
    EXPECT_LE(before.last, *first) << "cut twice";
  }
  if (after.last != 0) {
    EXPECT_GE(after.first, *first) << "cut twice";
  }
}

}  // namespace meridian::test
