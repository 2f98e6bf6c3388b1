// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace meridian::drive {

/// How an axis finds its reference when the operator homes it.
enum class HomingMethod : std::uint8_t {
  kNone,       ///< it always knows where it is (absolute encoder): nothing moves
  kByDrive,    ///< the drive searches by itself: Output::is_homing, Hardware::home() reports
  kByIndex,    ///< the library moves it until Reading::is_index, and ramps down
  kByCallback  ///< Hardware::home() leads it
};

/// Homing of one axis. Units: mm or rad, s.
struct HomingSpec {
  HomingMethod method = HomingMethod::kNone;
  bool is_referenced = true;   ///< knows where it is at the start
  double index_position = 0;   ///< kByIndex: what the place of the pulse is called
  double search_velocity = 0;  ///< kByIndex: with its sign
  double search_distance = 0;  ///< kByIndex: the search fails after so much; 0: never
};

/// One axis in drive coordinates. Limits that are 0 are not checked. Units: mm or rad, s.
struct Axis {
  std::string name;
  int joint = -1;  ///< its index in drive order, from 0; -1: its index in the list
  bool is_rotary = false, is_endless = false;
  double home = 0;  ///< where the machine file has its home; the library does not use it
  double travel_min = 0, travel_max = 0;  ///< not checked where they are equal
  double velocity = 0;
  double following_error = 0;     ///< largest distance of the position from the setpoint
  double fault_acceleration = 0;  ///< of the ramp after a fault
  HomingSpec homing;
};

}  // namespace meridian::drive
