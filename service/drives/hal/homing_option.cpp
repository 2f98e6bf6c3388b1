// SPDX-License-Identifier: Apache-2.0
#include "service/drives/hal/homing_option.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "meridian/drive.hpp"
#include "meridian/units.hpp"

namespace meridian::hal {
namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& why) {
  throw drive::DriveError("--homing " + option + ": " + why +
                          "; write NAME=hal, or NAME=index:VELOCITY:POSITION:DISTANCE");
}

/// Numbers between colons.
[[nodiscard]] std::vector<double> numbers_of(const std::string& option, const std::string& text) {
  std::vector<double> out;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ':');) {
    std::size_t read = 0;
    double value = NAN;
    try {
      value = std::stod(part, &read);
    } catch (const std::exception&) {
      read = 0;
    }
    if (read != part.size() || !std::isfinite(value)) refuse(option, "'" + part + "' is no number");
    out.push_back(value);
  }
  return out;
}

}  // namespace

void set_homing(std::vector<drive::Axis>& axes, const std::string& option) {
  const std::size_t equal = option.find('=');
  if (equal == std::string::npos) refuse(option, "no '='");
  const std::string name = option.substr(0, equal), method = option.substr(equal + 1);
  const auto axis = std::find_if(axes.begin(), axes.end(),
                                 [&](const drive::Axis& one) { return one.name == name; });
  if (axis == axes.end()) refuse(option, "the machine has no joint '" + name + "'");
  drive::HomingSpec homing;
  homing.is_referenced = false;
  if (method == "hal") {
    homing.method = drive::HomingMethod::kByDrive;
  } else if (method.rfind("index:", 0) == 0) {
    std::vector<double> numbers = numbers_of(option, method.substr(6));
    if (numbers.empty() || numbers.size() > 3) refuse(option, "one to three numbers are asked for");
    numbers.resize(3, 0);
    const double unit = axis->is_rotary ? units::kDegree_rad : 1;
    homing.method = drive::HomingMethod::kByIndex;
    homing.search_velocity = numbers[0] * unit;
    homing.index_position = numbers[1] * unit;
    homing.search_distance = numbers[2] * unit;
  } else {
    refuse(option, "unknown method '" + method + "'");
  }
  axis->homing = homing;
}

}  // namespace meridian::hal
