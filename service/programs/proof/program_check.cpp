// SPDX-License-Identifier: Apache-2.0
#include "service/programs/proof/program_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/units.hpp"
#include "service/programs/cl/cl_points.hpp"
#include "service/programs/proof/rewind.hpp"
#include "service/recording/record/check/check_report.hpp"
#include "service/recording/record/check/path/path_matching.hpp"

namespace meridian::proof {
namespace {

using record::CheckedPath;
using record::GaugePose;
using record::PathMatching;
using record::Tolerance;
using Kind = ProgramStep::Kind;

constexpr double kChord_mm = 2e-5;  // what a straight sample may cut off the tool's path
constexpr double kChord_rad = 1e-7;
constexpr int kMaxSamples = 4096;      // of one line
constexpr double kRewindClear_mm = 1;  // the least that [rewind] retract_mm takes

/// Lines of a program between two tool changes, and the part of the CL file that they cut.
struct Section {
  std::span<const ProgramStep> steps;
  CheckedPath path;
  int tool = 0;  ///< 0: in the spindle at the begin
};

[[nodiscard]] std::string number(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// How straight the tool goes from one pose to the next: what samples between have to cover.
[[nodiscard]] int samples_between(const ToolPose& from, const ToolPose& middle,
                                  const ToolPose& to) {
  const double tip = (middle.tip - 0.5 * (from.tip + to.tip)).norm();
  const double axis = (middle.axis - 0.5 * (from.axis + to.axis)).norm();
  const double ratio = std::max(tip / kChord_mm, axis / kChord_rad);
  const int wanted = static_cast<int>(std::ceil(std::sqrt(std::min(ratio, 1e9))));
  return std::clamp(wanted, 4, kMaxSamples);
}

/// One section held against its path.
class SectionCheck {
 public:
  SectionCheck(const Section& section, const MachineModel& model, const Tolerance& tolerance,
               ProgramReport& report)
      : section_(section), model_(model), tolerance_(tolerance), report_(report) {}

  void run() {
    const auto& path = section_.path;
    if (!path.has_begin()) return refuse_cuts(0, "cuts where the CL file has no motion");
    const double length = path.begin_tool_length_mm();
    const std::size_t begin = find(path.begin(), length, 0, section_.steps.size(), false);
    if (begin == section_.steps.size()) {
      return add("no line ends on the first CL point", 0, path.begin_line());
    }
    if (path.elements().empty()) return refuse_cuts(begin + 1, "cuts after the last CL point");
    const std::size_t end = find(path.end(), length, begin, section_.steps.size(), true);
    match(begin, end == section_.steps.size() ? last_motion() : end);
    if (end != section_.steps.size()) refuse_cuts(end + 1, "cuts after the last CL point");
  }

 private:
  void add(std::string text, std::uint32_t line, std::uint32_t cl_line) {
    report_.findings.push_back({std::move(text), line, cl_line});
  }

  [[nodiscard]] bool is_motion_step(const ProgramStep& step) const noexcept {
    return step.kind == Kind::kCut || step.kind == Kind::kRapid;
  }

  [[nodiscard]] ToolPose pose(const JointVector& drives, double length) const {
    return true_pose(model_, length, joints_of(model_, drives));
  }

  /// Where a tool of this length is, `share` of the way from where the line before ended. A program
  /// of the tool's tip knows the tip of the tool in the spindle.
  [[nodiscard]] ToolPose pose(const ProgramStep& from, const ProgramStep& to, double share,
                              double length) const {
    if (to.tool_pose && from.tool_pose) {
      const Vector3 axis = cl::turn_towards(from.tool_pose->axis, to.tool_pose->axis, share);
      const Vector3 tip = from.tool_pose->tip + share * (to.tool_pose->tip - from.tool_pose->tip);
      return {tip + (section_.path.begin_tool_length_mm() - length) * axis, axis};
    }
    JointVector at = from.drives;
    for (int i = 0; i < model_.joint_count; ++i) at[i] += share * (to.drives[i] - from.drives[i]);
    return pose(at, length);
  }

  /// The first or last line of [from, to) that ends within tolerance of `want`; `to` where none.
  [[nodiscard]] std::size_t find(const ToolPose& want, double length, std::size_t from,
                                 std::size_t to, bool is_last) const {
    std::size_t found = to;
    for (std::size_t n = from; n < to; ++n) {
      const ProgramStep& step = section_.steps[n];
      if (!is_motion_step(step) || !step.is_placed) continue;
      const ToolPose at = pose(step, step, 1, length);
      if ((at.tip - want.tip).norm() > tolerance_.tip_mm) continue;
      if (angle_between(at.axis, want.axis) > tolerance_.axis_rad) continue;
      found = n;
      if (!is_last) break;
    }
    return found;
  }

  [[nodiscard]] std::size_t last_motion() const noexcept {
    std::size_t last = 0;
    for (std::size_t n = 0; n < section_.steps.size(); ++n) {
      if (section_.steps[n].kind == Kind::kCut) last = n;
    }
    return last;
  }

  void refuse_cuts(std::size_t from, const char* why) {
    for (std::size_t n = from; n < section_.steps.size(); ++n) {
      if (section_.steps[n].kind == Kind::kCut) return add(why, section_.steps[n].line, 0);
    }
  }

  /// From the line that ends on the begin to `end`.
  void match(std::size_t begin, std::size_t end) {
    PathMatching matching(section_.path.elements());
    const ProgramStep* from = &section_.steps[begin];
    move(matching, pose(*from, *from, 1, 0), from->line);
    for (std::size_t n = begin + 1; n <= end; ++n) {
      const ProgramStep& step = section_.steps[n];
      if (!is_motion_step(step)) {
        if (step.kind == Kind::kAway)
          return add("leaves the path for an unknown place", step.line, 0);
        continue;
      }
      const auto lines = section_.steps.subspan(n, end + 1 - n);
      const RewindLimits limits{kRewindClear_mm, section_.path.begin_tool_length_mm()};
      if (const auto back = find_rewind(*from, lines, model_, limits)) {
        n += *back;
        from = &section_.steps[n];
        ++report_.rewinds;
        continue;
      }
      run_line(matching, *from, step);
      from = &step;
      ++report_.moves;
    }
    const bool is_at_end = matching.finish();
    note_vertices(matching.passed());
    note_vertices(matching.open());
    if (over_line_ > 0) {
      add("tip " + number("%.4f", over_tip_) + " mm and axis " +
              number("%.5f", units::deg_from_rad(over_axis_)) + " deg off the CL path",
          over_line_, 0);
    } else if (!is_at_end) {
      add("the CL path is not cut to its end", section_.steps[end].line, 0);
    } else if (matching.is_broken() && missed_ == 0) {
      add("the CL path is cut in another order", broken_line_, 0);
    }
    if (missed_ > 0) {
      add(std::to_string(missed_) + " CL points are missed, first by " +
              number("%.4f", missed_tip_) + " mm",
          0, missed_line_);
    }
  }

  void run_line(PathMatching& matching, const ProgramStep& from, const ProgramStep& step) {
    const double length = section_.path.elements().front().tool_length_mm;
    const int parts = samples_between(pose(from, step, 0, length), pose(from, step, 0.5, length),
                                      pose(from, step, 1, length));
    for (int k = 1; k <= parts; ++k) {
      move(matching, pose(from, step, static_cast<double>(k) / parts, 0), step.line);
    }
  }

  void move(PathMatching& matching, const ToolPose& gauge, std::uint32_t line) {
    const auto step = matching.move(GaugePose{gauge.tip, gauge.axis}, tolerance_);
    if (step != PathMatching::Step::kWithin && broken_line_ == 0) broken_line_ = line;
    note_vertices(matching.passed());
    matching.passed().clear();
    const record::PoseMatch match = matching.best();
    if (match.tip_mm > report_.tip_mm.value) report_.tip_mm = {match.tip_mm, line};
    if (match.axis_rad > report_.axis_rad.value) report_.axis_rad = {match.axis_rad, line};
    const double share = match.share(tolerance_);
    if (share > 1 + 2 * record::kRoundingShare && share > over_share_) {
      over_share_ = share;
      over_tip_ = match.tip_mm;
      over_axis_ = match.axis_rad;
      over_line_ = line;
    }
  }

  void note_vertices(std::span<const record::VertexPass> passes) {
    for (const record::VertexPass& pass : passes) {
      if (pass.share <= 1 + 2 * record::kRoundingShare) continue;
      // A chord between samples may cut kSag_mm off.
      if (pass.tip_mm <= tolerance_.tip_mm + record::kSag_mm &&
          pass.axis_rad <= tolerance_.axis_rad * (1 + 2 * record::kRoundingShare)) {
        continue;
      }
      if (missed_++ > 0) continue;
      missed_tip_ = std::isfinite(pass.tip_mm) ? pass.tip_mm : 0;
      missed_line_ = pass.index == 0 ? section_.path.begin_line()
                                     : section_.path.elements()[pass.index - 1].line;
    }
  }

  const Section& section_;
  const MachineModel& model_;
  Tolerance tolerance_;
  ProgramReport& report_;
  double over_share_ = 0, over_tip_ = 0, over_axis_ = 0, missed_tip_ = 0;
  std::uint32_t over_line_ = 0, broken_line_ = 0, missed_line_ = 0;
  std::uint64_t missed_ = 0;
};

/// The CL file tool by tool. Tools that the table has not were refused before.
[[nodiscard]] std::vector<Section> sections_of(const std::vector<ClBlock>& blocks,
                                               const MachineModel& model, const ToolTable& tools) {
  double length = model.tool_length_mm;
  std::vector<Section> sections;
  sections.push_back({{}, CheckedPath(length, 0), 0});
  for (const ClBlock& block : blocks) {
    if (block.kind == BlockKind::kTool) {
      const Tool* const tool = tools.find(static_cast<int>(block.value));
      length = tool != nullptr ? tool->tip_length_mm() : length;
      sections.push_back({{}, CheckedPath(length, 0), static_cast<int>(block.value)});
      continue;
    }
    sections.back().path.add(block, 0);
  }
  return sections;
}

}  // namespace

ProgramReport check_program(const std::vector<ProgramStep>& steps,
                            const std::vector<ClBlock>& blocks, const MachineModel& model,
                            const ToolTable& tools, const ProgramCheckOptions& options) {
  ProgramReport report;
  report.tip_tolerance_mm = options.tip_mm > 0 ? options.tip_mm : model.tolerances.tip_mm;
  report.axis_tolerance_rad = options.axis_rad > 0 ? options.axis_rad : model.tolerances.axis_rad;
  std::vector<Section> sections = sections_of(blocks, model, tools);
  const std::span<const ProgramStep> all(steps);
  std::size_t at = 0, from = 0;
  for (std::size_t n = 0; n <= all.size(); ++n) {
    if (n < all.size() && all[n].kind != Kind::kTool) continue;
    sections[at].steps = all.subspan(from, n - from);
    from = n;
    if (n == all.size()) break;
    if (at + 1 == sections.size() || sections[at + 1].tool != all[n].tool) {
      report.findings.push_back(
          {"calls tool " + std::to_string(all[n].tool) + ", which the CL file does not call here",
           all[n].line, 0});
      return report;
    }
    ++at;
  }
  if (at + 1 != sections.size()) {
    report.findings.push_back(
        {"the CL file's tool " + std::to_string(sections[at + 1].tool) + " is not called", 0, 0});
  }
  for (const Section& section : sections) {
    report.motions += section.path.motion_block_count();
    report.tip_length_mm += section.path.tip_length_mm();
    if (section.path.has_begin()) ++report.sections;
    SectionCheck(section, model, {report.tip_tolerance_mm, report.axis_tolerance_rad}, report)
        .run();
  }
  return report;
}

}  // namespace meridian::proof
