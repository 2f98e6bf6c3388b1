// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "service/programs/cl/cl_options.hpp"
#include "service/programs/cl/cl_summary.hpp"
#include "service/programs/cl/dialect.hpp"
#include "service/programs/cl/interpreter/copies.hpp"
#include "service/programs/cl/interpreter/feed.hpp"
#include "service/programs/cl/interpreter/frame_chain.hpp"
#include "service/programs/cl/remarks.hpp"
#include "service/programs/cl/shapes/block_path.hpp"
#include "service/programs/cl/shapes/hole_cycle.hpp"

namespace meridian::cl {

/// The unit of lengths: what the file says, and what holds from the first motion on.
struct Units {
  std::optional<LengthUnit> stated;    ///< by the last unit word
  std::optional<LengthUnit> in_force;  ///< nothing: to be resolved at the next motion
  std::optional<ShownUnit> by_feed;    ///< for a file without a unit word
  double to_mm = 1;
  double cutter = 0;  ///< width of the tool that the file describes, as written
};

/// Finds the first feed word behind the last statement that shows the unit of the file.
using LookAhead = std::function<std::optional<ShownUnit>()>;

/// The tool axis, which points of three numbers leave out.
struct ToolAxis {
  enum class Source : std::uint8_t {
    kNone,    ///< +z, as nothing gave any
    kPoint,   ///< a point of six numbers
    kCopied,  ///< what a copied pattern left: no point without axis may rely on it
    kWord     ///< TLAXIS, MULTAX/OFF: holds for points without axis in every dialect
  };
  std::array<double, 3> written{0, 0, 1};
  Vector3 in_w = Vector3::UnitZ();
  Source source = Source::kNone;
};

/// How a cut joins the motion after it.
enum class BlockJoin : std::uint8_t {
  kByMachine,  ///< as machine file, station or `--transition` say
  kExactStop   ///< the tool rests where the cut ends
};

/// What the next motion has besides its point.
enum class NextMotion : std::uint8_t { kFeed, kRapid };

/// A CIRCLE that waits for the point where its arc ends; numbers as written.
struct PendingArc {
  enum class Form : std::uint8_t { kRight, kClockwise, kForward };
  Form form = Form::kRight;
  std::uint32_t line = 0;
  std::array<double, 6> centre_normal{};
  double radius = 0;                ///< 0: not given
  int turns = 0;                    ///< TIMES of a helix; 0: not given
  std::optional<double> sweep_rad;  ///< of MOVARC: with its sign, right-handed
  std::optional<Vector3> end;       ///< a point list goes on: the arc ends at its last point
  std::uint32_t end_line = 0;
};

/// A spline that waits for the rest of its control points; numbers as written.
struct PendingSpline {
  std::uint32_t line = 0;
  std::vector<double> knots;                  ///< inner knots and one at the end
  std::vector<std::array<double, 6>> points;  ///< after the first, which is where the tool is
  bool has_axes = false;
};

using Curve = std::variant<std::monostate, PendingArc, PendingSpline>;

/// What shows that a file is whole, and where it ends.
struct Structure {
  enum class Kind : std::uint8_t { kList, kProgram };            ///< a bare list promises no end
  enum class Phase : std::uint8_t { kOpen, kEnded, kFinished };  ///< END, FINI
  Kind kind = Kind::kList;
  Phase phase = Phase::kOpen;
  std::uint32_t open_path_line = 0;  ///< TOOL PATH that waits for END-OF-PATH
  int open_sections = 0;             ///< PPRINT/BEGIN-SECTION
  bool has_closed = false;           ///< some path or section came to its end
};

/// Rotary positions that the file gives by ROTABL and words like it: points carry their axis, or
/// they depend on the machine.
struct RotaryWord {
  std::uint32_t line = 0;  ///< 0: none is waiting for a point that carries its axis
  std::string text;
};

/// What the points under CUTCOM are: Creo alone writes it.
enum class CutcomPath : std::uint8_t { kNotReported, kOfTool, kOfPart };

/// Everything in a CL file that holds for later statements, and what reading them has given.
struct Modal {
  explicit Modal(ClReaderOptions reader_options, LookAhead unit_ahead = {})
      : options(std::move(reader_options)),
        look_ahead(std::move(unit_ahead)),
        dialect(options.dialect),
        frames(options.frame),
        path(summary, remarks) {
    axis.in_w = frames.direction(axis.in_w);
  }
  Modal(const Modal&) = delete;
  Modal& operator=(const Modal&) = delete;

  const ClReaderOptions options;
  const LookAhead look_ahead;  ///< empty: a language whose feeds name no unit
  ClSummary summary;
  Remarks remarks;
  DialectFinder dialect;
  FrameChain frames;
  Copies copies;
  Units units;
  ToolAxis axis;
  WrittenFeed written_feed;
  std::optional<MotionFeed> feed;  ///< nothing: to be resolved at the next cut
  Spindle spindle;
  NextMotion next = NextMotion::kFeed;
  BlockJoin join = BlockJoin::kByMachine;
  Curve curve;
  std::optional<std::array<double, 3>> forward;  ///< INDIRV
  std::optional<HoleCycle> cycle, last_cycle;
  bool is_cycle_of_path_before = false;  ///< END-OF-PATH came while it was on
  CycleReturn cycle_return = CycleReturn::kToRetract;  ///< CYCLE/INIT, CYCLE/CLEAR
  std::optional<Vector3> before_cycle;                 ///< where the tool was
  std::uint64_t holes_of_cycle = 0;
  std::optional<std::uint32_t> tool;
  std::optional<double> work_offset;  ///< of the MCSYS words
  RotaryWord rotary;
  CutcomPath cutcom_path = CutcomPath::kNotReported;
  Structure structure;
  std::uint64_t refusals = 0;  ///< statements that were refused so far
  BlockPath path;
};

}  // namespace meridian::cl
