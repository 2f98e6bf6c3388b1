// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace meridian::test {

/// Where a machine may be when something goes wrong.
struct Phase {
  enum class Where {
    kReady,    ///< enabled, at rest, no program
    kBegin,    ///< in the approach
    kCut,      ///< in mid-cut
    kRapid,    ///< in a rapid, at speed
    kPole,     ///< on the pole, turning C alone
    kHolding,  ///< the operator's hold was accepted just now
    kHeld,
    kDwell,
    kTool,     ///< waiting for the tool changer
    kStarved,  ///< the station has sent no more for a while
    kEnd       ///< in the last block
  };
  const char* name;  ///< as in docs/faults.md
  Where where;
  const char* transition = "smooth";

  /// Whether the machine stays there until an operator or a station says more.
  [[nodiscard]] bool waits() const noexcept {
    return where == Where::kReady || where == Where::kHeld || where == Where::kStarved;
  }
  /// Whether the operator has held it.
  [[nodiscard]] bool is_held() const noexcept {
    return where == Where::kHolding || where == Where::kHeld;
  }
};

/// A small five-axis part for a phase as a CL file, in which every cut is one line, for the machine
/// lai near home: some cuts, what the phase is about, and some more cuts.
struct FaultPart {
  explicit FaultPart(const Phase& phase);

  [[nodiscard]] std::string text() const { return text_up_to(static_cast<std::uint32_t>(-1)); }
  /// What a station has sent that has not come farther than `line`.
  [[nodiscard]] std::string text_up_to(std::uint32_t line) const;

  std::vector<std::string> lines;      ///< line n is lines[n - 1]
  std::vector<std::uint32_t> motions;  ///< lines that move the tool
  std::uint32_t section = 0;           ///< first line of what the phase is about
  std::uint32_t section_end = 0;       ///< its last

 private:
  void add(const std::string& line) { lines.push_back(line); }
  void add_motion(const std::string& line) {
    add(line);
    motions.push_back(static_cast<std::uint32_t>(lines.size()));
  }
};

}  // namespace meridian::test
