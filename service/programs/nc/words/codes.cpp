// SPDX-License-Identifier: Apache-2.0
#include "service/programs/nc/words/codes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "meridian/path/cl_block.hpp"
#include "service/programs/nc/modes.hpp"

namespace meridian::nc {
namespace {

using enum GKind;

template <class E>
constexpr std::uint8_t of(E value) {
  return static_cast<std::uint8_t>(value);
}

constexpr std::string_view kByCam = "let the CAM system write the moves themselves";
constexpr std::string_view kTilted = "a tilted plane that is not defined by its angles";
constexpr std::string_view kByAngles = "output G68.2 with X Y Z I J K, and G53.1";
constexpr std::string_view kOffsets = "changes offsets, which are the station's frame here";
constexpr std::string_view kCompensation =
    "radius compensation is the control's; output the path of the tool's centre (G40)";

/// In the order of their numbers.
constexpr std::array kG = std::to_array<GRow>({
    {0, kMotion, of(Motion::kRapid)},
    {10, kMotion, of(Motion::kLine)},
    {20, kMotion, of(Motion::kClockwise)},
    {30, kMotion, of(Motion::kCounterClockwise)},
    {40, kDwell},
    {50, kSetting},      // G05 P10000: look-ahead
    {51, kAxesSetting},  // G05.1 Q1
    {80, kSetting},      // G08 P1
    {90, kNothing},
    {100, kRefused, 0, kOffsets},
    {110, kNothing},
    {131, kNothing},
    {150, kNothing},
    {160, kRefused, 0, "polar coordinates", kByCam},
    {170, kPlane, 2},
    {180, kPlane, 1},
    {190, kPlane, 0},
    {200, kUnit, 1},
    {210, kUnit, 0},
    {230, kNothing},
    {250, kNothing},
    {280, kHome},
    {300, kReference},
    {310, kRefused, 0, "probing: where it ends only the machine knows", "leave it out"},
    {382, kRefused, 0, "probing: where it ends only the machine knows", "leave it out"},
    {383, kRefused, 0, "probing: where it ends only the machine knows", "leave it out"},
    {400, kNothing},
    {401, kNothing},
    {410, kRefused, 0, kCompensation},
    {420, kRefused, 0, kCompensation},
    {430, kControl, of(Control::kLength)},
    {434, kControl, of(Control::kRotary)},
    {435, kControl, of(Control::kVector)},
    {440, kRefused, 0, "a length offset counted the other way round", "G43"},
    {490, kControl, of(Control::kNone)},
    {500, kNothing},
    {501, kNothing},
    {502, kNothing},
    {510, kRefused, 0, "scaling", kByCam},
    {511, kRefused, 0, "mirroring", kByCam},
    {520, kLocalZero},
    {530, kMachinePosition},
    {531, kPlaneFollow},
    {536, kPlaneFollow},
    {540, kWorkOffset},
    {541, kWorkOffset},
    {542, kRefused, 0, kOffsets},
    {544, kRefused, 0, kOffsets},
    {550, kWorkOffset},
    {560, kWorkOffset},
    {570, kWorkOffset},
    {580, kWorkOffset},
    {590, kWorkOffset},
    {591, kWorkOffset},
    {592, kWorkOffset},
    {593, kWorkOffset},
    {610, kNothing},
    {611, kSetting},
    {620, kNothing},
    {640, kSetting},
    {650, kRefused, 0, "a macro call", kByCam},
    {660, kRefused, 0, "a macro call", kByCam},
    {661, kRefused, 0, "a macro call", kByCam},
    {670, kNothing},
    {680, kRefused, 0, "a rotation of the control's", kByCam},
    {682, kPlaneTilt},
    {683, kRefused, 0, kTilted, kByAngles},
    {684, kRefused, 0, kTilted, kByAngles},
    {690, kPlaneOff},
    {691, kNothing},
    {700, kUnit, 1},  // DIN 66025, of many postprocessors
    {710, kUnit, 0},
    {730, kCycle, 73},
    {800, kCycle, 0},
    {810, kCycle, 81},
    {820, kCycle, 82},
    {830, kCycle, 83},
    {850, kCycle, 85},
    {860, kCycle, 86},
    {890, kCycle, 89},
    {900, kDistance, 0},
    {901, kCentre, 1},
    {910, kDistance, 1},
    {911, kCentre, 0},
    {920, kRefused, 0, kOffsets},
    {930, kFeed, of(cl::FeedUnit::kInverseTime)},
    {940, kFeed, of(cl::FeedUnit::kPerMinute)},
    {950, kFeed, of(cl::FeedUnit::kPerRevolution)},
    {960, kRefused, 0, "surface speed needs the radius being cut", "output the speed in rev/min"},
    {970, kNothing},
    {980, kReturn, 0},
    {990, kReturn, 1},
    {1030, kSetting},     // Haas: how far it looks ahead
    {1540, kWorkOffset},  // Haas: G154 Pn
    {1870, kSetting},
    {2340, kControl, of(Control::kRotary)},  // Haas
    {2540, kDynamicOffset, 1},               // Haas
    {2550, kDynamicOffset, 0},
});

constexpr std::string_view kSubprogram = "a subprogram, which is not run here";

constexpr std::array kM = std::to_array<MRow>({
    {0, MKind::kStop},
    {1, MKind::kOptionalStop},
    {2, MKind::kEnd},
    {3, MKind::kSpindle, of(ActionKind::kSpindleClockwise)},
    {4, MKind::kSpindle, of(ActionKind::kSpindleCounterClockwise)},
    {5, MKind::kSpindle, of(ActionKind::kSpindleOff)},
    {6, MKind::kTool},
    {7, MKind::kCoolant, of(ActionKind::kCoolantMist)},
    {8, MKind::kCoolant, of(ActionKind::kCoolantFlood)},
    {9, MKind::kCoolant, of(ActionKind::kCoolantOff)},
    {30, MKind::kEnd},
    {96, MKind::kRefused, 0, "a jump on a signal"},
    {97, MKind::kRefused, 0, kSubprogram},
    {98, MKind::kRefused, 0, kSubprogram},
    {99, MKind::kRefused, 0, "the end of a subprogram; a main program begins again there",
     "end a main program with M30"},
    {198, MKind::kRefused, 0, kSubprogram},
    {428, MKind::kRefused, 0, "the kinematics of a LinuxCNC configuration"},
    {429, MKind::kRefused, 0, "the kinematics of a LinuxCNC configuration"},
    {430, MKind::kRefused, 0, "the kinematics of a LinuxCNC configuration"},
});

/// Canned cycles that turn the spindle back, orient it or wait for somebody.
constexpr GRow kOtherCycle{-1, kRefused, 0, "a canned cycle of the control", kByCam};

}  // namespace

std::span<const GRow> g_rows() { return kG; }

const GRow* find_g(double code) noexcept {
  const double tenths = std::round(code * 10);
  if (!(std::abs(tenths - code * 10) < 1e-6 && tenths >= 0 && tenths < 1e4)) return nullptr;
  const int key = static_cast<int>(tenths);
  const bool is_cycle = key == 730 || key == 740 || key == 760 || (key >= 810 && key <= 890);
  const auto at =
      std::find_if(kG.begin(), kG.end(), [key](const GRow& row) { return row.tenths == key; });
  if (at != kG.end()) return &*at;
  return is_cycle && key % 10 == 0 ? &kOtherCycle : nullptr;
}

const MRow* find_m(double code) noexcept {
  const auto at =
      std::find_if(kM.begin(), kM.end(), [code](const MRow& row) { return row.code == code; });
  return at == kM.end() ? nullptr : &*at;
}

}  // namespace meridian::nc
