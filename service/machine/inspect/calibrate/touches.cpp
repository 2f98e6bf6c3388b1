// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/calibrate/touches.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "meridian/kinematics/kinematics.hpp"

namespace meridian::inspect {
namespace {

constexpr std::size_t kNumbers = kMaxJoints + 6;  // joints, length, radius, ball, direction

[[nodiscard]] bool read_numbers(std::string_view row, std::array<double, kNumbers>& numbers) {
  for (std::size_t i = 0; i < kNumbers; ++i) {
    const auto [rest, error] = std::from_chars(row.data(), row.data() + row.size(), numbers[i]);
    if (error != std::errc() || !std::isfinite(numbers[i])) return false;
    row.remove_prefix(static_cast<std::size_t>(rest - row.data()));
    const bool is_last = i + 1 == kNumbers;
    if (is_last ? !row.empty() : !row.starts_with(',')) return false;
    if (!is_last) row.remove_prefix(1);
  }
  return true;
}

}  // namespace

std::string touch_header() {
  std::string text;
  for (int i = 1; i <= kMaxJoints; ++i) text += "joint" + std::to_string(i) + ",";
  return text + "tool_length_mm,tool_radius_mm,is_ball,toward_x,toward_y,toward_z\n";
}

std::string to_row(const Touch& touch) {
  std::string row;
  const auto add = [&row](double value) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    row += row.empty() ? "" : ",";
    row.append(digits.data(), end);
  };
  for (const double joint : touch.joints) add(joint);
  add(touch.tool_length_mm);
  add(touch.radius_mm);
  add(touch.is_ball ? 1 : 0);
  for (const double value : to_array(touch.toward)) add(value);
  return row + "\n";
}

Expected<std::vector<Touch>, std::string> read_touches(std::string_view text,
                                                       const std::string& file) {
  std::vector<Touch> touches;
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view row = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (row.ends_with('\r')) row.remove_suffix(1);
    if (row.empty() || row.front() == '#' || row.starts_with("joint1")) continue;
    std::array<double, kNumbers> numbers{};
    if (!read_numbers(row, numbers)) {
      return tl::make_unexpected(file + ":" + std::to_string(line) + ": holds no touch of " +
                                 std::to_string(kNumbers) + " numbers");
    }
    Touch touch;
    std::copy_n(numbers.begin(), kMaxJoints, touch.joints.begin());
    const double* at = numbers.data() + kMaxJoints;
    touch.tool_length_mm = at[0];
    touch.radius_mm = at[1];
    touch.is_ball = at[2] != 0;
    touch.toward = Vector3(at[3], at[4], at[5]);
    if (touch.radius_mm < 0 || std::abs(touch.toward.norm() - 1) > 1e-6) {
      return tl::make_unexpected(file + ":" + std::to_string(line) +
                                 ": needs a radius and a direction of length 1");
    }
    touches.push_back(touch);
  }
  return touches;
}

ToolPose pose_of(const Touch& touch, MachineModel machine) {
  machine.X_MW.rotation = Eigen::Matrix3d::Identity();
  machine.X_MW.origin_mm = Vector3::Zero();
  return true_pose(machine, touch.tool_length_mm, touch.joints);
}

}  // namespace meridian::inspect
