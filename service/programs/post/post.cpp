// SPDX-License-Identifier: Apache-2.0
#include "service/programs/post/post.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/units.hpp"
#include "service/programs/post/blocks_ahead.hpp"
#include "service/programs/post/controls/nc_text.hpp"
#include "service/programs/post/controls/robot_axes.hpp"
#include "service/programs/post/controls/robot_name.hpp"
#include "service/programs/post/piece_writer.hpp"
#include "service/programs/post/planned_path.hpp"
#include "service/programs/post/program.hpp"
#include "service/programs/post/tip_frame.hpp"

namespace meridian::post {
namespace {

constexpr double kMaxDwell_s = 24 * 3600;

[[nodiscard]] PathTolerance tolerance_of(const MachineModel& model, const PostOptions& options) {
  return {options.chord_mm ? *options.chord_mm : model.tolerances.tip_mm,
          options.axis_rad ? *options.axis_rad : model.tolerances.axis_rad};
}

[[nodiscard]] std::unique_ptr<Program> make_program(const ProgramParts& parts) {
  switch (parts.options.dialect) {
    case Dialect::kFanuc:
      return make_fanuc_program(parts);
    case Dialect::kSiemens:
      return make_siemens_program(parts);
    case Dialect::kHeidenhain:
      return make_heidenhain_program(parts);
    case Dialect::kKrl:
      return make_krl_program(parts);
    case Dialect::kRapid:
      return make_rapid_program(parts);
    case Dialect::kLs:
      return make_ls_program(parts);
    case Dialect::kUrScript:
      return make_urscript_program(parts);
    case Dialect::kJoints:
      break;
  }
  return make_joint_program(parts);
}

/// Why no program can be written in the robot's language; nothing where one can.
[[nodiscard]] Refusal refuse_robot(const ProgramParts& parts) {
  if (parts.options.retract) {
    return PostError{0, "--retract is an NC block, which robots do not have; leave it out"};
  }
  if (auto axes = RobotAxes::of(parts.model, parts.words, parts.options); !axes) {
    return axes.error();
  }
  if (auto name = robot_name(parts.options, parts.name); !name) return name.error();
  return {};
}

/// One program on its way from CL blocks to NC blocks.
class Post {
 public:
  Post(const ToolTable& tools, const ProgramParts& parts)
      : model_(parts.model),
        options_(parts.options),
        program_(make_program(parts)),
        can_retract_(options_.retract || program_->motion() != BlockMotion::kDrives ||
                     parts.retract_sense != 0),
        passed_(model_, tools, program_->motion()),
        writer_(parts, tolerance_of(model_, options_), *program_),
        name_(parts.name) {}

  void begin() {
    const PathTolerance tolerance = tolerance_of(model_, options_);
    program_->begin(
        {"MERIDIAN POST " MERIDIAN_VERSION, "SOURCE " + name_,
         "MACHINE " + model_.name + (model_.version.empty() ? "" : " VERSION " + model_.version),
         "TOOL LENGTH AT THE START " + fixed(model_.tool_length_mm, 3) + " MM",
         "CHORD " + fixed(tolerance.chord_mm, 4) + " MM, AXIS " +
             fixed(units::deg_from_rad(tolerance.axis_rad), 4) + " DEG"});
    retract();
  }

  /// `ahead`: the block and those that follow.
  [[nodiscard]] Refusal take(const ClBlock& block, std::span<const ClBlock> ahead) {
    program_->at_line(block.line);
    if (Refusal refusal = write(block, ahead)) return refusal;
    const std::string why = program_->refusal();
    if (why.empty()) return {};
    return PostError{block.line, why};
  }

  [[nodiscard]] bool is_ended() const noexcept { return is_ended_; }

  [[nodiscard]] NcProgram result() const {
    return {program_->text(), program_->blocks(), motion_blocks_, feeds_limited_};
  }

 private:
  [[nodiscard]] Refusal write(const ClBlock& block, std::span<const ClBlock> ahead) {
    switch (block.kind) {
      case BlockKind::kCut:
      case BlockKind::kRapid:
        return take_motion(block, ahead);
      case BlockKind::kDwell:
        if (!(block.value >= 0 && block.value <= kMaxDwell_s)) {
          return PostError{block.line, "a dwell of " + fixed(block.value, 3) + " s"};
        }
        program_->dwell(block.value);
        return {};
      case BlockKind::kAuxiliary:
        return take_action(block);
      case BlockKind::kTool:
        return take_tool(block);
      case BlockKind::kStop:
      case BlockKind::kOptionalStop:
        program_->stop(block.kind == BlockKind::kOptionalStop);
        return {};
      case BlockKind::kEnd:
        program_->end();
        is_ended_ = true;
        return {};
    }
    return PostError{block.line, "a kind of block that is not known"};
  }

  void retract() {
    if (can_retract_ && !is_retracted_) program_->retract();
    is_retracted_ = true;
  }

