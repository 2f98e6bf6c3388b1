// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/station/preflight.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <utility>

#include "meridian/kinematics/limited.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/protocol/block_check.hpp"

namespace meridian::stream {

namespace {

constexpr double kRapidGuess_mm_per_s = 200;  // for times to go only

bool is_action(BlockKind kind) {
  return kind == BlockKind::kAuxiliary || kind == BlockKind::kTool || kind == BlockKind::kStop;
}

/// Time that a block takes at its programmed feed.
class IdealTime {
 public:
  double of(const ClBlock& block) {
    if (block.kind == BlockKind::kDwell) return block.value;
    if (!is_motion(block.kind)) return 0;
    const Vector3 tip = to_vector(block.tip_mm);
    double length_mm = has_tip_ ? (tip - tip_).norm() : 0;
    if (block.is_arc) {
      length_mm = (tip - to_vector(block.centre_mm)).norm() * block.sweep_rad;
    }
    tip_ = tip;
    has_tip_ = true;
    if (block.kind == BlockKind::kRapid) return length_mm / kRapidGuess_mm_per_s;
    if (!(block.feed > 0)) return 0;
    return block.feed_meaning == FeedMeaning::kInverseTime ? 1 / block.feed
                                                           : length_mm / block.feed;
  }

 private:
  Vector3 tip_ = Vector3::Zero();
  bool has_tip_ = false;
};

/// Checks the blocks of a file and goes on behind those that are refused.
class BlockFindings {
 public:
  BlockFindings(const PreflightMachine& machine, std::string file)
      : machine_(machine),
        file_(std::move(file)),
        check_(machine.model, machine.tools ? lengths_of(*machine.tools) : ToolLengths()) {}

  void check(ClBlock block, cl::Findings& findings) {
    const bool is_tool = block.kind == BlockKind::kTool;
    if (is_tool && !machine_.tools) return;
    // An arc is checked from the end of the block before it, which must have been checked.
    const bool lacks_begin = block.is_arc && !is_begin_checked_;
    if (is_motion(block.kind) && (!is_tool_known_ || lacks_begin)) {
      is_begin_checked_ = false;
      return;
    }
    const BlockReject verdict = check_.check(block, {.is_there = true});
    const bool passes = verdict.code == RejectCode::kNone;
    if (is_tool) is_tool_known_ = passes;
    if (is_motion(block.kind)) is_begin_checked_ = passes;
    if (!passes) findings.add(finding(verdict));
  }
  /// A statement was refused: where the tool is then nobody knows.
  void lose_position() { is_begin_checked_ = false; }

  /// What the check changed in blocks that pass.
  void add_changes(cl::Findings& findings) const {
    if (check_.feeds_limited() > 0) {
      findings.add(cl::ClWarning{check_.first_limited_line(),
                                 "a feed above the machine's, which will be limited to it",
                                 check_.feeds_limited()});
    }
    if (check_.poses_rounded() > 0) {
      findings.add(cl::ClWarning{check_.first_rounded_line(),
                                 "a position beyond travel by no more than 1 um or 1e-4 deg: taken "
                                 "to the end of travel",
                                 check_.poses_rounded()});
    }
  }

 private:
  [[nodiscard]] cl::ClError finding(const BlockReject& verdict) const {
    const MachineModel& model = machine_.model;
    cl::ClError error{file_, verdict.line, reason_of(verdict, model), {}, {}, false};
    if (verdict.code == RejectCode::kUnknownTool) {
      error.group = error.message =
          "tool " + std::to_string(static_cast<long>(verdict.value)) + " is not in the tool table";
      error.remedy = machine_.tool_remedy;
    }
    if (verdict.code == RejectCode::kTravel && verdict.joint >= 0) {
      error.group = "travel of " + limited_spec(model, verdict.joint).name;
    }
    if (verdict.code == RejectCode::kKeepOut) {
      error.group = std::string("keep-out box ") + model.keep_out.name_of(verdict.value);
    }
    if (verdict.code == RejectCode::kTipBox) error.group = "the tip box";
    return error;
  }

  const PreflightMachine& machine_;
  std::string file_;
  BlockCheck check_;
  bool is_tool_known_ = true, is_begin_checked_ = true;
};

PreflightReport not_opened() {
  PreflightReport report;
  report.is_refused = true;
  report.findings.push_back({cl::Finding::Severity::kRefusal, 0, "cannot be opened",
                             "check the path and the right to read it", 1});
  return report;
}

}  // namespace

PreflightReport preflight(const std::string& file, const cl::ClReaderOptions& options,
                          const std::optional<PreflightMachine>& machine) {
  std::ifstream input(file, std::ios::binary);
  if (!input) return not_opened();
  PreflightReport report;
  cl::ClReader reader(input, file, options);
  cl::Findings findings;
  std::optional<BlockFindings> check;
  if (machine) check.emplace(*machine, file);
  IdealTime ideal;
  while (true) {
    auto next = reader.next();
    if (!next) {
      findings.add(next.error());
      if (check) check->lose_position();
      if (!reader.go_on()) break;
      continue;
    }
    if (!*next) break;
    ClBlock block = **next;
    block.sequence = report.blocks;
    if (check) check->check(block, findings);
    report.contains_actions = report.contains_actions || is_action(block.kind);
    report.times.append(ideal.of(block));
    ++report.blocks;
  }
  for (const cl::ClWarning& warning : reader.warnings()) findings.add(warning);
  if (check) check->add_changes(findings);
  report.is_refused = findings.is_refused();
  report.findings = findings.sorted();
  return report;
}

std::vector<int> unknown_tools(const std::string& file, const cl::ClReaderOptions& options,
                               const ToolTable& tools) {
  std::ifstream input(file, std::ios::binary);
  cl::ClReader reader(input, file, options);
  std::vector<int> unknown;
  while (true) {
    const auto next = reader.next();
    if (!next && !reader.go_on()) break;
    if (!next) continue;
    if (!*next) break;
    if ((*next)->kind != BlockKind::kTool) continue;
    const int number = static_cast<int>((*next)->value);
    const bool is_there = tools.find(number) != nullptr ||
                          std::find(unknown.begin(), unknown.end(), number) != unknown.end();
    if (!is_there) unknown.push_back(number);
  }
  return unknown;
}

}  // namespace meridian::stream
