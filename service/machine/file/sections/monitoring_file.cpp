// SPDX-License-Identifier: Apache-2.0
#include "service/machine/file/sections/monitoring_file.hpp"

#include <cstddef>
#include <string>
#include <vector>

#include "meridian/kinematics/limited.hpp"
#include "meridian/units.hpp"

namespace meridian::config {
namespace {

static_assert(monitoring::kAxes == static_cast<std::size_t>(kMaxJoints));

constexpr double kShareOfFollowingError = 0.2;

[[nodiscard]] double unit_of(const JointSpec& joint) {
  return joint.is_rotary ? units::kDegree_rad : 1.0;
}

/// The joints, or the drives, of a machine in its order.
using Specs = std::vector<JointSpec>;

[[nodiscard]] Specs joints_in(const MachineModel& model) {
  return {model.joints.begin(), model.joints.begin() + model.joint_count};
}

[[nodiscard]] Specs drives_in(const MachineModel& model) {
  Specs drives;
  for (int i = 0; i < model.joint_count; ++i) drives.push_back(drive_spec(model, i));
  return drives;
}

/// A key for what is linear in mm, one for what is rotary in degrees; where the file has neither, a
/// `share` of each following error.
void read_distance(Section& section, const std::string& name, const Specs& specs,
                   double monitoring::AxisLimits::*distance, double share,
                   monitoring::Limits& limits) {
  for (const bool is_rotary : {false, true}) {
    const std::string key = name + (is_rotary ? "_deg" : "_mm");
    const double said = section.number_or(key, 0, {1e-6, 1e4});
    for (std::size_t i = 0; i < specs.size(); ++i) {
      const JointSpec& spec = specs[i];
      if (spec.is_rotary != is_rotary) continue;
      const double otherwise = share * spec.limits.following_error;
      limits.axes[i].*distance = section.has(key) ? said * unit_of(spec) : otherwise;
    }
  }
}

/// One number for each joint in mm or deg; nothing where the file has no such key.
[[nodiscard]] std::vector<double> read_each(Section& section, const std::string& key,
                                            const MachineModel& model) {
  if (!section.has(key)) {
    (void)section.text_or(key, "");  // known, and not there
    return {};
  }
  const auto count = static_cast<std::size_t>(model.joint_count);
  auto numbers = section.numbers(key, count, count, {-1e5, 1e5},
                                 "give each joint, in machine order, a number in mm or deg");
  for (std::size_t i = 0; i < count; ++i) numbers[i] *= unit_of(model.joints[i]);
  return numbers;
}

void refuse_windows(const Section& section, const std::string& key) {
  section.refuse(key, "both ends, each low end below its high end",
                 "give both, or leave both out for the travel of the joints");
}

/// The ends of one window; without them the travel of each joint.
void read_window(Section& section, const std::string& prefix, const MachineModel& model,
                 double monitoring::AxisLimits::*low, double monitoring::AxisLimits::*high,
                 monitoring::Limits& limits) {
  const std::string low_key = prefix + "low_mm_deg", high_key = prefix + "high_mm_deg";
  const auto lows = read_each(section, low_key, model), highs = read_each(section, high_key, model);
  if (lows.empty() != highs.empty()) refuse_windows(section, lows.empty() ? high_key : low_key);
  for (std::size_t i = 0; i < static_cast<std::size_t>(model.joint_count); ++i) {
    const JointSpec& joint = model.joints[i];
    monitoring::AxisLimits& axis = limits.axes[i];
    if (lows.empty()) {
      axis.*low = joint.limits.travel_min;
      axis.*high = joint.limits.travel_max;
      continue;
    }
    if (!(lows[i] < highs[i])) refuse_windows(section, low_key);
    axis.*low = lows[i];
    axis.*high = highs[i];
  }
}

void read_windows(Section& section, const MachineModel& model, monitoring::Limits& limits) {
  using monitoring::AxisLimits;
  for (std::size_t i = 0; i < static_cast<std::size_t>(model.joint_count); ++i) {
    limits.axes[i].has_window = !model.joints[i].is_endless;  // its number of turns has no end
    limits.axes[i].window_margin = model.joints[i].limits.following_error;
  }
  read_window(section, "window_", model, &AxisLimits::low, &AxisLimits::high, limits);
  read_window(section, "set_up_window_", model, &AxisLimits::set_up_low, &AxisLimits::set_up_high,
              limits);
}

/// Models of the drives, where the file says how they lag.
void read_model(Section& section, const MachineModel& model, monitoring::Limits& limits) {
  const int delay = section.integer_or("drive_delay_cycles", 0, 0, 64);
  const auto count = static_cast<std::size_t>(model.joint_count);
  read_distance(section, "model_error", drives_in(model), &monitoring::AxisLimits::model_error,
                kShareOfFollowingError, limits);
  if (!section.has("drive_time_constant_ms")) {
    (void)section.text_or("drive_time_constant_ms", "");  // known, and not there
    return;
  }
  const auto lags = section.numbers("drive_time_constant_ms", count, count, {0, 1e4},
                                    "give each drive, in machine order, its lag");
  for (std::size_t i = 0; i < count; ++i) {
    limits.axes[i].has_model = true;
    limits.axes[i].time_constant_s = lags[i] * 1e-3;
    limits.axes[i].delay_cycles = delay;
  }
}

}  // namespace

monitoring::Limits read_monitoring(Section section, const MachineModel& model) {
  monitoring::Limits limits;
  limits.axis_count = model.joint_count;
  limits.has_stage = has_stage(model);
  limits.cycle_s = static_cast<double>(model.cycle_ns) * 1e-9;
  limits.set_up_tip_speed =
      units::per_s_from_per_min(section.number_or("set_up_tip_mm_per_min", 2000, {1, 1e5}));
  const double linear =
      units::per_s_from_per_min(section.number_or("set_up_linear_mm_per_min", 2000, {1, 1e5}));
  const double rotary =
      units::rad_from_deg(section.number_or("set_up_rotary_deg_per_s", 10, {1e-3, 1e3}));
  limits.guard_stop_s = section.number_or("guard_stop_s", limits.guard_stop_s, {0, 60});
  limits.settle_s = section.number_or("settle_s", limits.settle_s, {0.01, 60});
  for (std::size_t i = 0; i < static_cast<std::size_t>(model.joint_count); ++i) {
    limits.axes[i].speed = model.joints[i].limits.velocity;
    limits.axes[i].drive_speed = drive_spec(model, static_cast<int>(i)).limits.velocity;
    limits.axes[i].set_up_speed = model.joints[i].is_rotary ? rotary : linear;
  }
  read_distance(section, "standstill", joints_in(model), &monitoring::AxisLimits::standstill,
                kShareOfFollowingError, limits);
  read_distance(section, "frozen", drives_in(model), &monitoring::AxisLimits::frozen, 1, limits);
  read_windows(section, model, limits);
  read_model(section, model, limits);
  section.finish();
  return limits;
}

monitoring::Limits load_monitoring(const std::filesystem::path& path, const MachineModel& model) {
  const toml::table table = parse_file(path);
  Section file(path.string(), table);
  return read_monitoring(file.section_or("monitoring"), model);
}

}  // namespace meridian::config
