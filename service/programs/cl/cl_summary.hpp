// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "meridian/path/cl_block.hpp"
#include "service/programs/cl/cl_options.hpp"

namespace meridian::cl {

/// Where the unit of a file comes from.
enum class UnitSource : std::uint8_t {
  kFile,    ///< its unit word
  kCaller,  ///< `--units`
  kFeed,    ///< no unit word: that of its feed words
  kStation  ///< neither: the default of the machine file, or millimetre
};

/// A word that cannot carry motion.
struct SkippedWord {
  std::string word;
  std::uint64_t count = 0;
  std::uint32_t line = 0;  ///< of the first
};

/// What only NC programs have.
struct NcSummary {
  bool is_nc = false;
  std::string work_offset;          ///< as written, every one once; empty: none was
  bool has_work_zero = false;       ///< where it lies is known; else it is the station's frame
  std::uint64_t turned_blocks = 0;  ///< with rotary words, cut to follow joints that turn evenly
  std::uint64_t turned_pieces = 0;  ///< what became of them
  double axis_tolerance_rad = 0;    ///< by which they are cut; 0: no machine is known
};

/// What was read so far. Units: mm, rad, s; frame: W. Bounded, whatever the length of the file.
struct ClSummary {
  static constexpr std::size_t kMaxTools = 64;
  static constexpr std::size_t kMaxSkipped = 200;

  std::string dialect = "APT";
  std::string dialect_reason;  ///< what shows it; empty: nothing does
  std::string program;         ///< PARTNO or the first TOOL PATH
  std::uint64_t bytes = 0;
  std::uint64_t lines = 0;
  std::uint64_t statements = 0;
  std::uint64_t comments = 0;
  std::uint64_t blocks = 0;
  std::array<std::uint64_t, 8> blocks_by_kind{};  ///< index: BlockKind
  std::uint64_t goto_three = 0;                   ///< GOTO with position alone
  std::uint64_t goto_six = 0;                     ///< GOTO with position and tool axis
  std::uint64_t listed_points = 0;                ///< lines of bare numbers after a GOTO
  std::uint64_t arcs = 0;
  std::uint64_t full_circles = 0;
  std::uint64_t splines = 0;
  std::uint64_t holes = 0;          ///< of canned cycles
  std::uint64_t zero_length = 0;    ///< motion blocks that neither move the tip nor turn the axis
  std::uint64_t frame_changes = 0;  ///< after motion had begun
  std::uint64_t feeds_limited = 0;  ///< blocks above the machine's maximum feed
  LengthUnit unit = LengthUnit::kMillimetre;
  UnitSource unit_source = UnitSource::kFile;
  bool is_suspected_metric = false;                    ///< an inch file that is plainly metric
  std::uint8_t decimals = 0;                           ///< most after the point of any coordinate
  Array3 box_min_mm{kInfinity, kInfinity, kInfinity};  ///< of all ends of blocks
  Array3 box_max_mm{-kInfinity, -kInfinity, -kInfinity};
  double tilt_min_rad = kInfinity;  ///< angle of the tool axis from +z of W
  double tilt_max_rad = 0;
  double axis_change_max_rad = 0;  ///< largest in one block
  double feed_min_mm_per_s = kInfinity;
  double feed_max_mm_per_s = 0;
  double cut_length_mm = 0;
  double rapid_length_mm = 0;
  double cut_time_s = 0;  ///< at the programmed feed
  double dwell_time_s = 0;
  double arc_mismatch_max_mm = 0;
  std::vector<std::uint32_t> tools;  ///< numbers loaded, in order of first use, at most kMaxTools
  std::vector<SkippedWord> skipped;  ///< each word once, in order of first use
  NcSummary nc;

  /// What the last digit of the file's coordinates is worth.
  [[nodiscard]] double resolution_mm() const noexcept {
    return std::pow(10.0, -decimals) * (unit == LengthUnit::kInch ? 25.4 : 1.0);
  }

  void skip(std::string_view word, std::uint32_t line) {
    const auto at = std::find_if(skipped.begin(), skipped.end(),
                                 [word](const SkippedWord& s) { return s.word == word; });
    if (at != skipped.end()) {
      ++at->count;
    } else if (skipped.size() < kMaxSkipped) {
      skipped.push_back({std::string(word), 1, line});
    }
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
};

/// The summary as lines for a person.
[[nodiscard]] std::string to_text(const ClSummary& summary);
/// The same as one JSON object.
[[nodiscard]] std::string to_json(const ClSummary& summary);

/// "PAINT (411), CAMERA (2)"; empty where no word was skipped.
[[nodiscard]] std::string skipped_text(const ClSummary& summary);

}  // namespace meridian::cl
