// SPDX-License-Identifier: Apache-2.0
#include "service/post/post.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "meridian/path/build_piece.hpp"
#include "meridian/path/pose_at.hpp"
#include "meridian/units.hpp"
#include "service/post/nc_text.hpp"
#include "service/post/planned_way.hpp"
#include "service/post/program.hpp"

namespace meridian::post {
namespace {

constexpr double kLongestBlock_s = 30;  // keeps four digits of a feed in inverse time
constexpr double kMostDwell_s = 24 * 3600;

/// Nothing, or why not.
using Refusal = std::optional<PostError>;

[[nodiscard]] PathTolerance tolerance_of(const MachineModel& model, const PostOptions& options) {
  return {options.chord_mm ? *options.chord_mm : model.tolerances.tip_mm,
          options.axis_rad ? *options.axis_rad : model.tolerances.axis_rad};
}

/// One program on its way from CL blocks to NC blocks.
class Post {
 public:
  Post(const MachineModel& model, const ToolTable& tools, const PostOptions& options,
       const AxisWords& words)
      : model_(model),
        options_(options),
        words_(words),
        sense_(retract_sense(model, words)),
        can_retract_(options.retract ? true : sense_ != 0),
        program_(make_joint_program({model, words, options, sense_})),
        way_(model, tools),
        cutter_(model, words, program_->motion(), tolerance_of(model, options)) {}

  void begin(const std::string& name) {
    const PathTolerance tolerance = tolerance_of(model_, options_);
    program_->begin(
        {"MERIDIAN POST " MERIDIAN_VERSION,
         "SOURCE " + std::filesystem::path(name).filename().string(),
         "MACHINE " + model_.name + (model_.version.empty() ? "" : " VERSION " + model_.version),
         "TOOL LENGTH AT THE START " + fixed(model_.tool_length_mm, 3) + " MM",
         "CHORD " + fixed(tolerance.chord_mm, 4) + " MM, AXIS " +
             fixed(units::deg_from_rad(tolerance.axis_rad), 4) + " DEG"});
    retract();
  }

