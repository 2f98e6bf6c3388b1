// SPDX-License-Identifier: Apache-2.0
#include "service/cli/options/frame_options.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

#include "service/machine/file/config_error.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/text/number.hpp"
#include "service/text/printed.hpp"

namespace meridian::cli {
namespace {

using text::append;

constexpr std::array<std::string_view, 3> kWords{"set", "select", "clear"};

/// Prints what is wrong: false.
[[nodiscard]] bool complain(const std::string& what) {
  std::fprintf(stderr, "meridian: %s\n", what.c_str());
  return false;
}

/// Position and name of a row that is set; false, and printed, where they are none.
[[nodiscard]] bool read_row(const FrameOptions& options, WorkFrame& row) {
  if (options.at.empty()) return complain("frame set needs --at x,y,z[,a,b,c]");
  if (options.name.size() > kFrameNameChars) {
    return complain("--name has at most " + std::to_string(kFrameNameChars) + " bytes");
  }
  try {
    const auto values = config::parse_frame_values(options.at);
    std::copy_n(values.begin(), 3, row.origin_mm.begin());
    std::copy_n(values.begin() + 3, 3, row.rotation_deg.begin());
  } catch (const config::ConfigError& error) {
    return complain("--at '" + options.at + "': " + error.fault().allowed +
                    "; numbers with commas between and no spaces");
  }
  std::copy(options.name.begin(), options.name.end(), row.name.begin());
  return true;
}

}  // namespace

std::optional<FrameOrder> frame_order(const std::vector<std::string>& words,
                                      const FrameOptions& options) {
  const auto word =
      words.empty() ? kWords.end() : std::find(kWords.begin(), kWords.end(), words.front());
  FrameOrder order;
  bool is_right =
      word != kWords.end() && words.size() == 2 && text::read_number(words[1], order.frame.number);
  if (!is_right) {
    (void)complain("frame takes set, select or clear and a number, or list");
    return std::nullopt;
  }
  order.word = static_cast<FrameWord>(word - kWords.begin());
  if (order.word == FrameWord::kSet) {
    is_right = read_row(options, order.frame);
  } else if (!options.at.empty() || !options.name.empty()) {
    is_right = complain("--at and --name are for frame set alone");
  }
  return is_right ? std::optional(order) : std::nullopt;
}

std::string frames_text(const dds::MachineInfo& machine) {
  const auto mark = [&machine](int number) { return machine.work_frame == number ? '*' : ' '; };
  std::string text;
  append(text, "%c  0  machine file\n", mark(0));
  for (const WorkFrame& row : machine.work_frames) {
    append(text, "%c %2d  --at %.10g,%.10g,%.10g,%.10g,%.10g,%.10g  %s\n", mark(row.number),
           row.number, row.origin_mm[0], row.origin_mm[1], row.origin_mm[2], row.rotation_deg[0],
           row.rotation_deg[1], row.rotation_deg[2], row.name.data());
  }
  return text;
}

}  // namespace meridian::cli
