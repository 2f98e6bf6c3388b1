// SPDX-License-Identifier: Apache-2.0
#include "service/cli/options/operator/hand_options.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "meridian/cycle/jog/jog_tool.hpp"
#include "meridian/units.hpp"
#include "service/cli/commands.hpp"
#include "service/protocol/operator/jog_hand.hpp"
#include "service/text/number.hpp"

namespace meridian::cli {
namespace {

constexpr std::array<const char*, kToolAxisCount> kToolAxes{"tool-x", "tool-y", "tool-z", "tool-a",
                                                            "tool-b"};

/// Index of the joint of that name; with `has_tool` from kMaxJoints on that of a tool axis.
[[nodiscard]] std::optional<int> find_joint(const dds::MachineInfo& machine,
                                            const std::string& name, bool has_tool) {
  std::string names;
  for (std::size_t i = 0; i < std::min<std::size_t>(machine.joint_count, kMaxJoints); ++i) {
    if (machine.joints[i].name == name) return static_cast<int>(i);
    names += " " + machine.joints[i].name;
  }
  for (int axis = 0; has_tool && axis < kToolAxisCount; ++axis) {
    const char* const word = kToolAxes[static_cast<std::size_t>(axis)];
    if (name == word) return kMaxJoints + axis;
    names += std::string(" ") + word;
  }
  std::fprintf(stderr, "meridian: machine %s has no joint %s; there are%s\n", machine.name.c_str(),
               name.c_str(), names.c_str());
  return std::nullopt;
}

[[nodiscard]] bool is_angle(const dds::MachineInfo& machine, int index) {
  if (index >= kMaxJoints) return index - kMaxJoints >= static_cast<int>(ToolAxis::kTiltX);
  return machine.joints[static_cast<std::size_t>(index)].is_rotary;
}

[[nodiscard]] std::optional<double> find_number(const std::string& text) {
  double value = 0;
  if (text::read_finite(text, value)) return value;
  std::fprintf(stderr, "meridian: '%s' is no velocity; give mm/s, or deg/s of a rotary joint\n",
               text.c_str());
  return std::nullopt;
}

}  // namespace

int run_jog(dds::Participant& participant, stream::OperatorLink& link,
            const dds::MachineInfo& machine, const std::vector<std::string>& words,
            const JogOptions& options, const PeerOptions& peer) {
  if (words.size() != 2) {
    std::fprintf(stderr, "meridian: jog takes a joint and its velocity\n");
    return kUsage;
  }
  const auto joint = find_joint(machine, words[0], true);
  const auto velocity = joint ? find_number(words[1]) : std::nullopt;
  if (!velocity) return kUsage;
  const bool is_rotary = is_angle(machine, *joint);
  const double unit = is_rotary ? units::kDegree_rad : 1.0;
  stream::JogPlan plan;
  plan.is_tool = *joint >= kMaxJoints;
  plan.joint = plan.is_tool ? *joint - kMaxJoints : *joint;
  plan.velocity = *velocity * unit;
  plan.distance = options.distance * unit;
  plan.time_s = options.for_s > 0 ? options.for_s : options.distance > 0 ? 0 : 1e9;
  plan.dead_man_s = options.dead_man_ms * 1e-3;
  watch_for_stop();
  stream::JogHand hand(participant, link);
  const stream::JogResult result = hand.jog(plan, stop_flag(), peer.timeout());
  switch (result.end) {
    case stream::JogEnd::kNoAnswer:
      std::fprintf(stderr, "meridian: machine %s does not answer\n", machine.name.c_str());
      return kNoPeer;
    case stream::JogEnd::kRefused:
      std::fprintf(stderr, "refused: %s\n", result.text.c_str());
      return kMachineRefused;
    case stream::JogEnd::kDone:
    case stream::JogEnd::kTakenOff:
      break;
  }
  if (!plan.is_tool) {
    std::printf("%s at %.6g %s\n", words[0].c_str(), result.position / unit,
                is_rotary ? "deg" : "mm");
  }
  if (result.end == stream::JogEnd::kDone && result.has_moved) return kFine;
  if (result.end == stream::JogEnd::kDone) {
    std::fprintf(stderr, "meridian: %s did not move: it stands at the end of its travel%s\n",
                 words[0].c_str(), plan.is_tool ? ", or beside the pole" : "");
    return kVerdictNo;
  }
  std::fprintf(stderr, "meridian: the machine stopped jogging: %s\n", result.text.c_str());
  return kVerdictNo;
}

double home_argument(const dds::MachineInfo& machine, const std::vector<std::string>& names) {
  unsigned mask = 0;
  for (const std::string& name : names) {
    const auto joint = find_joint(machine, name, false);
    if (!joint) return -1;
    mask |= 1U << static_cast<unsigned>(*joint);
  }
  return mask;
}

}  // namespace meridian::cli
