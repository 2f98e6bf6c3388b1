// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "meridian/drive.hpp"
#include "meridian/drive_csp.hpp"
#include "meridian/units.hpp"

namespace meridian::drive {
namespace {

// Source: CiA 303-2, notation index of units, and CiA 402-2, objects 60A8h and 60A9h.
constexpr unsigned kMetre = 0x01, kRadian = 0x10, kDegree = 0x41, kTurn = 0xB4;
constexpr unsigned kNoDenominator = 0x00, kSecond = 0x03, kMinute = 0x47;
constexpr double kTurn_rad = 2 * std::numbers::pi;
constexpr double kMetre_mm = 1000;

[[noreturn]] void refuse(std::uint32_t si_unit, const char* why) {
  char text[160];
  std::snprintf(text, sizeof text,
                "SI unit %08Xh: %s; give counts_per_unit by the encoder and the gear", si_unit,
                why);
  throw DriveError(text);
}

}  // namespace

double counts_per_unit(std::uint32_t increments, std::uint32_t encoder_turns,
                       std::uint32_t motor_turns, std::uint32_t shaft_turns,
                       double feed_per_shaft_turn) {
  if (increments == 0 || encoder_turns == 0 || motor_turns == 0 || shaft_turns == 0) {
    throw DriveError("resolution of the encoder or gear ratio: a part of it is 0");
  }
  if (!(std::isfinite(feed_per_shaft_turn) && feed_per_shaft_turn != 0)) {
    throw DriveError("feed of one turn of the shaft: no number, or 0");
  }
  const double per_motor_turn = static_cast<double>(increments) / encoder_turns;
  return per_motor_turn * motor_turns / shaft_turns / feed_per_shaft_turn;
}

double counts_per_si_unit(std::uint32_t si_unit, bool is_rotary) {
  const int prefix = static_cast<std::int8_t>(si_unit >> 24);
  const unsigned numerator = si_unit >> 16 & 0xFFU, denominator = si_unit >> 8 & 0xFFU;
  double one = 0;  // mm or rad of the unit
  switch (numerator) {
    case kMetre:
      one = kMetre_mm;
      break;
    case kRadian:
      one = 1;
      break;
    case kDegree:
      one = units::kDegree_rad;
      break;
    case kTurn:
      one = kTurn_rad;
      break;
    default:
      refuse(si_unit, "its numerator is neither metre, radian, degree nor turn");
  }
  if ((numerator == kMetre) == is_rotary) {
    refuse(si_unit, is_rotary ? "a rotary axis is not counted in metres"
                              : "a linear axis is not counted in angles");
  }
  if (denominator == kMinute) {
    one = units::per_s_from_per_min(one);
  } else if (denominator != kNoDenominator && denominator != kSecond) {
    refuse(si_unit, "its denominator is neither second nor minute");
  }
  return 1 / (one * std::pow(10.0, prefix));
}

}  // namespace meridian::drive
