// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "meridian/path/cl_block.hpp"
#include "service/programs/cl/cl_options.hpp"
#include "service/programs/cl/cl_summary.hpp"
#include "service/programs/cl/refusal.hpp"
#include "service/programs/cl/remarks.hpp"

namespace meridian::cl {

enum class FeedUnit : std::uint8_t {
  kNone,
  kPerMinute,  ///< in the unit of the file
  kMillimetrePerMinute,
  kInchPerMinute,
  kFootPerMinute,
  kPerRevolution,  ///< in the unit of the file
  kMillimetrePerRevolution,
  kInchPerRevolution,
  kFootPerRevolution,
  kInverseTime,  ///< 1/min
  kPerTooth      ///< known, and refused: the file does not say how many teeth there are
};

/// The unit that a word gives; kNone: it is no word for one.
[[nodiscard]] FeedUnit feed_unit_of(std::string_view word);

/// A feed as it is written.
struct WrittenFeed {
  double value = 0;
  FeedUnit unit = FeedUnit::kNone;
};

/// The spindle as the file left it.
struct Spindle {
  double speed_rpm = 0;
  ActionKind sense = ActionKind::kSpindleClockwise;
  ActionKind state = ActionKind::kSpindleOff;  ///< off, clockwise or counter-clockwise

  [[nodiscard]] bool turns() const noexcept {
    return state != ActionKind::kSpindleOff && speed_rpm > 0;
  }
};

/// How a motion block is driven.
struct MotionFeed {
  BlockKind kind = BlockKind::kCut;
  FeedMeaning meaning = FeedMeaning::kNone;
  double feed = 0;  ///< mm/s or 1/s
};

/// What a written feed comes to depends on these.
struct FeedContext {
  LengthUnit unit = LengthUnit::kMillimetre;
  Spindle spindle;
};

/// The feed in mm/s, or 1/s in inverse time. Refuses a feed per tooth, one per revolution of a
/// spindle that stands, and one beyond 1e6 mm/min. Proof: tests/unit/cl/feed_test.cpp.
[[nodiscard]] Expected<MotionFeed, Refusal> feed_of(const WrittenFeed& written,
                                                    const FeedContext& context);

/// The unit of lengths that a feed word names; inch for feet. Nothing where it names none.
[[nodiscard]] std::optional<LengthUnit> length_unit_of(FeedUnit feed);

/// A unit of lengths that a feed word shows, and its line.
struct ShownUnit {
  LengthUnit unit = LengthUnit::kMillimetre;
  std::uint32_t line = 0;
};

/// Whether a feed word is of millimetres where lengths are in inch, or of inches and feet where
/// they are in millimetre.
[[nodiscard]] bool is_of_other_unit(FeedUnit feed, LengthUnit unit);

/// What contradicts itself, or will not be kept: points and feed in different units, a feed beyond
/// the machine's.
void remark_on_feed(const WrittenFeed& written, const MotionFeed& feed, LengthUnit unit,
                    double max_feed_mm_per_s, std::uint32_t line, Remarks& remarks);

}  // namespace meridian::cl
