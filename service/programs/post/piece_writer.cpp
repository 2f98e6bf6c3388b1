// SPDX-License-Identifier: Apache-2.0
#include "service/programs/post/piece_writer.hpp"

#include <algorithm>
#include <cmath>

#include "meridian/path/build_piece.hpp"
#include "meridian/path/pose_at.hpp"
#include "service/programs/post/drive_line.hpp"
#include "service/programs/post/tip_frame.hpp"

namespace meridian::post {
namespace {

constexpr double kMinStep = 1e-6;       // of a joint move
constexpr double kLongestBlock_s = 30;  // keeps four digits of a feed in inverse time

}  // namespace

double PieceWriter::min_time(const JointVector& a, const JointVector& b) const {
  const MachineModel& model = parts_.model;
  const DriveLine line = bound_drive_line(model, a, b);
  double longest = 0;
  for (int i = 0; i < model.joint_count; ++i) {
    longest = std::max({longest, line.rate[i] / model.joints[i].limits.velocity,
                        std::abs(b[i] - a[i]) / drive_spec(model, i).limits.velocity});
  }
  return longest;
}

void PieceWriter::write_joint_move(const PathPiece& piece) {
  const MachineModel& model = parts_.model;
  const auto axes_at = [&](double share) {
    JointVector q = piece.joints_begin;
    for (int i = 0; i < model.joint_count; ++i) q[i] += share * (piece.joints_end[i] - q[i]);
    return parts_.words.as_written(drives_of(model, q));
  };
  const auto keeps = [&](const JointVector& a, const JointVector& b) {
    const DriveLine line = bound_drive_line(model, a, b);
    for (int i = 0; i < model.joint_count; ++i) {
      const double allowed = model.joints[i].is_rotary ? tolerance_.axis_rad : tolerance_.chord_mm;
      if (!line.is_known || line.bend[i] / 8 > allowed) return false;
    }
    return true;
  };
  double step = 1;
  for (double share = 0; share < 1;) {
    step = std::min(step, 1 - share);
    const JointVector next = axes_at(share + step);
    if (step > kMinStep && !keeps(stands_at_, next)) {
      step /= 2;
      continue;
    }
    share += step;
    step *= 2;
    Target target;
    target.axes = stands_at_ = next;
    program_.rapid(target);
  }
}

Refusal PieceWriter::write(const PlannedPiece& planned_piece, const ClBlock& block,
                           double block_length) {
  const PathPiece& piece = planned_piece.piece;
  if (piece.kind == PathKind::kTurn && program_.motion() == BlockMotion::kTipAndAxis) {
    skip(piece);
    return {};
  }
  const bool is_rapid = planned_piece.feed_mm_per_s == 0;
  if (piece.kind == PathKind::kJoint) {
    write_joint_move(piece);
    return {};
  }
  const double feed = is_rapid ? parts_.options.rapid_feed_mm_per_s : planned_piece.feed_mm_per_s;
  const double tip_mm = tip_length(piece);
  double piece_s = feed > 0 ? tip_mm / feed : 0;
  if (block.feed_meaning == FeedMeaning::kInverseTime && block_length > 0 && is_of_block(piece)) {
    piece_s = std::max(piece_s, path_length(piece) / block_length / block.feed);
  }
  const auto duration = [&](const BlockEnd& from, const BlockEnd& to) {
    return std::max(piece_s * (to.share - from.share), min_time(from.axes, to.axes));
  };
  const bool has_mm_per_min = program_.motion() != BlockMotion::kDrives;
  const bool is_timed = block.feed_meaning == FeedMeaning::kInverseTime && !is_rapid;
  if (has_mm_per_min && is_timed && tip_mm == 0 && piece.kind != PathKind::kTurn) {
    return PostError{block.line,
                     "a turn with the tip at rest in inverse time has no feed in mm/min; "
                     "--dialect joints can write it"};
  }
  // What a feed in mm/min can say of the block's time. A timed block's turn on the pole has none.
  double tip_feed = piece_s > 0 && tip_mm > 0 ? tip_mm / piece_s : feed;
  if (is_timed && piece.kind == PathKind::kTurn) tip_feed = parts_.model.approach_feed_mm_per_s;
  const bool is_g0 = is_rapid && parts_.options.rapid_feed_mm_per_s == 0;
  BlockEnd from{0, stands_at_};
  const auto is_short_enough = [&](const BlockEnd& a, const BlockEnd& b) {
    return is_g0 || has_mm_per_min || duration(a, b) <= kLongestBlock_s;
  };
  const auto write = [&](const BlockEnd& to) {
    Target target;
    target.axes = to.axes;
    target.pose = in_program(parts_.model, pose_at(piece, to.share * piece.length));
    target.duration_s = duration(from, to);
    target.feed_mm_per_s = tip_feed;
    if (is_g0) {
      program_.rapid(target);
    } else if (target.duration_s > 0 || has_mm_per_min) {
      program_.cut(target);
    }
    from = to;
  };
  const bool is_cut = cutter_.cut(piece, stands_at_, is_short_enough, write);
  stands_at_ = from.axes;
  if (is_cut) return {};
  return PostError{block.line,
                   "the tolerance cannot be kept by blocks with these decimals; raise --chord-mm "
                   "or --axis-deg"};
}

}  // namespace meridian::post
