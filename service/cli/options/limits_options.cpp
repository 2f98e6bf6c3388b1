// SPDX-License-Identifier: Apache-2.0
#include "service/cli/options/limits_options.hpp"

#include <algorithm>
#include <cstdio>

#include "meridian/units.hpp"
#include "service/text/number.hpp"
#include "service/text/printed.hpp"

namespace meridian::cli {
namespace {

/// Prints what is wrong: nothing.
std::nullopt_t refuse_limits(const std::string& what) {
  std::fprintf(stderr, "meridian: %s\n", what.c_str());
  return std::nullopt;
}

[[nodiscard]] std::optional<double> read_end(const std::string& text, bool is_rotary) {
  double value = 0;
  if (!text::read_finite(text, value)) return std::nullopt;
  return is_rotary ? units::rad_from_deg(value) : value;
}

[[nodiscard]] double shown(double value, bool is_rotary) {
  return is_rotary ? units::deg_from_rad(value) : value;
}

}  // namespace

std::optional<LimitsOrder> limits_order(const std::vector<std::string>& words,
                                        const dds::MachineInfo& machine) {
  const std::string word = words.empty() ? "" : words.front();
  const bool is_set = word == "set" && words.size() == 4;
  const bool is_clear = word == "clear" && words.size() <= 2;
  if (!is_set && !is_clear) {
    return refuse_limits(
        "limits takes set, a joint and both ends of its travel in mm or deg; clear and a joint, or "
        "clear alone for all; or list");
  }
  LimitsOrder order;
  order.word = is_set ? LimitsWord::kSet : LimitsWord::kClear;
  if (words.size() == 1) return order;
  const auto begin = machine.joints.begin(), end = begin + machine.joint_count;
  const auto joint = std::find_if(
      begin, end, [&words](const dds::JointInfo& known) { return known.name == words[1]; });
  if (joint == end) return refuse_limits("machine " + machine.name + " has no joint " + words[1]);
  order.joint = static_cast<std::uint8_t>(joint - begin);
  if (!is_set) return order;
  const auto min = read_end(words[2], joint->is_rotary), max = read_end(words[3], joint->is_rotary);
  if (!min || !max) return refuse_limits("'" + words[min ? 3 : 2] + "' is no number");
  order.min = *min;
  order.max = *max;
  return order;
}

std::string limits_text(const dds::MachineInfo& machine) {
  std::string text;
  for (std::size_t i = 0; i < machine.joint_count; ++i) {
    const dds::JointInfo& joint = machine.joints[i];
    const SoftLimits::Row& row = machine.soft_limits.rows()[i];
    const char* const unit = joint.is_rotary ? "deg" : "mm";
    if (joint.is_endless) {
      text::append(text, "   %-8s endless\n", joint.name.c_str());
      continue;
    }
    const double min = row.is_set ? row.min : joint.limits.travel_min;
    const double max = row.is_set ? row.max : joint.limits.travel_max;
    text::append(text, "%c  %-8s %.10g %.10g %s", row.is_set ? '*' : ' ', joint.name.c_str(),
                 shown(min, joint.is_rotary), shown(max, joint.is_rotary), unit);
    if (row.is_set) {
      text::append(text, ", of %.10g %.10g", shown(joint.limits.travel_min, joint.is_rotary),
                   shown(joint.limits.travel_max, joint.is_rotary));
    }
    text += "\n";
  }
  return text;
}

}  // namespace meridian::cli
