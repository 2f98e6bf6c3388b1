// SPDX-License-Identifier: Apache-2.0
#include "service/cli/options/operator/limits_options.hpp"

#include <algorithm>
#include <cstdio>
#include <string_view>

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

[[nodiscard]] std::nullopt_t refuse_words() {
  return refuse_limits(
      "limits takes set, a joint and both ends of its travel in mm or deg; clear and a joint, or "
      "clear alone for all; keep-out, a name, and a joint with both ends or several of them; open "
      "and a name, or open alone for all; tip and two corners X,Y,Z over the base in mm; clear "
      "tip; "
      "or list");
}

struct Interval {
  std::uint8_t joint = 0;
  double min = 0, max = 0;
};

[[nodiscard]] std::optional<std::uint8_t> joint_named(const std::string& name,
                                                      const dds::MachineInfo& machine) {
  const auto begin = machine.joints.begin(), end = begin + machine.joint_count;
  const auto joint =
      std::find_if(begin, end, [&name](const dds::JointInfo& known) { return known.name == name; });
  if (joint != end) return static_cast<std::uint8_t>(joint - begin);
  return refuse_limits("machine " + machine.name + " has no joint " + name);
}

/// A joint and both ends, from `at` on.
[[nodiscard]] std::optional<Interval> read_interval(const std::vector<std::string>& words,
                                                    std::size_t at,
                                                    const dds::MachineInfo& machine) {
  const auto joint = joint_named(words[at], machine);
  if (!joint) return std::nullopt;
  const bool is_rotary = machine.joints[*joint].is_rotary;
  const auto min = read_end(words[at + 1], is_rotary), max = read_end(words[at + 2], is_rotary);
  if (!min || !max) return refuse_limits("'" + words[at + (min ? 2 : 1)] + "' is no number");
  return Interval{*joint, *min, *max};
}

[[nodiscard]] bool read_box_name(const std::string& name, KeepOutBox& box) {
  if (name.empty() || name.size() > kKeepOutNameChars) return false;
  std::copy(name.begin(), name.end(), box.name.begin());
  return true;
}

[[nodiscard]] std::optional<LimitsOrder> box_order(const std::vector<std::string>& words,
                                                   const dds::MachineInfo& machine) {
  LimitsOrder order;
  order.word = words.front() == "open" ? LimitsWord::kOpen : LimitsWord::kKeepOut;
  if (words.size() > 1 && !read_box_name(words[1], order.box)) {
    return refuse_limits("a box has a name of 1 to " + std::to_string(kKeepOutNameChars) +
                         " characters");
  }
  for (std::size_t at = 2; at + 2 < words.size(); at += 3) {
    const auto interval = read_interval(words, at, machine);
    if (!interval) return std::nullopt;
    if (order.box.has(interval->joint)) return refuse_limits(words[at] + " stands there twice");
    order.box.joints |= 1U << interval->joint;
    order.box.min[interval->joint] = interval->min;
    order.box.max[interval->joint] = interval->max;
  }
  return order;
}

/// Reads "X,Y,Z".
[[nodiscard]] bool read_corner(std::string_view text, JointVector& corner) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t comma = i < 2 ? std::min(text.find(','), text.size()) : text.size();
    if (!text::read_finite(text.substr(0, comma), corner[i])) return false;
    text.remove_prefix(std::min(comma + 1, text.size()));
  }
  return true;
}

[[nodiscard]] std::optional<LimitsOrder> tip_order(const std::vector<std::string>& words) {
  LimitsOrder order;
  order.word = LimitsWord::kTip;
  for (const std::size_t i : {1U, 2U}) {
    if (read_corner(words[i], i == 1 ? order.box.min : order.box.max)) continue;
    return refuse_limits("'" + words[i] + "' is no corner X,Y,Z of a tip box");
  }
  return order;
}

}  // namespace

std::optional<LimitsOrder> limits_order(const std::vector<std::string>& words,
                                        const dds::MachineInfo& machine) {
  const std::string word = words.empty() ? "" : words.front();
  const std::size_t count = words.size();
  const bool is_box = word == "keep-out" && count >= 5 && count % 3 == 2;
  if (is_box || (word == "open" && count <= 2)) return box_order(words, machine);
  if (word == "tip" && count == 3) return tip_order(words);
  if (word == "clear" && count == 2 && words[1] == "tip") return LimitsOrder{LimitsWord::kClearTip};
  const bool is_set = word == "set" && count == 4;
  const bool is_clear = word == "clear" && count <= 2;
  if (!is_set && !is_clear) return refuse_words();
  LimitsOrder order;
  order.word = is_set ? LimitsWord::kSet : LimitsWord::kClear;
  if (count == 1) return order;
  if (is_clear) {
    const auto joint = joint_named(words[1], machine);
    if (!joint) return std::nullopt;
    order.joint = *joint;
    return order;
  }
  const auto interval = read_interval(words, 1, machine);
  if (!interval) return std::nullopt;
  order.joint = interval->joint;
  order.min = interval->min;
  order.max = interval->max;
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
  for (const KeepOutBox& box : machine.soft_limits.keep_out().boxes()) {
    text::append(text, "*  keep-out %s", box.name.data());
    for (std::size_t i = 0; i < machine.joint_count; ++i) {
      if (!box.has(static_cast<int>(i))) continue;
      const dds::JointInfo& joint = machine.joints[i];
      text::append(text, " %s %.10g %.10g", joint.name.c_str(), shown(box.min[i], joint.is_rotary),
                   shown(box.max[i], joint.is_rotary));
    }
    text += "\n";
  }
  if (const TipBox& tip = machine.soft_limits.tip_box(); tip.is_set) {
    text::append(text, "*  tip      %.10g,%.10g,%.10g %.10g,%.10g,%.10g mm\n", tip.min[0],
                 tip.min[1], tip.min[2], tip.max[0], tip.max[1], tip.max[2]);
  }
  return text;
}

}  // namespace meridian::cli
