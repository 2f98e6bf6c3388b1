// SPDX-License-Identifier: Apache-2.0
#include "service/stream/preflight.hpp"

#include <cmath>
#include <fstream>

#include "service/cl/cl_reader.hpp"
#include "service/stream/block_judge.hpp"

namespace meridian::stream {

namespace {

constexpr double kRapidGuess_mm_per_s = 200;  // for times to go only

bool is_action(BlockKind kind) {
  return kind == BlockKind::kAuxiliary || kind == BlockKind::kTool || kind == BlockKind::kStop;
}

ToolLengths lengths_of(const PreflightMachine& machine) {
  ToolLengths lengths;
  if (!machine.tools) return lengths;
  for (const Tool& tool : machine.tools->tools()) {
    lengths[static_cast<std::uint32_t>(tool.number)] = tool.length_mm;
  }
  return lengths;
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

}  // namespace

PreflightReport preflight(const std::string& file, const cl::ClReaderOptions& options,
                          const std::optional<PreflightMachine>& machine) {
  PreflightReport report;
  std::ifstream input(file, std::ios::binary);
  if (!input) {
    report.refusal = file + ": cannot be opened; check the path and the right to read it";
    return report;
  }
  cl::ClReader reader(input, file, options);
  const MachineModel model = machine ? machine->model : MachineModel{};
  BlockJudge judge(model, machine ? lengths_of(*machine) : ToolLengths{});
  const bool has_tools = machine && machine->tools;
  IdealTime ideal;
  while (true) {
    auto next = reader.next();
    if (!next) {
      report.refusal = next.error().text();
      break;
    }
    if (!*next) break;
    ClBlock block = **next;
    block.sequence = report.blocks;
    const bool is_judged = machine && (has_tools || block.kind != BlockKind::kTool);
    if (is_judged) {
      const BlockReject verdict = judge.judge(block, {.is_there = true});
      if (verdict.code != RejectCode::kNone) {
        report.refusal = file + ": " + describe(verdict, model);
        break;
      }
    }
    report.contains_actions = report.contains_actions || is_action(block.kind);
    report.times.append(ideal.of(block));
    ++report.blocks;
  }
  report.warnings = reader.warnings();
  if (judge.feeds_limited() > 0) {
    report.warnings.push_back(
        {judge.first_limited_line(), "feeds of " + std::to_string(judge.feeds_limited()) +
                                         " blocks are above the machine's and will be limited"});
  }
  return report;
}

}  // namespace meridian::stream
