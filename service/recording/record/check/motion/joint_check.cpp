// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/check/motion/joint_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "meridian/kinematics/kinematics.hpp"

namespace meridian::record {
namespace {

constexpr double kRelative = 1e-6;
constexpr double kRoundings = 8;
constexpr double kTravelMargin = 1e-9;
constexpr double kOutside = 1e-11;     // rounding of a joint that stands outside its soft limits
constexpr double kStageFit_mm = 1e-9;  // rounding there and back is 1e-12
constexpr const char* kRateNames[] = {"velocity", "acceleration", "jerk"};

[[nodiscard]] double spacing(double value) noexcept {
  return std::nextafter(value, std::numeric_limits<double>::infinity()) - value;
}

}  // namespace

JointCheck::JointCheck(const MachineModel& model, const LimitedVector& largest,
                       std::span<const LimitsFrom> soft_limits)
    : model_(model),
      soft_limits_(soft_limits),
      period_(static_cast<double>(model.cycle_ns) * 1e-9) {
  for (int i = 0; i < limited_count(model); ++i) ulp_[i] = spacing(std::abs(largest[i]));
}

void JointCheck::note(Excess& excess, double use, bool is_over) const {
  if (is_over) excess.add(use, rows_.back().cycle, rows_.back().line);
}

void JointCheck::check_rates(int joint) {
  const auto q = [this, joint](int back) { return rows_[kDepth - 1 - back].positions[joint]; };
  const JointLimits& limits = limited_spec(model_, joint).limits;
  // Differences reach back over `order` rows; a FaultStop among them has its own limits.
  bool is_fault = false;
  double power = 1;
  for (int order = 1; order <= 3 && run_ > order; ++order) {
    power *= period_;
    is_fault = false;
    for (int back = 0; back <= order; ++back) {
      is_fault |= (rows_[kDepth - 1 - back].flags & kSetpointFaultStop) != 0;
    }
    const double difference = order == 1   ? q(0) - q(1)
                              : order == 2 ? q(0) - 2 * q(1) + q(2)
                                           : q(0) - 3 * q(1) + 3 * q(2) - q(3);
    const double limit = order == 1   ? limits.velocity
                         : order == 2 ? (is_fault ? limits.fault_acceleration : limits.acceleration)
                                      : (is_fault ? limits.fault_jerk : limits.jerk);
    const double rate = std::abs(difference) / power;
    const double allowed = limit * (1 + kRelative) + kRoundings * ulp_[joint] / power;
    Peak& peak = order == 1   ? use_[joint].velocity
                 : order == 2 ? use_[joint].acceleration
                              : use_[joint].jerk;
    peak.raise(rate / limit, rows_.back().cycle, rows_.back().line);
    note(over_[joint][order - 1], rate / limit, rate > allowed);
  }
}

/// Inside the travel of the machine, and inside the soft limits of this cycle or no farther out
/// than the cycle before.
void JointCheck::check_travel(int joint) {
  const double q = rows_.back().positions[joint];
  const JointLimits& whole = limited_spec(model_, joint).limits;
  const double beyond = std::max(whole.travel_min - q, q - whole.travel_max);
  if (beyond > kTravelMargin) return note(outside_[joint], beyond, true);
  const bool is_joint = joint < model_.joint_count;
  if (!is_joint || soft_limits_.empty() || soft_limits_.front().cycle > rows_.back().cycle) return;
  const SoftLimits::Row& soft = soft_limits_.front().limits.rows()[static_cast<std::size_t>(joint)];
  if (!soft.is_set || run_ < 2) return;
  const auto outside = [&soft](double at) { return std::max(soft.min - at, at - soft.max); };
  const double before = outside(rows_[kDepth - 2].positions[joint]);
  note(outside_[joint], outside(q), outside(q) > std::max(kTravelMargin, before + kOutside));
}

/// Outside of every box, or no deeper inside than the cycle before.
void JointCheck::check_keep_out(const KeepOut& keep_out) {
  constexpr double kInside = 2 * kKeepOutRounding;  // what the guard lets pass
  for (const KeepOutBox& box : keep_out.boxes()) {
    const double depth = depth_inside(box, rows_.back().joints);
    const double before = run_ < 2 ? 0 : depth_inside(box, rows_[kDepth - 2].joints);
    note(in_box_, depth, depth > std::max(kInside, before + kOutside));
  }
}

/// Over three consecutive cycles the sent velocity of the middle one differs from the central
/// difference by no more than jerk·T²/6.
void JointCheck::check_velocity(int joint) {
  if (run_ < 3) return;
  const RecordingRow& before = rows_[kDepth - 3];
  const RecordingRow& middle = rows_[kDepth - 2];
  const RecordingRow& after = rows_[kDepth - 1];
  const JointLimits& limits = limited_spec(model_, joint).limits;
  const bool is_fault = ((before.flags | middle.flags | after.flags) & kSetpointFaultStop) != 0;
  const double jerk = is_fault ? limits.fault_jerk : limits.jerk;
  const double central = (after.positions[joint] - before.positions[joint]) / (2 * period_);
  const double error = std::abs(middle.velocity[joint] - central);
  const double bound = jerk * period_ * period_ / 6;
  const double allowed =
      bound * (1 + kRelative) + kRoundings * ulp_[joint] / period_ + 1e-9 * std::abs(central);
  sent_peak_.raise(error / bound, middle.cycle, middle.line);
  note(sent_[joint], error / bound, error > allowed);
}

/// The recorded drives are those of the recorded joints, to rounding; how near a dead point was.
/// Before drives are led nobody may know yet where they are.
void JointCheck::check_stage(const RecordingRow& row) {
  const LimitedVector wanted = limited_of(model_, row.joints);
  double apart = 0;
  for (int i = model_.joint_count; i < limited_count(model_); ++i) {
    apart = std::max(apart, std::abs(row.positions[i] - wanted[i]));
  }
  stage_use_.apart_mm.raise(apart, row.cycle, row.line);
  note(unfit_, apart, !(apart <= kStageFit_mm));
  const double determinant = std::abs(stage::determinant(model_.stage, row.joints));
  stage_use_.determinant_mm =
      has_led_ ? std::min(stage_use_.determinant_mm, determinant) : determinant;
  has_led_ = true;
}

void JointCheck::add(const RecordingRow& row, bool has_velocity) {
  const bool is_next = has_row_ && row.cycle == rows_.back().cycle + 1;
  // While drives home themselves their setpoint is where they are, and jumps where that is found;
  // they still do where that is given up.
  const bool is_given_up = row.state == State::kAborting || row.state == State::kFaultStop;
  is_homing_ = row.state == State::kHoming || (is_homing_ && is_given_up);
  const bool is_enabled = is_leading(row.flags) && !is_homing_;
  std::rotate(rows_.begin(), rows_.begin() + 1, rows_.end());
  rows_.back() = row;
  while (soft_limits_.size() > 1 && soft_limits_[1].cycle <= row.cycle) {
    soft_limits_ = soft_limits_.subspan(1);
  }
  run_ = !is_enabled ? 0 : is_next ? std::min(run_ + 1, kDepth) : 1;
  if ((row.flags & kSetpointFaultStop) != 0) ++fault_rows_;
  if ((row.flags & kSetpointDryEnabled) != 0) ++dry_rows_;
  if (has_stage(model_) && is_leading(row.flags)) check_stage(row);
  if (is_enabled) {
    check_keep_out(model_.keep_out);
    const bool is_known = !soft_limits_.empty() && soft_limits_.front().cycle <= row.cycle;
    if (is_known) check_keep_out(soft_limits_.front().limits.keep_out());
  }
  for (int i = 0; i < limited_count(model_); ++i) {
    const double q = row.positions[i];
    const JointSpec& spec = limited_spec(model_, i);
    use_[i].low = has_row_ ? std::min(use_[i].low, q) : q;
    use_[i].high = has_row_ ? std::max(use_[i].high, q) : q;
    if (!spec.is_endless && is_enabled) check_travel(i);
    check_rates(i);
    if (has_velocity) check_velocity(i);
  }
  has_row_ = true;
}

void JointCheck::finish(CheckReport& report) const {
  char text[256];
  report.joint_count = limited_count(model_);
  report.has_stage = has_stage(model_);
  report.stage = stage_use_;
  if (unfit_.count > 0) {
    std::snprintf(text, sizeof text, "the drives are up to %.6g mm from where the joints put them",
                  unfit_.worst.value);
    report.findings.push_back(
        {Finding::Kind::kStage, text, unfit_.worst.cycle, unfit_.worst.line, unfit_.count});
  }
  if (in_box_.count > 0) {
    std::snprintf(text, sizeof text,
                  "the joints are inside of a keep-out box by up to %.6g mm or rad",
                  in_box_.worst.value);
    report.findings.push_back(
        {Finding::Kind::kTravel, text, in_box_.worst.cycle, in_box_.worst.line, in_box_.count});
  }
  report.fault_stop_cycles = fault_rows_;
  report.dry_cycles = dry_rows_;
  report.sent_velocity = sent_peak_;
  for (int i = 0; i < report.joint_count; ++i) {
    const JointSpec& joint = limited_spec(model_, i);
    report.joint_names[i] = joint.name;
    report.is_rotary[i] = joint.is_rotary;
    report.joints[i] = use_[i];
    for (int order = 0; order < 3; ++order) {
      const Excess& excess = over_[i][order];
      if (excess.count == 0) continue;
      std::snprintf(text, sizeof text, "%s of %s is %.6f x its limit in %llu cycles",
                    kRateNames[order], joint.name.c_str(), excess.worst.value,
                    static_cast<unsigned long long>(excess.count));
      const auto kind =
          static_cast<Finding::Kind>(static_cast<int>(Finding::Kind::kVelocity) + order);
      report.findings.push_back({kind, text, excess.worst.cycle, excess.worst.line, excess.count});
    }
    if (outside_[i].count > 0) {
      std::snprintf(text, sizeof text, "%s is outside its travel by up to %.6g %s",
                    joint.name.c_str(), outside_[i].worst.value, joint.is_rotary ? "rad" : "mm");
      report.findings.push_back({Finding::Kind::kTravel, text, outside_[i].worst.cycle,
                                 outside_[i].worst.line, outside_[i].count});
    }
    if (sent_[i].count > 0) {
      std::snprintf(
          text, sizeof text,
          "sent velocity of %s does not fit its positions (%.3g x what its jerk explains)",
          joint.name.c_str(), sent_[i].worst.value);
      report.findings.push_back({Finding::Kind::kSentVelocity, text, sent_[i].worst.cycle,
                                 sent_[i].worst.line, sent_[i].count});
    }
  }
}

}  // namespace meridian::record
