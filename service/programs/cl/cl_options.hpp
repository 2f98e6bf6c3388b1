// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "meridian/geometry/vector3.hpp"
#include "service/programs/cl/dialect.hpp"
#include "service/programs/cl/interpreter/frame.hpp"

namespace meridian::cl {

class LineSource;
class ProgramSource;

enum class LengthUnit : std::uint8_t { kMillimetre, kInch };

/// As messages have it.
[[nodiscard]] constexpr const char* name_of(LengthUnit unit) noexcept {
  return unit == LengthUnit::kInch ? "inch" : "millimetre";
}

/// Which way an arc turns about the vector that its CIRCLE word gives.
enum class ArcSense : std::uint8_t {
  kByForm,  ///< 4 numbers: by INDIRV; 6 and 7: right-handed; 11: clockwise (left-handed)
  kRight,
  kLeft
};

/// What the caller gives the reader beyond the file. Units: mm, s.
struct ClReaderOptions {
  std::optional<Dialect> dialect;          ///< `--dialect`: wins over what the file shows
  std::optional<LengthUnit> unit;          ///< `--units`: wins over the unit word of the file
  std::optional<LengthUnit> default_unit;  ///< of the machine file: no unit or feed word shows it
  std::optional<double> default_feed_mm_per_s;  ///< `--feed`: for files that cut before a FEDRAT
  double max_feed_mm_per_s = 0;                 ///< of the machine; 0: not known. Only warned about
  std::vector<std::string> allowed_words;       ///< `--allow-unknown`: become vendor words
  bool allow_no_end = false;                    ///< `--allow-no-end`: no FINI is no truncation
  ArcSense arc_sense = ArcSense::kByForm;
  /// `--from-line`: the program begins with the first block from this line on, after blocks that
  /// restore tool, spindle, coolant and place (restart.hpp); 0: from its begin.
  std::uint32_t first_line = 0;
  std::optional<Frame> frame;  ///< applied to every pose after the frames of the file
  /// Where the home of the machine puts tip and axis, in W, with this tool in the spindle (nothing:
  /// the one before any tool change). Empty: the machine is not known, and GOHOME is refused.
  std::function<std::optional<ToolPose>(std::optional<std::uint32_t>)> home;
  /// `--work-zero`, or the work frames of the machine: where the zeros of G54 and its kin lie in
  /// the frame of the kinematics, mm, by their numbers (1: G54). NC programs alone look here.
  std::map<int, Vector3> work_offsets;
  /// Positions of the machine by their names, in machine order, mm and rad: what G30 of an NC
  /// program leads to.
  std::map<std::string, std::vector<double>> positions;
  /// Makes the reader of an NC program: from its lines, its name, these options and why it is taken
  /// for one (nc::reader_of, which may know the machine). Empty: NC programs are refused.
  std::function<std::unique_ptr<ProgramSource>(LineSource&, const std::string&,
                                               const ClReaderOptions&, std::string_view)>
      nc;
};

}  // namespace meridian::cl