  [[nodiscard]] Refusal take(const ClBlock& block) {
    program_->at_line(block.line);
    switch (block.kind) {
      case BlockKind::kCut:
      case BlockKind::kRapid:
        return take_motion(block);
      case BlockKind::kDwell:
        if (!(block.value >= 0 && block.value <= kMostDwell_s)) {
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

  [[nodiscard]] bool is_ended() const noexcept { return is_ended_; }

  [[nodiscard]] NcProgram result() const {
    return {program_->text(), program_->blocks(), motion_blocks_, feeds_limited_};
  }

 private:
  void retract() {
    if (can_retract_ && !is_retracted_) program_->retract();
    is_retracted_ = true;
  }

  [[nodiscard]] Target target_of(const BlockEnd& end, const PathPiece& piece) const {
    const ToolPose pose = pose_at(piece, end.share * piece.length);
    const Eigen::Matrix3d& r = model_.frame_rotation;
    return {end.joints, {r * pose.tip, r * pose.axis}, 0, 0};
  }

  [[nodiscard]] Refusal take_motion(const ClBlock& block) {
    ++motion_blocks_;
    const JointVector before = way_.joints();
    auto pieces = way_.plan(block);
    if (!pieces) return pieces.error();
    if (block.kind == BlockKind::kCut && block.feed_meaning == FeedMeaning::kTip &&
        model_.max_feed_mm_per_s > 0 && block.feed > model_.max_feed_mm_per_s) {
      ++feeds_limited_;
    }
    std::size_t first = 0;
    if (needs_start_) first = start(*pieces, before);
    double way = 0;
    for (std::size_t n = first; n < pieces->size(); ++n) {
      const PathPiece& piece = (*pieces)[n].piece;
      if (piece.motion != MotionKind::kApproach) way += way_length(piece);
    }
    for (std::size_t n = first; n < pieces->size(); ++n) {
      Refusal refusal = take_piece((*pieces)[n], block, way);
      if (refusal) return refusal;
    }
    return {};
  }

  /// The way to where the program begins. Returns the first piece that is still to be run.
  [[nodiscard]] std::size_t start(const std::vector<WayPiece>& pieces, const JointVector& before) {
    needs_start_ = false;
    is_retracted_ = false;
    const auto to = [this](const JointVector& joints) {
      Target target;
      target.joints = joint_words_ = words_.as_written(joints);
      return target;
    };
    if (!can_retract_) {
      program_->start_at(to(before));
      return 0;
    }
    std::size_t first = 0;
    JointVector over = before;
    for (std::size_t n = 0; n < pieces.size(); ++n) {
      if (pieces[n].piece.kind != PathKind::kJoint) continue;
      over = pieces[n].piece.joints_end;
      first = n + 1;
    }
    program_->start(to(over));
    return first;
  }

  [[nodiscard]] Refusal take_piece(const WayPiece& way_piece, const ClBlock& block, double way) {
    const PathPiece& piece = way_piece.piece;
    const bool is_rapid = way_piece.feed_mm_per_s == 0;
    if (piece.kind == PathKind::kJoint) {
      Target target;
      target.joints = joint_words_ = words_.as_written(piece.joints_end);
      program_->rapid(target);
      return {};
    }
    const double feed = is_rapid ? options_.rapid_feed_mm_per_s : way_piece.feed_mm_per_s;
    double piece_s = feed > 0 ? tip_length(piece) / feed : 0;
    if (block.feed_meaning == FeedMeaning::kInverseTime && way > 0 &&
        piece.motion != MotionKind::kApproach) {
      piece_s = std::max(piece_s, way_length(piece) / way / block.feed);
    }
    const auto duration = [&](const BlockEnd& from, const BlockEnd& to) {
      double longest = piece_s * (to.share - from.share);
      for (int i = 0; i < model_.joint_count; ++i) {
        longest = std::max(
            longest, std::abs(to.joints[i] - from.joints[i]) / model_.joints[i].limits.velocity);
      }
      return longest;
    };
    const bool is_g0 = is_rapid && options_.rapid_feed_mm_per_s == 0;
    BlockEnd from{0, joint_words_};
    const auto is_short_enough = [&](const BlockEnd& a, const BlockEnd& b) {
      return is_g0 || duration(a, b) <= kLongestBlock_s;
    };
    const auto write = [&](const BlockEnd& to) {
      Target target = target_of(to, piece);
      target.duration_s = duration(from, to);
      target.feed_mm_per_s = feed;
      if (is_g0) {
        program_->rapid(target);
      } else if (target.duration_s > 0) {
        program_->cut(target);
      }
      from = to;
    };
    const bool is_cut = cutter_.cut(piece, joint_words_, is_short_enough, write);
    joint_words_ = from.joints;
    if (is_cut) return {};
    return PostError{block.line,
                     "the tolerance cannot be kept by blocks with these decimals; raise --chord-mm "
                     "or --axis-deg"};
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
    const auto pieces = way_.plan(block);
    if (!pieces) return pieces.error();
    retract();
    program_->change_tool(static_cast<int>(std::lround(block.value)));
    way_.begin_again();
    needs_start_ = true;
    return {};
  }

  const MachineModel& model_;
  const PostOptions& options_;
  const AxisWords& words_;
  int sense_;
  bool can_retract_;
  std::unique_ptr<Program> program_;
  PlannedWay way_;
  Subdivider cutter_;
  JointVector joint_words_{};  ///< where the program stands
  bool needs_start_ = true, is_retracted_ = false, is_ended_ = false;
  std::uint64_t motion_blocks_ = 0, feeds_limited_ = 0;
};

}  // namespace

Expected<NcProgram, PostError> write_nc(cl::ClReader& reader, const std::string& name,
                                        const MachineModel& model, const ToolTable& tools,
                                        const PostOptions& options) {
  const auto words = AxisWords::of(model);
  if (!words) return tl::make_unexpected(words.error());
  Post post(model, tools, options, *words);
  post.begin(name);
  while (true) {
    const auto block = reader.next();
    if (!block) {
      const cl::ClError& error = block.error();
      return tl::make_unexpected(
          PostError{error.line, error.message + (error.remedy.empty() ? "" : "; " + error.remedy)});
    }
    if (!*block) break;
    if (const Refusal refusal = post.take(**block)) return tl::make_unexpected(*refusal);
  }
  if (!post.is_ended()) return tl::make_unexpected(PostError{0, "the program has no end"});
  return post.result();
}

}  // namespace meridian::post
