// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/set_up_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <charconv>

#include "service/recording/telemetry/journal_entry.hpp"
#include "service/recording/telemetry/sealed_text.hpp"
#include "service/transport/messages.hpp"

namespace meridian::telemetry {
namespace {

constexpr std::string_view kSetUpHead = "meridian set-up 2", kHeadBefore = "meridian set-up 1";

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

}  // namespace

std::string to_text(const SetUp& set_up, std::string_view machine) {
  const WorkFrames& frames = set_up.frames;
  std::string text = fmt::format("{}\nmachine = {}\nactive = {}\nframes = {}\n", kSetUpHead,
                                 machine, frames.active(), frames.rows().size());
  for (const WorkFrame& row : frames.rows()) {
    text += fmt::format("frame = {} {} {} {} {} {} {} {}\n", row.number, row.origin_mm[0],
                        row.origin_mm[1], row.origin_mm[2], row.rotation_deg[0],
                        row.rotation_deg[1], row.rotation_deg[2], row.name.data());
  }
  if (set_up.tools) text += fmt::format("tools = {}\n{}\n", set_up.tools->size(), *set_up.tools);
  return seal(text);
}

Expected<SetUp, std::string> parse_set_up(std::string_view text, std::string_view machine) {
  const bool is_before = text.starts_with(fmt::format("{}\n", kHeadBefore));
  if (const auto damage = find_damage(text, is_before ? kHeadBefore : kSetUpHead, "set-up")) {
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
