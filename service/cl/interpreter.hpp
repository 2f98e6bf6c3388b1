// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "meridian/expected.hpp"
#include "meridian/path/cl_block.hpp"
#include "service/cl/cl_error.hpp"
#include "service/cl/cl_options.hpp"
#include "service/cl/cl_summary.hpp"
#include "service/cl/statement.hpp"
#include "service/cl/words.hpp"

namespace meridian::cl {

struct Arc;

inline constexpr double kLeastMove_mm = 1e-9;  ///< below it a block moves nothing

/// Turns statements into blocks: holds what is modal in a CL file (unit, frame, tool axis, feed,
/// spindle, pending RAPID, pending arc). One statement gives no, one or several blocks.
class Interpreter {
 public:
  using Result = Expected<void, ClError>;

  Interpreter(std::string name, ClReaderOptions options);

  /// Appends the blocks of `statement` to `out`.
  [[nodiscard]] Result take(const Statement& statement, std::vector<ClBlock>& out);

  /// The text is at its end: judges whether the program is whole and appends its end block.
  [[nodiscard]] Result finish(std::uint32_t last_line, bool open_end, std::vector<ClBlock>& out);

  /// True once FINI was read; what stands behind it is not looked at.
  [[nodiscard]] bool is_finished() const noexcept { return finished_; }
  /// True once a word was met that only CL files have.
  [[nodiscard]] bool knows_a_word() const noexcept { return known_words_ > 0; }
  [[nodiscard]] ClSummary& summary() noexcept { return summary_; }
  [[nodiscard]] const ClSummary& summary() const noexcept { return summary_; }
  [[nodiscard]] const std::vector<ClWarning>& warnings() const noexcept { return warnings_; }

  [[nodiscard]] tl::unexpected<ClError> refuse(std::uint32_t line, std::string message,
                                               std::string remedy = {}) const;
  /// A remark that is not made again under the same `key`.
  void add_warning(std::string_view key, std::uint32_t line, std::string message);

 private:
  enum class FeedUnit : std::uint8_t {
    kNone,
    kPerMinute,  ///< in the unit of the file
    kMillimetrePerMinute,
    kInchPerMinute,
    kPerRevolution,  ///< in the unit of the file
    kMillimetrePerRevolution,
    kInchPerRevolution,
    kInverseTime  ///< 1/min
  };
  enum class ArcForm : std::uint8_t { kNone, kRight, kClockwise, kForward };
  struct PendingArc {
    ArcForm form = ArcForm::kNone;
    std::uint32_t line = 0;
    std::array<double, 6> centre_normal{};  ///< as written: unit and frame of the file
    double radius = 0;                      ///< as written; 0: not told
    int turns = 0;                          ///< TIMES of a helix; 0: not told
  };
  using Blocks = std::vector<ClBlock>;

  // interpreter.cpp
  Result read(const Statement& s, Blocks& out);
  Result dispatch(Word word, const Statement& s, Blocks& out);
  ClBlock block(BlockKind kind, std::uint32_t line) const;
  void emit(ClBlock block, Blocks& out);
  void action(BlockKind kind, ActionKind what, double value, std::uint32_t line, Blocks& out);
  void vendor_word(const Statement& s, Blocks& out);
  bool is_new_warning(std::string_view key) const;
  /// One warning for each key; `message` is only called for the first.
  template <class Message>
  void warn_once(std::string_view key, std::uint32_t line, Message&& message) {
    if (is_new_warning(key)) add_warning(key, line, message());
  }
  Result take_unknown(const Statement& s, Blocks& out);

  // interpreter_end.cpp
  Result take_end(const Statement& s, bool is_fini, Blocks& out);
  Result judge_behind_end(const Statement& s, std::size_t before, Blocks& out) const;
  [[nodiscard]] bool has_moved() const {
    const auto& count = summary_.blocks_by_kind;
    return count[static_cast<std::size_t>(BlockKind::kCut)] +
               count[static_cast<std::size_t>(BlockKind::kRapid)] >
           0;
  }

  // interpreter_motion.cpp
  Result take_goto(const Statement& s, Blocks& out);
  Result take_delta(const Statement& s, Blocks& out);
  Result take_from(const Statement& s);
  Result take_circle(const Statement& s);
  Result take_forward(const Statement& s);
  Result take_tool_on(const Statement& s, Blocks& out);
  Result take_tool_axis(const Statement& s);
  Result prepare_motion(std::uint32_t line);
  Result set_axis(const double* ijk, const Statement& s);
  Result point_of(const double* xyz, std::uint32_t line, Vector3& tip) const;
  /// Tip and, of six numbers, the tool axis.
  Result take_pose(const Statement& s, Vector3& tip);
  [[nodiscard]] bool is_at(const Vector3& tip) const;
  Result begin_at_from(std::uint32_t line, Blocks& out);
  Result move_to(const Vector3& tip, std::uint32_t line, Blocks& out);
  Result arc_to(const Vector3& tip, std::uint32_t line, Blocks& out);
  Result feed_into(ClBlock& block, std::uint32_t line);
  void account(const ClBlock& block, double length_mm);
  void account_axis(double change_chord);
  void suspect_metric(const ClBlock& block);
  void check_arc_gap(const Arc& arc, const Vector3& end, std::uint32_t line);
  void check_arc_sense(const Vector3& tangent, std::uint32_t line);

