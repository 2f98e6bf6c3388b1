// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/calibrate/unit_slips.hpp"

#include <algorithm>
#include <string_view>

#include "meridian/kinematics/limited.hpp"
#include "service/machine/inspect/joint_unit.hpp"
#include "service/text/printed.hpp"

namespace meridian::inspect {
namespace {

using text::printed;

constexpr double kMinTravel_mm = 50, kMinTravel_deg = 8;  // 1.2 m in inch, 450 deg in rad
constexpr double kMinTurn_deg_per_s = 4;                  // 230 deg/s in rad/s
constexpr double kMaxRun = 4;     // of the travel, for full velocity and back to rest
constexpr double kMaxRatio = 12;  // between the velocities of slides: m/min beside mm/s is 16.7
constexpr double kMaxFollowing = 0.2;     // of the travel
constexpr double kMaxFollowing_deg = 30;  // of a joint that turns without end

void look_at_times(const MachineModel& model, std::vector<std::string>& out) {
  constexpr double kLongest_s = 10;
  const double cycle_s = 1e-9 * static_cast<double>(model.cycle_ns);
  for (int i = 0; i < limited_count(model); ++i) {
    const JointSpec& joint = limited_spec(model, i);
    const double to_speed = joint.limits.velocity / joint.limits.acceleration;
    const double to_push = joint.limits.acceleration / joint.limits.jerk;
    if (to_speed > kLongest_s) {
      out.push_back(printed("%s takes %.3g s to its full velocity: are the units right?",
                            joint.name.c_str(), to_speed));
    }
    if (to_push > kLongest_s || to_push < cycle_s) {
      out.push_back(
          printed("%s takes %.3g s to its full acceleration, a cycle being %.3g s: are the "
                  "units right?",
                  joint.name.c_str(), to_push, cycle_s));
    }
  }
}

void look_at_travel(const JointSpec& joint, std::vector<std::string>& out) {
  const JointLimits& limits = joint.limits;
  const char* const name = joint.name.c_str();
  const char* const unit = unit_of(joint);
  const double travel = at_edge(joint, limits.travel_max - limits.travel_min);
  const double run = at_edge(joint, limits.velocity * limits.velocity / limits.acceleration);
  const double following = at_edge(joint, limits.following_error);
  if (travel < (joint.is_rotary ? kMinTravel_deg : kMinTravel_mm)) {
    out.push_back(printed("%s has a travel of %.4g %s: is the unit right?", name, travel, unit));
    return;
  }
  if (run > kMaxRun * travel) {
    out.push_back(
        printed("%s needs %.4g %s to its full velocity and back to rest, its travel is %.4g %s: "
                "are the units right?",
                name, run, unit, travel, unit));
  }
  if (following > kMaxFollowing * travel) {
    out.push_back(
        printed("the following error of %s, %.4g %s, is %.2g of its travel: is the unit "
                "right?",
                name, following, unit, following / travel));
  }
}

void look_at_turn(const JointSpec& joint, std::vector<std::string>& out) {
  const double velocity = at_edge(joint, joint.limits.velocity);
  const double following = at_edge(joint, joint.limits.following_error);
  if (velocity < kMinTurn_deg_per_s) {
    out.push_back(printed("%s turns by %.3g deg/s at most: is the unit right?", joint.name.c_str(),
                          velocity));
  }
  if (joint.is_endless && following > kMaxFollowing_deg) {
    out.push_back(printed("the following error of %s is %.4g deg: is the unit right?",
                          joint.name.c_str(), following));
  }
}

/// A slide whose velocity is written in another unit than those of the others.
void look_at_slides(const MachineModel& model, std::vector<std::string>& out) {
  const JointSpec *slow = nullptr, *fast = nullptr;
  for (int i = 0; i < model.joint_count; ++i) {
    const JointSpec& joint = model.joints[static_cast<std::size_t>(i)];
    if (joint.is_rotary) continue;
    if (slow == nullptr || joint.limits.velocity < slow->limits.velocity) slow = &joint;
    if (fast == nullptr || joint.limits.velocity > fast->limits.velocity) fast = &joint;
  }
  if (slow == nullptr || !(fast->limits.velocity > kMaxRatio * slow->limits.velocity)) return;
  out.push_back(printed("%s is %.3g times as fast as %s: are the units of both right?",
                        fast->name.c_str(), fast->limits.velocity / slow->limits.velocity,
                        slow->name.c_str()));
}

std::string_view word_of(const JointSpec& joint) {
  std::string_view word = joint.nc_word.empty() ? joint.name : joint.nc_word;
  if (word.starts_with('-')) word.remove_prefix(1);
  return word;
}

void look_at_words(const MachineModel& model, std::vector<std::string>& out) {
  const auto end = model.joints.begin() + model.joint_count;
  for (auto joint = model.joints.begin(); joint != end; ++joint) {
    const auto other = std::find_if(
        joint + 1, end, [&](const JointSpec& later) { return word_of(later) == word_of(*joint); });
    if (other == end) continue;
    out.push_back(printed("%s and %s have one word in NC programs, %s: check nc_word",
                          joint->name.c_str(), other->name.c_str(),
                          std::string(word_of(*joint)).c_str()));
  }
}

}  // namespace

void find_unit_slips(const MachineModel& model, std::vector<std::string>& warnings) {
  look_at_times(model, warnings);
  for (int i = 0; i < model.joint_count; ++i) {
    const JointSpec& joint = model.joints[static_cast<std::size_t>(i)];
    if (!joint.is_endless) look_at_travel(joint, warnings);
    if (joint.is_rotary) look_at_turn(joint, warnings);
  }
  look_at_slides(model, warnings);
  look_at_words(model, warnings);
}

}  // namespace meridian::inspect
