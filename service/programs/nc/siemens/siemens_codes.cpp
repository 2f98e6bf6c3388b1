// SPDX-License-Identifier: Apache-2.0
// G codes as Siemens controls mean them.
#include <algorithm>
#include <array>
#include <cmath>

#include "service/programs/nc/modes.hpp"
#include "service/programs/nc/words/codes.hpp"

namespace meridian::nc {
namespace siemens {
namespace {

using enum GKind;

template <class E>
constexpr std::uint8_t of(E value) {
  return static_cast<std::uint8_t>(value);
}

constexpr std::string_view kByCamOnly = "let the CAM system write the moves themselves";
constexpr std::string_view kThread = "the feed is tied to the turn of the spindle";
constexpr std::string_view kRadiusOnly =
    "radius compensation is the control's; output the path of the tool's centre (G40)";

/// In the order of their numbers.
constexpr std::array kG = std::to_array<GRow>({
    {0, kMotion, of(Motion::kRapid)},
    {10, kMotion, of(Motion::kLine)},
    {20, kMotion, of(Motion::kClockwise)},
    {30, kMotion, of(Motion::kCounterClockwise)},
    {40, kDwell},
    {90, kNothing},
    {170, kPlane, 2},
    {180, kPlane, 1},
    {190, kPlane, 0},
    {330, kRefused, 0, kThread, kByCamOnly},
    {400, kNothing},
    {410, kRefused, 0, kRadiusOnly},
    {420, kRefused, 0, kRadiusOnly},
    {530, kMachinePosition},
    {540, kWorkOffset},
    {550, kWorkOffset},
    {560, kWorkOffset},
    {570, kWorkOffset},
    {600, kNothing},
    {630, kRefused, 0, kThread, kByCamOnly},
    {640, kNothing},
    {700, kRefused, 0, "inch for lengths, but not for feeds", "G700"},
    {710, kUnit, 0},
    {740, kRefused, 0, "a reference place that only the control knows", "SUPA with axis words"},
    {750, kRefused, 0, "a fixed place that only the control knows", "SUPA with axis words"},
    {900, kDistance, 0},
    {910, kDistance, 1},
    {930, kFeed, of(cl::FeedUnit::kInverseTime)},
    {940, kFeed, of(cl::FeedUnit::kPerMinute)},
    {950, kFeed, of(cl::FeedUnit::kPerRevolution)},
    {960, kRefused, 0, "surface speed needs the radius being cut", "output the speed in rev/min"},
    {970, kNothing},
    {1100, kRefused, 0, "polar coordinates", kByCamOnly},
    {1110, kRefused, 0, "polar coordinates", kByCamOnly},
    {1120, kRefused, 0, "polar coordinates", kByCamOnly},
    {1530, kMachinePosition},
    {2900, kNothing},  // the words of Siemens
    {2910, kRefused, 0, "words of ISO from here on", "output words of Siemens alone"},
    {3310, kRefused, 0, kThread, kByCamOnly},
    {3320, kRefused, 0, kThread, kByCamOnly},
    {4500, kNothing},
    {4510, kNothing},
    {5000, kWorkOffset},
    {6010, kNothing},
    {6020, kNothing},
    {6030, kNothing},
    {6410, kNothing},
    {6420, kNothing},
    {6430, kNothing},
    {6440, kNothing},
    {6450, kNothing},
    {7000, kUnit, 1},
    {7100, kUnit, 0},
});

/// G505 to G599 are work offsets too.
constexpr int kFirstOffset = 505, kLastOffset = 599;
constexpr auto kOffsets = [] {
  std::array<GRow, kLastOffset - kFirstOffset + 1> rows{};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i] = {10 * (kFirstOffset + static_cast<int>(i)), kWorkOffset};
  }
  return rows;
}();

}  // namespace
}  // namespace siemens

const GRow* find_siemens_g(double code) noexcept {
  if (!(code >= 0 && code < 1000 && code == std::floor(code))) return nullptr;
  const int number = static_cast<int>(code);
  if (number >= siemens::kFirstOffset && number <= siemens::kLastOffset) {
    return &siemens::kOffsets[static_cast<std::size_t>(number - siemens::kFirstOffset)];
  }
  const auto at = std::find_if(siemens::kG.begin(), siemens::kG.end(),
                               [number](const GRow& row) { return row.tenths == 10 * number; });
  return at == siemens::kG.end() ? nullptr : &*at;
}

}  // namespace meridian::nc
