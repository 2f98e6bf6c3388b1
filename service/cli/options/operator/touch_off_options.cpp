// SPDX-License-Identifier: Apache-2.0
#include "service/cli/options/operator/touch_off_options.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>

#include "meridian/kinematics/kinematics.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/options/finite_range.hpp"
#include "service/cli/options/operator/reported_machine.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/text/number.hpp"

namespace meridian::cli {
namespace {

constexpr std::array<const char*, 5> kShapes{"face", "edge", "plane", "corner", "bore"};

int fail_touch_off(const std::string& what, int exit_code = kUsage) {
  std::fprintf(stderr, "meridian: %s\n", what.c_str());
  return exit_code;
}

[[nodiscard]] bool is_at_rest(State state) {
  return state == State::kOff || state == State::kReady;
}

[[nodiscard]] std::optional<std::uint8_t> number_of(const std::string& text) {
  std::uint8_t number = 0;
  return text::read_number(text, number) ? std::optional(number) : std::nullopt;
}

/// Prints the answer of the machine: the exit code.
[[nodiscard]] int show(const std::optional<dds::Reply>& reply) {
  if (!reply) return fail_touch_off("the machine does not answer", kNoPeer);
  std::fprintf(reply->is_accepted ? stdout : stderr, "%s: %s\n",
               reply->is_accepted ? "accepted" : "refused", reply->text.c_str());
  return reply->is_accepted ? kFine : kMachineRefused;
}

[[nodiscard]] int show_unset() {
  std::printf("nothing is set: say it again with --confirm\n");
  return kFine;
}

[[nodiscard]] int add_touch(const TouchOffOptions& options, const ToolOptions& tool,
                            const dds::MachineInfo& machine, const MachineModel& model,
                            const dds::Status& status) {
  const auto toward = direction_of(options.toward, model);
  if (options.touches.empty() || !toward) {
    return fail_touch_off(
        "touch-off touch needs --touches FILE and --toward -x, +x, -y, +y, -z or +z");
  }
  const auto touch = touch_of(status, machine, tool, *toward);
  if (!touch) return fail_touch_off(touch.error());
  if (!append_touch(options.touches, *touch)) {
    return fail_touch_off(options.touches + ": cannot be written", kVerdictNo);
  }
  const ToolPose pose = inspect::pose_of(*touch, model);
  std::printf("tip at %.4f %.4f %.4f mm in the frame of the kinematics, noted in %s\n",
              pose.tip.x(), pose.tip.y(), pose.tip.z(), options.touches.c_str());
  return kFine;
}

[[nodiscard]] int find_frame(const std::string& number, const TouchOffOptions& options,
                             const MachineModel& model, stream::OperatorLink& link,
                             std::chrono::milliseconds timeout) {
  const auto shape = std::find(kShapes.begin(), kShapes.end(), options.as);
  const auto row = number_of(number);
  if (!row || shape == kShapes.end() || options.touches.empty()) {
    return fail_touch_off(
        "touch-off frame needs a number, --touches FILE, and --as face, edge, plane, corner or "
        "bore");
  }
  std::ifstream file(options.touches, std::ios::binary);
  if (!file) return fail_touch_off(options.touches + ": cannot be opened", kInputRefused);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto touches = inspect::read_touches(text, options.touches);
  if (!touches) return fail_touch_off(touches.error(), kInputRefused);
  const auto found = inspect::find_frame(
      static_cast<inspect::TouchedShape>(shape - kShapes.begin()), *touches, model);
  if (!found) return fail_touch_off(options.touches + ": " + found.error(), kInputRefused);
  FrameOrder order;
  order.frame.number = *row;
  order.frame.origin_mm = to_array(found->origin_mm);
  order.frame.rotation_deg = inspect::angles_deg(found->rotation);
  const Array3 &at = order.frame.origin_mm, &turn = order.frame.rotation_deg;
  std::fputs(found->arithmetic.c_str(), stdout);
  std::printf("frame %u: --at %.10g,%.10g,%.10g,%.10g,%.10g,%.10g\n", *row, at[0], at[1], at[2],
              turn[0], turn[1], turn[2]);
  return options.is_confirmed ? show(link.ask(order, timeout)) : show_unset();
}

[[nodiscard]] int find_tool(const std::string& number, const TouchOffOptions& options,
                            ToolOptions tool, const dds::MachineInfo& machine,
                            const MachineModel& model, stream::OperatorLink& link,
                            std::chrono::milliseconds timeout) {
  const dds::Status& status = *link.status();
  if (!options.height) return fail_touch_off("touch-off tool needs a number and --height");
  if (status.tool != 0 && std::to_string(status.tool) != number) {
    return fail_touch_off("tool " + std::to_string(status.tool) + " is in the spindle");
  }
  const auto length = inspect::find_tool_length(status.joints, *options.height, model);
  if (!length) return fail_touch_off(length.error(), kVerdictNo);
  const ToolTable reported = config::parse_tools(machine.tool_file, "tool table of the machine");
  const auto& rows = reported.tools();
  const auto row = std::find_if(rows.begin(), rows.end(), [&number](const Tool& known) {
    return std::to_string(known.number) == number;
  });
  const double wear = tool.length_wear.value_or(row != rows.end() ? row->length_wear_mm : 0);
  tool.length = *length - wear;
  const auto order = tool_order({"set", number}, tool, machine);
  if (!order) return kUsage;
  const double gauge = forward(model, 0, status.joints).tip[2];
  std::printf("gauge line at z %.4f mm, tip at %.4f mm: %.4f mm, less wear of %.4f mm\n", gauge,
              *options.height, *length, wear);
  std::printf("tool %s: --length %.10g\n", number.c_str(), *tool.length);
  if (!options.is_confirmed) return show_unset();
  return show(link.ask_for_tools(order->file, order->tools_seen, timeout));
}

}  // namespace

std::vector<const CLI::Option*> add_touch_off_options(CLI::App& command, TouchOffOptions& options) {
  return {command.add_option("--touches", options.touches, "touch-off, probe: file of the touches"),
          command.add_option(
              "--toward", options.toward,
              "touch-off touch, probe: which way the tool goes to touch, by an axis of the "
              "work frame in force: -x, +x, -y, +y, -z, +z"),
          command.add_option("--as", options.as,
                             "touch-off frame: what was touched: face, edge, plane, corner, bore"),
          command
              .add_option("--height", options.height,
                          "touch-off tool: z of the tip in the work frame in force, mm")
              ->check(finite_range(-1e5, 1e5)),
          command.add_flag("--confirm", options.is_confirmed,
                           "touch-off frame, tool: set what was found")};
}

std::optional<Vector3> direction_of(const std::string& word, const MachineModel& machine) {
  constexpr std::string_view kAxes = "xyz";
  if (word.size() != 2 || (word[0] != '-' && word[0] != '+')) return std::nullopt;
  const std::size_t axis = kAxes.find(word[1]);
  if (axis == std::string_view::npos) return std::nullopt;
  const Vector3 direction = machine.X_MW.rotation.col(static_cast<Eigen::Index>(axis));
  return word[0] == '-' ? Vector3(-direction) : direction;
}

Expected<inspect::Touch, std::string> touch_of(const dds::Status& status,
                                               const dds::MachineInfo& machine,
                                               const ToolOptions& tool, const Vector3& toward) {
  const ToolTable reported = config::parse_tools(machine.tool_file, "tool table of the machine");
  const Tool* const row = status.tool != 0 ? reported.find(static_cast<int>(status.tool)) : nullptr;
  if (row == nullptr && !tool.radius) {
    return tl::make_unexpected(
        std::string("the radius of the tool in the spindle is not known: say its --radius"));
  }
  inspect::Touch touch;
  touch.joints = status.joints;
  touch.tool_length_mm = status.tool_length_mm;
  touch.radius_mm = tool.radius.value_or(row != nullptr ? row->cutting_radius_mm() : 0);
  const double corner =
      tool.corner_radius.value_or(row != nullptr ? row->corner_radius_mm + row->radius_wear_mm : 0);
  touch.is_ball = touch.radius_mm > 0 && corner == touch.radius_mm;
  touch.toward = toward;
  return touch;
}

bool append_touch(const std::string& name, const inspect::Touch& touch) {
  std::error_code error;
  const bool is_new = !std::filesystem::exists(name, error);
  std::ofstream file(name, std::ios::app | std::ios::binary);
  if (is_new) file << inspect::touch_header();
  file << inspect::to_row(touch) << std::flush;
  return file.good();
}

int run_touch_off(const std::vector<std::string>& words, const TouchOffOptions& options,
                  const ToolOptions& tool, const dds::MachineInfo& machine,
                  stream::OperatorLink& link, std::chrono::milliseconds timeout) {
  if (!link.wait_for_status(timeout)) return fail_touch_off("the machine does not answer", kNoPeer);
  const auto model = reported_machine(machine);
  if (!model) return fail_touch_off("the machine does not publish its file", kVerdictNo);
  if (!is_at_rest(link.status()->state)) {
    return fail_touch_off("touches are noted and set in Off and Ready alone", kVerdictNo);
  }
  const std::string word = words.empty() ? "" : words.front();
  if (word == "touch" && words.size() == 1) {
    return add_touch(options, tool, machine, *model, *link.status());
  }
  if (word == "frame" && words.size() == 2) {
    return find_frame(words[1], options, *model, link, timeout);
  }
  if (word == "tool" && words.size() == 2) {
    return find_tool(words[1], options, tool, machine, *model, link, timeout);
  }
  return fail_touch_off("touch-off takes touch, frame and a number, or tool and a number");
}

}  // namespace meridian::cli
