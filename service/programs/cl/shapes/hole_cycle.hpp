// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "service/programs/cl/dialect.hpp"
#include "service/programs/cl/interpreter/feed.hpp"
#include "service/programs/cl/refusal.hpp"
#include "service/programs/cl/text/statement.hpp"

namespace meridian::cl {

enum class HoleKind : std::uint8_t {
  kDrill,      ///< feed in, dwell, rapid out: DRILL, FACE, CSINK, ...
  kDeep,       ///< in pecks, out of the hole behind each
  kChipBreak,  ///< in pecks, a little back behind each
  kFeedOut,    ///< feed in, dwell, feed out: REAM, BORE
  kStopOut,    ///< feed in, dwell, spindle stop, rapid out, spindle start: BORE,DRAG
  kRefused     ///< nothing: its definition was refused, and its holes say no more than that
};

/// Where the tool goes after a hole.
enum class CycleReturn : std::uint8_t {
  kToRetract,     ///< to the retract level that the cycle gives; else to its rapid level
  kToRapidLevel,  ///< to the rapid level, whatever else is given (CYCLE/CLEAR)
  kToBefore       ///< to the level that the tool had before the cycle (RTRCTO,AUTO)
};

/// A canned cycle as written: lengths in the unit of the file, levels along the tool axis above the
/// top of the hole, which is the point that each GOTO gives.
struct HoleCycle {
  HoleKind kind = HoleKind::kDrill;
  CycleReturn returns = CycleReturn::kToRetract;
  bool ends_after_one = false;  ///< CYCLE/MILL
  double depth = 0;             ///< below the top
  double rapid_level = 0;
  double retract_level = 0;   ///< not below rapid_level
  std::vector<double> pecks;  ///< in order, the last repeats; empty: in one go
  double back = 0;            ///< of chip breaking; 0: not given
  int pecks_to_retract = 0;   ///< chip breaking: out of the hole behind so many; 0: never
  double dwell_s = 0;
  double dwell_revolutions = 0;
  bool dwells_at_pecks = true;  ///< after each peck; else at the bottom alone
  WrittenFeed feed;             ///< kNone: the one in force
  WrittenFeed feed_out;         ///< kNone: as `kind` says, at rapid or at `feed`
  /// Where the points are bottoms: the Z to which it retracts. Then its levels are those of the
  /// last hole.
  std::optional<double> clearance_z;
  double rapid_below = 0;  ///< of clearance_z: how far below it the rapid level lies
};

/// One row for every type of cycle: what it does, or why it is refused.
struct HoleType {
  std::string_view word;
  HoleKind kind;
  std::string_view refusal;  ///< empty: it runs
};
/// All types that stand behind CYCLE. Proof: tests/unit/cl/word_samples_test.cpp.
[[nodiscard]] std::span<const HoleType> hole_types();

/// What a CYCLE statement says.
struct CycleStatement {
  enum class Kind : std::uint8_t { kOff, kOn, kReturn, kDefine };
  Kind kind = Kind::kDefine;
  CycleReturn returns = CycleReturn::kToRetract;  ///< of kReturn
  HoleCycle cycle;                                ///< of kDefine
  std::string_view type;                          ///< of kDefine: the first word, as written
  bool has_odd_sign = false;                      ///< the depth has not the dialect's sign
};

/// Reads CYCLE/... in the forms of the dialect: pairs of keyword and number, and positions where
/// the dialect defines them. Refused by name: tapping, bores that orient the spindle, cycles that
/// only the control knows, and forms that the dialect leaves to a post-processor's table.
/// Proof: tests/unit/cl/hole_test.cpp.
[[nodiscard]] Expected<CycleStatement, Refusal> read_cycle(const Statement& s,
                                                           const DialectFinder& dialect);

}  // namespace meridian::cl