  [[nodiscard]] Refusal take_motion(const ClBlock& block, std::span<const ClBlock> ahead) {
    ++motion_blocks_;
    const JointVector before = passed_.joints();
    auto pieces = passed_.plan(block, ahead);
    if (!pieces) return pieces.error();
    if (block.kind == BlockKind::kCut && block.feed_meaning == FeedMeaning::kTip &&
        model_.max_feed_mm_per_s > 0 && block.feed > model_.max_feed_mm_per_s) {
      ++feeds_limited_;
    }
    std::size_t first = 0;
    if (needs_start_) {
      if (const std::string missing = program_->missing(); !missing.empty()) {
        return PostError{block.line, missing};
      }
      first = start(*pieces, before);
    }
    double block_length = 0;
    for (std::size_t n = first; n < pieces->size(); ++n) {
      const PathPiece& piece = (*pieces)[n].piece;
      if (is_of_block(piece)) block_length += path_length(piece);
    }
    const bool is_whole = program_->motion() == BlockMotion::kTipAndAxis && !block.is_arc;
    for (std::size_t n = first; n < pieces->size(); ++n) {
      const PathPiece& piece = (*pieces)[n].piece;
      // Straight with the axis on one great circle: the end says all, the controller does the rest.
      const bool is_last = n + 1 == pieces->size() || (*pieces)[n + 1].piece.motion != piece.motion;
      if (is_whole && (!is_last || piece.kind == PathKind::kTurn)) {
        writer_.skip(piece);
        continue;
      }
      Refusal refusal = writer_.write((*pieces)[n], block, block_length);
      if (refusal) return refusal;
    }
    return {};
  }

  /// The way to where the program begins. Returns the first piece that is still to be run.
  [[nodiscard]] std::size_t start(const std::vector<PlannedPiece>& pieces,
                                  const JointVector& before) {
    needs_start_ = false;
    is_retracted_ = false;
    const auto to = [this](const JointVector& joints) {
      Target target;
      target.axes = writer_.stand_at(joints);
      target.pose = in_program(model_, forward(model_, passed_.tool_length_mm(), joints));
      return target;
    };
    if (!can_retract_) {
      program_->start_at(to(before));
      return 0;
    }
    std::size_t first = 0;
    JointVector over = before;
    for (std::size_t n = 0; n < pieces.size(); ++n) {
      const PathPiece& piece = pieces[n].piece;
      if (piece.kind != PathKind::kJoint || piece.motion != MotionKind::kApproach) continue;
      over = pieces[n].piece.joints_end;
      first = n + 1;
    }
    program_->start(to(over));
    return first;
  }

  [[nodiscard]] Refusal take_action(const ClBlock& block) {
    switch (block.action) {
      case ActionKind::kSpindleOff:
        program_->spindle_off();
        return {};
      case ActionKind::kSpindleClockwise:
      case ActionKind::kSpindleCounterClockwise:
        if (!(block.value >= 0.5)) return PostError{block.line, "the spindle turns at no speed"};
        program_->spindle_on(block.action == ActionKind::kSpindleClockwise, block.value);
        return {};
      case ActionKind::kCoolantOff:
        program_->coolant("M9");
        return {};
      case ActionKind::kCoolantFlood:
        program_->coolant("M8");
        return {};
      case ActionKind::kCoolantMist:
        program_->coolant("M7");
        return {};
      case ActionKind::kCoolantThrough:
        if (options_.through_coolant.empty()) {
          return PostError{block.line,
                           "coolant through the tool has no standard word; give the machine's with "
                           "--through-coolant, such as M88"};
        }
        program_->coolant(options_.through_coolant);
        return {};
      default:
        return PostError{block.line, "the word " + harmless(block.text) +
                                         " is the machine's own and is not translated"};
    }
  }

  [[nodiscard]] Refusal take_tool(const ClBlock& block) {
    const auto pieces = passed_.plan(block, {});
    if (!pieces) return pieces.error();
    retract();
    program_->change_tool(static_cast<int>(std::lround(block.value)));
    passed_.begin_again();
    needs_start_ = true;
    return {};
  }

  const MachineModel& model_;
  const PostOptions& options_;
  std::unique_ptr<Program> program_;
  bool can_retract_;
  PlannedPath passed_;
  PieceWriter writer_;
  std::string name_;
  bool needs_start_ = true, is_retracted_ = false, is_ended_ = false;
  std::uint64_t motion_blocks_ = 0, feeds_limited_ = 0;
};

}  // namespace

Expected<NcProgram, PostError> write_nc(cl::ClReader& reader, const std::string& name,
                                        const MachineModel& model, const ToolTable& tools,
                                        const PostOptions& options) {
  const auto words = AxisWords::of(model);
  if (!words) return tl::make_unexpected(words.error());
  ProgramParts parts{model, *words, options, std::filesystem::path(name).filename().string(),
                     0,     {}};
  if (is_robot_language(options.dialect)) {
    if (auto refusal = refuse_robot(parts)) return tl::make_unexpected(*refusal);
  } else if (options.dialect == Dialect::kJoints) {
    parts.retract_sense = retract_sense(model, *words);
  } else if (has_stage(model)) {
    return tl::make_unexpected(PostError{
        0,
        "machine " + model.name + " has a stage: its sliders " + model.stage_drives[0].name +
            " and " + model.stage_drives[1].name + " carry joints " +
            model.joints[model.stage.linear_joint].name + " and " +
            model.joints[model.stage.rotary_joint].name +
            " together, which no tool-centre control knows; --dialect joints writes its drives"});
  } else {
    const auto zero = find_program_zero(model, *words);
    if (!zero) return tl::make_unexpected(zero.error());
    parts.zero = *zero;
  }
  Post post(tools, parts);
  post.begin();
  BlocksAhead blocks(reader);
  while (true) {
    const auto block = blocks.next();
    if (!block) {
      const cl::ClError& error = block.error();
      return tl::make_unexpected(
          PostError{error.line, error.message + (error.remedy.empty() ? "" : "; " + error.remedy)});
    }
    if (!*block) break;
    if (const Refusal refusal = post.take(**block, blocks.ahead()))
      return tl::make_unexpected(*refusal);
  }
  if (!post.is_ended()) return tl::make_unexpected(PostError{0, "the program has no end"});
  return post.result();
}

}  // namespace meridian::post
