// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include "meridian/kinematics/limited.hpp"
#include "meridian/units.hpp"
#include "service/protocol/block_check.hpp"

namespace meridian::stream {

namespace {

constexpr std::array kFields = {"tip x",    "tip y",    "tip z",    "axis i",   "axis j",
                                "axis k",   "feed",     "value",    "centre x", "centre y",
                                "centre z", "normal x", "normal y", "normal z", "sweep"};

template <class... Arguments>
std::string text(const char* format, Arguments... arguments) {
  char buffer[192];
  std::snprintf(buffer, sizeof buffer, format, arguments...);
  return buffer;
}

/// Returns "b4 at 612.3 mm (travel -400 to 400 mm)"; of a drive of the stage the same.
std::string joint_text(const BlockReject& reject, const MachineModel& model) {
  if (reject.joint < 0 || reject.joint >= limited_count(model)) return "a joint";
  const JointSpec& joint = limited_spec(model, reject.joint);
  const char* unit = joint.is_rotary ? "deg" : "mm";
  const auto shown = [&joint](double value) {
    return joint.is_rotary ? units::deg_from_rad(value) : value;
  };
  return text("%s at %.6g %s (travel %.6g to %.6g %s)", joint.name.c_str(), shown(reject.value),
              unit, shown(joint.limits.travel_min), shown(joint.limits.travel_max), unit);
}

/// Returns "keep-out box vice (X -50 to 80 mm, C 0 to 30 deg)".
std::string keep_out_text(const BlockReject& reject, const MachineModel& model) {
  std::string out = std::string("keep-out box ") + model.keep_out.name_of(reject.value) + " (";
  const auto boxes = model.keep_out.boxes();
  const auto number = static_cast<std::size_t>(std::max(0.0, reject.value));
  for (int i = 0; number < boxes.size() && i < model.joint_count; ++i) {
    const KeepOutBox& box = boxes[number];
    if (!box.has(i)) continue;
    const JointSpec& joint = limited_spec(model, i);
    const double unit = joint.is_rotary ? units::kDegree_rad : 1.0;
    if (out.back() != '(') out += ", ";
    out +=
        text("%s %.6g to %.6g %s", joint.name.c_str(), box.min[static_cast<std::size_t>(i)] / unit,
             box.max[static_cast<std::size_t>(i)] / unit, joint.is_rotary ? "deg" : "mm");
  }
  return out + ")";
}

/// Returns "X at 130.2 mm over the base (-100 to 100 mm)".
std::string tip_box_text(const BlockReject& reject, const MachineModel& model) {
  if (reject.joint < 0 || reject.joint > 2) return "an axis of the base";
  const auto i = static_cast<std::size_t>(reject.joint);
  return text("%c at %.6g mm over the base (%.6g to %.6g mm)", "XYZ"[i], reject.value,
              model.tip_box.min[i], model.tip_box.max[i]);
}

}  // namespace

std::string reason_of(const BlockReject& reject, const MachineModel& model) {
  switch (reject.code) {
    case RejectCode::kNone:
      return "nothing is wrong";
    case RejectCode::kNotFinite: {
      const auto index = static_cast<std::size_t>(reject.value);
      return std::string(index < kFields.size() ? kFields[index] : "a number") +
             " is not a finite number";
    }
    case RejectCode::kKind:
      return "kind of block, feed or action is unknown, or out of place";
    case RejectCode::kAxisNotUnit:
      return text("tool axis or arc normal has length %.6g, not 1 within %g", reject.value,
                  kAxisNormTolerance);
    case RejectCode::kFeed:
      return text("feed %.6g per minute is not positive, has no meaning or is beyond %.0f mm/min",
                  reject.value, kMaxFeed_mm_per_min);
    case RejectCode::kArc:
      return text("arc does not lead from the block before to its end (%.6g, allowed %g mm)",
                  reject.value, kArcTolerance_mm);
    case RejectCode::kValue:
      return text("value %.6g is out of range", reject.value);
    case RejectCode::kUnknownTool:
      return text("tool %.6g is not in the tool table; add it to tools.toml", reject.value);
    case RejectCode::kNoActionPeer:
      return "nobody answers actions; start the action peer or set auxiliary = \"ignore\"";
    case RejectCode::kUnreachable:
      return "no joint positions put the tool there";
    case RejectCode::kTravel:
      return joint_text(reject, model) + " leaves travel at this block";
    case RejectCode::kTravelBetween:
      return joint_text(reject, model) + " leaves travel on the way from the block before";
    case RejectCode::kBranch:
      return "no branch or winding leads here from the block before";
    case RejectCode::kApproach:
      return "the machine finds no way to this block from where it stands";
    case RejectCode::kAxisReversal:
      return "tool axis turns by half a turn at once: no way round is meant; add a block between";
    case RejectCode::kTooComplex:
      return "the block is too long or too curved for one plan; split it";
    case RejectCode::kDiscontinuous:
      return "its joints would jump or creep: it leads through a singularity or within a hair's "
             "breadth of one; move the workpiece, or pass farther off";
    case RejectCode::kKeepOut:
      return "joints enter the " + keep_out_text(reject, model);
    case RejectCode::kTipBox:
      return "the tip leaves the tip box: " + tip_box_text(reject, model) +
             "; move the workpiece, or widen the box";
  }
  return "unknown reason";
}

std::string describe(const BlockReject& reject, const MachineModel& model) {
  return text("line %u, block %llu: ", reject.line,
              static_cast<unsigned long long>(reject.sequence)) +
         reason_of(reject, model);
}

}  // namespace meridian::stream
