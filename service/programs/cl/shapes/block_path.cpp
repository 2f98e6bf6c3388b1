// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/shapes/block_path.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>

#include "meridian/units.hpp"
#include "service/programs/cl/text/written_text.hpp"

namespace meridian::cl {
namespace {

constexpr double kLargestInchPart_mm = 1000;  // inch files beyond it are suspected of being metric
constexpr double kFastInch_mm_per_s = 20000.0 / 60.0;

}  // namespace

bool BlockPath::has_moved() const noexcept {
  const auto& count = summary_.blocks_by_kind;
  return count[static_cast<std::size_t>(BlockKind::kCut)] +
             count[static_cast<std::size_t>(BlockKind::kRapid)] >
         0;
}

ClBlock BlockPath::block(BlockKind kind, std::uint32_t line) const {
  ClBlock b;
  b.line = line;
  b.kind = kind;
  b.tip_mm = to_array(tip_);
  b.axis = to_array(axis_);
  return b;
}

void BlockPath::emit(ClBlock b) {
  b.sequence = sequence_++;
  ++summary_.blocks;
  ++summary_.blocks_by_kind[static_cast<std::size_t>(b.kind)];
  out_->push_back(b);
}

void BlockPath::act(BlockKind kind, ActionKind what, double value, std::uint32_t line) {
  ClBlock b = block(kind, line);
  b.action = what;
  b.value = value;
  emit(b);
}

void BlockPath::vendor_word(std::string_view text, double value, std::uint32_t line) {
  ClBlock b = block(BlockKind::kAuxiliary, line);
  b.action = ActionKind::kVendorWord;
  b.value = value;
  std::memcpy(b.text, text.data(), std::min(text.size(), sizeof b.text - 1));
  emit(b);
}

void BlockPath::set_from(const Vector3& tip, const Vector3& axis, std::uint32_t line) {
  const bool is_there =
      position_ == Position::kReached && (tip - tip_).norm() <= kMinMove_mm && axis == axis_;
  if (is_there) return;
  if (has_moved()) {
    remarks_.warn("FROM", line, [] {
      return "FROM after motion: taken as the new position, without motion to it";
    });
  }
  from_line_ = line;
  tip_ = tip;
  axis_ = axis;
  position_ = Position::kReported;
  direction_.setZero();
}

/// A cut from the FROM point: a rapid brings the tool there first. After motion that ended
/// elsewhere the file does not show how it comes there.
Outcome BlockPath::begin_at_from(std::uint32_t line) {
  if (has_moved()) {
    return refuse_at(from_line_,
                     "FROM is not where the motion before it ended, and a cut begins there",
                     "write RAPID and a GOTO to that point");
  }
  const ClBlock begin = block(BlockKind::kRapid, line);
  account_axis(axis_, 0);
  position_ = Position::kUnknown;
  emit_motion(begin, 0);
  return {};
}

Outcome BlockPath::line_to(const Vector3& tip, const Vector3& axis, const MotionFeed& feed,
                           std::uint32_t line) {
  if (position_ == Position::kReported && feed.kind != BlockKind::kRapid) {
    const bool is_there = (tip - tip_).norm() <= kMinMove_mm && axis == axis_;
    if (has_moved() || !is_there) {
      if (auto done = begin_at_from(line); !done) return done;
    }
  }
  ClBlock b;
  b.line = line;
  b.kind = feed.kind;
  b.feed_meaning = feed.meaning;
  b.feed = feed.feed;
  const Vector3 step = tip - tip_;
  const double length = position_ == Position::kReached ? step.norm() : 0;
  direction_ = length > kMinMove_mm ? Vector3(step / length) : Vector3::Zero();
  b.tip_mm = to_array(tip);
  b.axis = to_array(axis);
  emit_motion(b, length);
  return {};
}

/// An inch file whose part would be beyond a metre, or whose feed beyond 20 m/min, is likely a
/// metric one with the wrong unit word.
void BlockPath::suspect_metric(const ClBlock& b) {
  double extent = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    extent = std::max(extent, summary_.box_max_mm[i] - summary_.box_min_mm[i]);
  }
  const bool fast = b.feed_meaning == FeedMeaning::kTip && b.feed > kFastInch_mm_per_s;
  if (extent <= kLargestInchPart_mm && !fast) return;
  summary_.is_suspected_metric = true;
  remarks_.warn("metric", b.line, [&] {
    return fast ? "inch, but the feed comes to " + short_number(units::per_min_from_per_s(b.feed)) +
                      " mm/min: plainly metric? (--units mm)"
                : "inch, but the path is " + short_number(extent) +
                      " mm wide: plainly metric? (--units mm)";
  });
}

/// Angles are worked out only where an axis goes beyond all before it.
void BlockPath::account_axis(const Vector3& axis, double change_chord) {
  if (change_chord > change_chord_max_) {
    change_chord_max_ = change_chord;
    summary_.axis_change_max_rad = std::atan2(axis_.cross(axis).norm(), axis_.dot(axis));
  }
  if (axis[2] < axis_z_min_ || axis[2] > axis_z_max_) {
    axis_z_min_ = std::min(axis_z_min_, axis[2]);
    axis_z_max_ = std::max(axis_z_max_, axis[2]);
    const double tilt = std::atan2(std::hypot(axis[0], axis[1]), axis[2]);
    summary_.tilt_min_rad = std::min(summary_.tilt_min_rad, tilt);
    summary_.tilt_max_rad = std::max(summary_.tilt_max_rad, tilt);
  }
}

/// Counts a motion block and gives it out; the tool is at its end then.
void BlockPath::emit_motion(const ClBlock& b, double length) {
  for (std::size_t i = 0; i < 3; ++i) {
    summary_.box_min_mm[i] = std::min(summary_.box_min_mm[i], b.tip_mm[i]);
    summary_.box_max_mm[i] = std::max(summary_.box_max_mm[i], b.tip_mm[i]);
  }
  if (summary_.unit == LengthUnit::kInch && !summary_.is_suspected_metric) suspect_metric(b);
  const Vector3 axis = to_vector(b.axis);
  const Vector3 change = axis - axis_;
  const bool follows = position_ == Position::kReached;
  const bool turns = change != Vector3::Zero();
  if (turns || !follows) account_axis(axis, follows ? change.norm() : 0);
  const bool moves = follows && (length > kMinMove_mm || turns);
  if (follows && !moves) ++summary_.zero_length;
  if (b.kind == BlockKind::kRapid) {
    summary_.rapid_length_mm += length;
  } else {
    summary_.cut_length_mm += length;
    const bool is_inverse = b.feed_meaning == FeedMeaning::kInverseTime;
    if (!is_inverse) summary_.cut_time_s += length / b.feed;
    if (is_inverse && moves) summary_.cut_time_s += 1 / b.feed;
    if (!is_inverse && max_feed_ > 0 && b.feed > max_feed_) ++summary_.feeds_limited;
  }
  emit(b);
  tip_ = to_vector(b.tip_mm);
  axis_ = axis;
  position_ = Position::kReached;
}

}  // namespace meridian::cl
