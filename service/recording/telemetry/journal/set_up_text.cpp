// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/journal/set_up_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "meridian/units.hpp"
#include "service/recording/telemetry/journal/journal_entry.hpp"
#include "service/recording/telemetry/journal/sealed_text.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::telemetry {
namespace {

/// Newest first.
constexpr std::array<std::string_view, 5> kSetUpHeads{"meridian set-up 5", "meridian set-up 4",
                                                      "meridian set-up 3", "meridian set-up 2",
                                                      "meridian set-up 1"};

/// Takes the number at the begin of `text` and the space behind it; false where there is none.
template <class Number>
[[nodiscard]] bool take_number(std::string_view& text, Number& number) {
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || rest == end || *rest != ' ') return false;
  text.remove_prefix(static_cast<std::size_t>(rest - text.data()) + 1);
  return true;
}

/// The row of a line; false where it holds anything else.
[[nodiscard]] bool read_row(std::string_view text, WorkFrame& row) {
  bool is_right = take_number(text, row.number);
  for (double& value : row.origin_mm) is_right = is_right && take_number(text, value);
  for (double& value : row.rotation_deg) is_right = is_right && take_number(text, value);
  put_text(text, row.name);
  return is_right;
}

/// The soft limits that the next lines hold; false where they hold anything else.
[[nodiscard]] bool read_limits(Lines& lines, SoftLimits& limits) {
  std::size_t count = 0;
  lines.read("limits", count);
  bool is_right = count <= limits.rows().size();
  for (std::size_t i = 0; is_right && i < count; ++i) {
    const std::string text = std::string(lines.value("limit")) + ' ';
    std::string_view rest = text;
    std::size_t joint = 0;
    double min = 0, max = 0;
    is_right = take_number(rest, joint) && take_number(rest, min) && take_number(rest, max) &&
               rest.empty() && joint > 0 && limits.put(joint - 1, min, max);
  }
  return is_right && !lines.has_failed();
}

/// The keep-out boxes that the next lines hold; false where they hold anything else.
[[nodiscard]] bool read_boxes(Lines& lines, SoftLimits& limits) {
  std::size_t count = 0;
  lines.read("boxes", count);
  bool is_right = count <= std::size_t{KeepOut::kMax};
  for (std::size_t i = 0; is_right && i < count; ++i) {
    KeepOutBox box;
    std::string_view text = lines.value("box");
    is_right = take_number(text, box.joints);
    for (double& end : box.min) is_right = is_right && take_number(text, end);
    for (double& end : box.max) is_right = is_right && take_number(text, end);
    put_text(text, box.name);
    is_right = is_right && limits.put(box);
  }
  return is_right && !lines.has_failed();
}

/// The tip box that the next lines hold, or none; false where they hold anything else.
[[nodiscard]] bool read_tip_box(Lines& lines, SoftLimits& limits) {
  std::size_t count = 0;
  lines.read("tip_boxes", count);
  if (count == 0) return !lines.has_failed();
  const std::string text = std::string(lines.value("tip_box")) + ' ';
  std::string_view rest = text;
  TipBox box{true, {}, {}};
  bool is_right = count == 1;
  for (double& end : box.min) is_right = is_right && take_number(rest, end);
  for (double& end : box.max) is_right = is_right && take_number(rest, end);
  limits.put(box);
  return is_right && rest.empty() && !lines.has_failed();
}

/// "-10 to 200 mm".
[[nodiscard]] std::string range_text(double min, double max, bool is_rotary) {
  const auto shown = [is_rotary](double value) {
    return is_rotary ? units::deg_from_rad(value) : value;
  };
  return fmt::format("{:.10g} to {:.10g} {}", shown(min), shown(max), is_rotary ? "deg" : "mm");
}

/// "X -10 to 200 mm, C 0 to 30 deg".
[[nodiscard]] std::string box_text(const KeepOutBox& box, const MachineModel& model) {
  std::string text;
  for (std::size_t i = 0; i < box.min.size(); ++i) {
    if (!box.has(static_cast<int>(i))) continue;
    const JointSpec& joint = model.joints[i];
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", joint.name,
                        range_text(box.min[i], box.max[i], joint.is_rotary));
  }
  return text;
}

}  // namespace

