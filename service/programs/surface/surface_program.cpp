// SPDX-License-Identifier: Apache-2.0
#include "service/programs/surface/surface_program.hpp"

#include <algorithm>
#include <cctype>
#include <string>

#include "service/programs/cl/cl_writer.hpp"

namespace meridian::surface {
namespace {

/// Appends blocks with the feeds of the job.
class Program {
 public:
  explicit Program(const PatchProgram& program) : program_(program) {}

  void action(BlockKind kind, ActionKind what, double value) {
    ClBlock block;
    block.kind = kind;
    block.action = what;
    block.value = value;
    blocks_.push_back(block);
  }

  void cut(const ToolPose& pose, double feed_mm_per_s) {
    ClBlock block = motion(BlockKind::kCut, pose);
    block.feed_meaning = FeedMeaning::kTip;
    block.feed = feed_mm_per_s;
    blocks_.push_back(block);
  }

  /// Rapid to the clearance above the pose.
  void above(const ToolPose& pose) {
    const Vector3 tip = pose.tip + program_.clearance_mm * pose.axis;
    blocks_.push_back(motion(BlockKind::kRapid, {tip, pose.axis}));
  }

  [[nodiscard]] std::vector<ClBlock> take() { return std::move(blocks_); }

 private:
  static ClBlock motion(BlockKind kind, const ToolPose& pose) {
    ClBlock block;
    block.kind = kind;
    block.tip_mm = to_array(pose.tip);
    block.axis = to_array(pose.axis);
    return block;
  }

  const PatchProgram& program_;
  std::vector<ClBlock> blocks_;
};

/// What every reader of APT takes for a name.
std::string part_name(const std::string& name) {
  std::string out;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    out += byte < 128 && std::isprint(byte) != 0 && c != '$' ? static_cast<char>(std::toupper(byte))
                                                             : ' ';
  }
  return out.substr(0, 60);
}

}  // namespace

std::vector<ClBlock> program_of(const PatchJob& job, const SurfacePath& path) {
  const PatchProgram& p = job.program;
  Program program(p);
  if (p.tool_number > 0) {
    program.action(BlockKind::kTool, ActionKind::kToolChange, p.tool_number);
  }
  if (p.spindle_rpm > 0) {
    program.action(BlockKind::kAuxiliary, ActionKind::kSpindleClockwise, p.spindle_rpm);
  }
  const Contact* last = nullptr;
  for (const SurfacePath::Line& line : path.lines) {
    bool is_plunge = last == nullptr || !path.is_zigzag;
    if (is_plunge && last != nullptr) program.above(last->pose);
    if (is_plunge) program.above(line.contacts.front().pose);
    for (const Contact& c : line.contacts) {
      program.cut(c.pose, is_plunge ? p.plunge_feed_mm_per_s : p.feed_mm_per_s);
      is_plunge = false;
    }
    for (const Contact& c : line.crossing) program.cut(c.pose, p.feed_mm_per_s);
    last = &line.contacts.back();
  }
  program.above(last->pose);
  if (p.spindle_rpm > 0) program.action(BlockKind::kAuxiliary, ActionKind::kSpindleOff, 0);
  program.action(BlockKind::kEnd, ActionKind::kNone, 0);
  return program.take();
}

void write_program(const PatchJob& job, const SurfacePath& path, std::string_view source,
                   std::ostream& out) {
  cl::ClWriter writer(out, part_name(job.name));
  writer.note("Made by: meridian surface " + std::string(source));
  for (const ClBlock& block : program_of(job, path)) writer.write(block);
}

}  // namespace meridian::surface
