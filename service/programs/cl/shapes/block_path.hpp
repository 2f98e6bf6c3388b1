// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "meridian/geometry/vector3.hpp"
#include "meridian/path/cl_block.hpp"
#include "service/programs/cl/cl_summary.hpp"
#include "service/programs/cl/interpreter/feed.hpp"
#include "service/programs/cl/refusal.hpp"
#include "service/programs/cl/remarks.hpp"

namespace meridian::cl {

inline constexpr double kMinMove_mm = 1e-9;  ///< below it a block moves nothing

/// An arc or helix as a file gives it, in W. Units: mm, rad.
struct ArcPath {
  Vector3 centre, normal;  ///< the tip turns right-handed about the normal
  double radius = 0;       ///< 0: not given
  int turns = 0;           ///< of a helix, the last one begun; 0: not given
  std::uint32_t line = 0;  ///< of the word that gives it
};

/// Where the tool goes: turns lines and arcs into blocks, one after the other, and counts them.
/// Everything in W, mm, rad, s. Proof: tests/unit/cl/motion_test.cpp, arc_test.cpp.
class BlockPath {
 public:
  using Blocks = std::vector<ClBlock>;

  BlockPath(ClSummary& summary, Remarks& remarks) : summary_(summary), remarks_(remarks) {}

  /// Blocks go there from now on.
  void give_to(Blocks& out) noexcept { out_ = &out; }
  void set_max_feed(double mm_per_s) noexcept { max_feed_ = mm_per_s; }

  enum class Position : std::uint8_t {
    kUnknown,
    kReported,  ///< by FROM: no block ends there
    kReached,   ///< the last motion block ended there
    kLost       ///< a motion was refused: the next one is only checked for itself
  };
  [[nodiscard]] Position position() const noexcept { return position_; }
  [[nodiscard]] const Vector3& tip() const noexcept { return tip_; }
  [[nodiscard]] const Vector3& axis() const noexcept { return axis_; }
  [[nodiscard]] bool has_moved() const noexcept;

  /// FROM: the tool is there; a block only where a cut or an arc begins there.
  void set_from(const Vector3& tip, const Vector3& axis, std::uint32_t line);
  void lose_position() noexcept { position_ = Position::kLost; }

  [[nodiscard]] Outcome line_to(const Vector3& tip, const Vector3& axis, const MotionFeed& feed,
                                std::uint32_t line);
  /// The arc from where the tool is to `tip`.
  [[nodiscard]] Outcome arc_to(const ArcPath& arc, const Vector3& tip, const Vector3& axis,
                               const MotionFeed& feed, std::uint32_t line);
  void act(BlockKind kind, ActionKind what, double value, std::uint32_t line);
  void vendor_word(std::string_view text, double value, std::uint32_t line);

 private:
  [[nodiscard]] ClBlock block(BlockKind kind, std::uint32_t line) const;
  void emit(ClBlock block);
  void emit_motion(const ClBlock& block, double length_mm);
  [[nodiscard]] Outcome begin_at_from(std::uint32_t line);
  void account_axis(const Vector3& axis, double change_chord);
  void suspect_metric(const ClBlock& block);
  void check_arc_gap(const struct Arc& arc, const Vector3& end, std::uint32_t line);
  void check_arc_sense(const Vector3& tangent, std::uint32_t line);
  void emit_turns(const struct Arc& arc, int whole_turns, const Vector3& axis, ClBlock block,
                  double rest_mm);

  ClSummary& summary_;
  Remarks& remarks_;
  Blocks* out_ = nullptr;
  double max_feed_ = 0;
  std::uint64_t sequence_ = 0;
  Position position_ = Position::kUnknown;
  std::uint32_t from_line_ = 0;
  Vector3 tip_ = Vector3::Zero();
  Vector3 axis_ = Vector3::UnitZ();
  Vector3 direction_ = Vector3::Zero();  ///< of the last straight motion, unit; zero: none
  std::uint64_t arcs_along_ = 0, arcs_against_ = 0;
  double axis_z_min_ = 2, axis_z_max_ = -2;
  double change_chord_max_ = 0;
};

}  // namespace meridian::cl