std::string to_text(const SetUp& set_up, std::string_view machine) {
  const WorkFrames& frames = set_up.frames;
  std::string text = fmt::format("{}\nmachine = {}\nactive = {}\nframes = {}\n", kSetUpHeads[0],
                                 machine, frames.active(), frames.rows().size());
  for (const WorkFrame& row : frames.rows()) {
    text += fmt::format("frame = {} {} {} {} {} {} {} {}\n", row.number, row.origin_mm[0],
                        row.origin_mm[1], row.origin_mm[2], row.rotation_deg[0],
                        row.rotation_deg[1], row.rotation_deg[2], row.name.data());
  }
  const auto& rows = set_up.limits.rows();
  const auto is_set = [](const SoftLimits::Row& row) { return row.is_set; };
  text += fmt::format("limits = {}\n", std::count_if(rows.begin(), rows.end(), is_set));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].is_set) text += fmt::format("limit = {} {} {}\n", i + 1, rows[i].min, rows[i].max);
  }
  const auto boxes = set_up.limits.keep_out().boxes();
  text += fmt::format("boxes = {}\n", boxes.size());
  for (const KeepOutBox& box : boxes) {
    text += fmt::format("box = {} {} {} {}\n", box.joints, fmt::join(box.min, " "),
                        fmt::join(box.max, " "), box.name.data());
  }
  const TipBox& tip = set_up.limits.tip_box();
  text += fmt::format("tip_boxes = {}\n", tip.is_set ? 1 : 0);
  if (tip.is_set) {
    text += fmt::format("tip_box = {} {}\n", fmt::join(tip.min, " "), fmt::join(tip.max, " "));
  }
  if (set_up.tools) text += fmt::format("tools = {}\n{}\n", set_up.tools->size(), *set_up.tools);
  return seal(text);
}

Expected<SetUp, std::string> parse_set_up(std::string_view text, std::string_view machine) {
  const auto head = std::find_if(
      kSetUpHeads.begin(), kSetUpHeads.end(),
      [text](std::string_view known) { return text.starts_with(fmt::format("{}\n", known)); });
  const auto age = head - kSetUpHeads.begin();
  if (const auto damage =
          find_damage(text, head != kSetUpHeads.end() ? *head : kSetUpHeads[0], "set-up")) {
    return tl::make_unexpected(*damage);
  }
  Lines lines(text);
  (void)lines.next();
  const std::string_view owner = lines.value("machine");
  if (owner != machine) {
    return tl::make_unexpected(fmt::format("is of machine '{}', not of '{}'", owner, machine));
  }
  FrameOrder select{FrameWord::kSelect, {}};
  std::size_t count = 0;
  lines.read("active", select.frame.number);
  lines.read("frames", count);
  SetUp out;
  WorkFrames& frames = out.frames;
  bool is_right = count <= std::size_t{WorkFrames::kMax};
  for (std::size_t i = 0; is_right && i < count; ++i) {
    FrameOrder set;
    is_right = read_row(lines.value("frame"), set.frame) && frames.apply(set) == FrameFault::kNone;
  }
  is_right = is_right && !lines.has_failed() && frames.rows().size() == count &&
             frames.apply(select) == FrameFault::kNone;
  is_right = is_right && (age > 2 || read_limits(lines, out.limits));
  is_right = is_right && (age > 1 || read_boxes(lines, out.limits));
  is_right = is_right && (age > 0 || read_tip_box(lines, out.limits));
  if (is_right && lines.rest().starts_with("tools = ")) {
    std::size_t size = 0;
    lines.read("tools", size);
    out.tools = lines.rest().substr(0, size);
    is_right = !lines.has_failed() && size <= dds::kToolFileBytes && lines.rest().size() > size;
  }
  if (!is_right) return tl::make_unexpected(std::string("holds something else"));
  return out;
}

std::string frame_name(int number, const char* name) {
  if (number == 0) return "0 (machine file)";
  return *name == '\0' ? std::to_string(number) : fmt::format("{} ({})", number, name);
}

std::string tool_name(std::uint32_t number, double length_mm) {
  return number == 0 ? fmt::format("the machine file's tool, {:.10g} mm long", length_mm)
                     : fmt::format("tool {}, {:.10g} mm long", number, length_mm);
}