  // interpreter_words.cpp
  Result take_units(const Statement& s);
  static FeedUnit feed_unit_of(std::string_view word);
  Result take_feed(const Statement& s);
  struct SpindleWords {
    const Argument* speed = nullptr;
    std::optional<ActionKind> sense;
    bool turns = false;      ///< a word that only a turning spindle has
    std::string_view left;   ///< RANGE, MAXRPM: the machine's own business
    std::string_view other;  ///< the first word that is none of SPINDL's speed and sense
  };
  Expected<SpindleWords, ClError> spindle_words(const Statement& s);
  Result take_spindle(const Statement& s, Blocks& out);
  Result take_coolant(const Statement& s, Blocks& out);
  Result take_tool(const Statement& s, bool needs_tool_word, Blocks& out);
  Result take_delay(const Statement& s, Blocks& out);
  Result take_rapid(const Statement& s);
  Result take_mode(const Statement& s);
  Result take_cycle(const Statement& s);
  Result take_frame(const Statement& s, Word word);
  Result take_transform(const Statement& s);
  Result take_tool_path(const Statement& s);
  Result take_note(const Statement& s);
  void take_tool_data(const Statement& s);
  Result resolve_unit(std::uint32_t line);
  Result resolve_frame(std::uint32_t line);
  Result resolve_feed(std::uint32_t line);

  std::string name_;
  ClReaderOptions options_;
  ClSummary summary_;
  std::vector<ClWarning> warnings_;
  std::vector<std::string> warned_;  ///< keys of warn_once
  std::uint64_t sequence_ = 0;
  std::uint64_t known_words_ = 0;

  // unit and frame
  std::optional<LengthUnit> unit_word_;  ///< what the file says
  std::optional<LengthUnit> unit_;       ///< what holds
  double to_mm_ = 1;
  std::optional<Frame> written_frame_;  ///< MSYS, CSYS: origin in the unit of the file
  std::optional<Frame> reference_;      ///< the frame in force at the first motion, mm
  Frame frame_;                         ///< what poses of the file are put through

  // modal state
  Vector3 tip_ = Vector3::Zero();
  std::array<double, 3> axis_written_{0, 0, 1};
  Vector3 axis_ = Vector3::UnitZ();
  Vector3 axis_before_ = Vector3::UnitZ();
  Vector3 direction_ = Vector3::Zero();  ///< of the last straight motion, unit; zero: none
  PendingArc arc_;
  std::optional<std::array<double, 3>> forward_;  ///< INDIRV
  std::uint64_t arcs_along_ = 0, arcs_against_ = 0;

  double feed_written_ = 0;
  double feed_ = 0;  ///< mm/s or 1/s
  double spindle_rpm_ = 0;
  FeedUnit feed_unit_ = FeedUnit::kNone;
  FeedMeaning feed_meaning_ = FeedMeaning::kNone;
  ActionKind spindle_sense_ = ActionKind::kSpindleClockwise;

  // claims
  bool csys_holds_ = true;  ///< not under TRNTYP/WORLD
  bool written_is_csys_ = false;
  bool frame_dirty_ = false;
  bool frame_is_identity_ = true;
  bool motion_begun_ = false;
  bool has_position_ = false;
  bool position_told_ = false;  ///< some motion block ended at tip_
  bool rapid_ = false;
  bool feed_dirty_ = true;
  bool spindle_on_ = false;
  bool finished_ = false;
  bool end_told_ = false;
  bool sections_closed_ = false;
  bool path_closed_ = false;
  bool promises_end_ = false;  ///< words of a program, not a bare list of points
  bool metric_suspected_ = false;

  // structure and summary
  std::uint32_t from_line_ = 0;       ///< of the last FROM
  std::uint32_t open_path_line_ = 0;  ///< TOOL PATH that waits for END-OF-PATH
  int open_sections_ = 0;             ///< PPRINT/BEGIN-SECTION
  double cutter_written_ = 0;
  double axis_z_min_ = 2, axis_z_max_ = -2;
  double change_chord_max_ = 0;
};

/// "3.5" and the like for messages: six significant digits.
[[nodiscard]] std::string short_number(double value);

}  // namespace meridian::cl