std::string limits_text(const SoftLimits& limits, const MachineModel& model) {
  std::string text;
  for (std::size_t i = 0; i < limits.rows().size(); ++i) {
    const SoftLimits::Row& row = limits.rows()[i];
    if (!row.is_set) continue;
    const JointSpec& joint = model.joints[i];
    const bool has_joint = i < static_cast<std::size_t>(model.joint_count);
    const std::string name = has_joint ? joint.name : fmt::format("joint {}", i + 1);
    text += fmt::format("{} {} {}", text.empty() ? "soft limits" : ",", name,
                        range_text(row.min, row.max, joint.is_rotary));
  }
  for (const KeepOutBox& box : limits.keep_out().boxes()) {
    text += fmt::format("{}{} ({})", text.empty() ? "keep-out box " : ", keep-out box ",
                        box.name.data(), box_text(box, model));
  }
  if (const TipBox& tip = limits.tip_box(); tip.is_set) {
    text += text.empty() ? "tip box (" : ", tip box (";
    for (std::size_t i = 0; i < tip.min.size(); ++i) {
      text += fmt::format("{}{} {}", i > 0 ? ", " : "", "XYZ"[i],
                          range_text(tip.min[i], tip.max[i], false));
    }
    text += ")";
  }
  return text.empty() ? "no soft limits" : text;
}

std::string describe(LimitsFault fault, std::uint8_t joint, const MachineModel& model) {
  const bool has_joint = joint < model.joint_count;
  const JointSpec& spec = model.joints[has_joint ? joint : 0];
  switch (fault) {
    case LimitsFault::kNone:
      return "";
    case LimitsFault::kWord:
      return "no such word; set, clear, keep-out, open or tip";
    case LimitsFault::kJoint:
      return fmt::format("the machine has no joint number {}", joint + 1);
    case LimitsFault::kEndless:
      return fmt::format("{} is endless, it has no travel to shrink", spec.name);
    case LimitsFault::kValue:
      return fmt::format("those of {} are no minimum below a maximum; swap the two numbers",
                         spec.name);
    case LimitsFault::kTravel:
      return fmt::format(
          "{} has a travel of {}, which soft limits only shrink", spec.name,
          range_text(spec.limits.travel_min, spec.limits.travel_max, spec.is_rotary));
    case LimitsFault::kBox:
      return "a keep-out box has a name and, of one joint at least, a minimum below a maximum";
    case LimitsFault::kBoxJoint:
      return "a keep-out box is one of joints of the machine that have travel; name others";
    case LimitsFault::kOwnBox:
      return "the machine file has a keep-out box of that name; take another one";
    case LimitsFault::kNoBox:
      return "no keep-out box of that name was put up; see meridian ctl limits list";
    case LimitsFault::kBoxes:
      return fmt::format("there are {} keep-out boxes at most, those of the machine file included",
                         KeepOut::kMax);
    case LimitsFault::kTip:
      return "a tip box has a minimum below a maximum along each of X, Y, Z; give both corners so";
    case LimitsFault::kTipBeyond: {
      const TipBox& own = model.tip_box;
      return fmt::format(
          "the machine file's tip box is {:.10g} to {:.10g} mm; give one that is inside of it",
          fmt::join(own.min, ","), fmt::join(own.max, ","));
    }
  }
  return "";
}

std::string describe(FrameFault fault, int number) {
  switch (fault) {
    case FrameFault::kNone:
      return "";
    case FrameFault::kWord:
      return "no such word; set, select or clear";
    case FrameFault::kNumber:
      return fmt::format("frame {} cannot be set; the numbers are 1 to {}, 0 is the machine file's",
                         number, WorkFrames::kMax);
    case FrameFault::kValue:
      return fmt::format("its values are out of range: mm within {:g}, degrees within {:g}",
                         WorkFrames::kMax_mm, WorkFrames::kMax_deg);
    case FrameFault::kNotSet:
      return fmt::format("frame {} is not set; see meridian ctl frame list", number);
    case FrameFault::kIsActive:
      return fmt::format("frame {} is in force; select another one first", number);
  }
  return "";
}

}  // namespace meridian::telemetry
