// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "service/recording/record/check/path/free_space.hpp"

namespace meridian::record {

/// How a CL vertex was passed: the best that the matchings allow.
struct VertexPass {
  std::size_t index = 0;  ///< 0: begin of the path; n: end of element n - 1
  double tip_mm = Interval::kNone, axis_rad = Interval::kNone;  ///< off it
  double share = Interval::kNone;                               ///< of the tolerances
  bool is_in_gap = false;  ///< cycles are missing where it may have been passed
};

/// Decides whether a recording follows a path: is there a monotone matching of the two, from begin
/// to end, in which tip and axis are within tolerance all along? Reachability in the plane of
/// recording and path, so it loses no position and takes none that cannot be:
///
///     path ▲                       Free: pose and path position are within tolerance. From the
///        2 ┤      ░░▒▒▒▒▒──end     begin the reached part of it (▒) goes right and up alone.
///          │     ░▒▒▒░             Each column (a commanded pose) holds the reached parameters of
///        1 ┼───▒▒▒▒░───────        a few elements; crossing a row (a vertex) takes a chord between
///          │ ▒▒▒▒░                 two poses that comes within tolerance of that vertex.
///        0 begin─┬────┬────▶ recording
///
/// One column is kept, of the elements that are reached, so memory is bounded by how many of them
/// fit into the tolerance. Poses that repeat may be left out.
///
/// Where nothing is reached there is no matching, whatever follows. To say what is wrong it goes on
/// with the least factor on the tolerances that reaches something there, or with the next element
/// ahead that the pose is within tolerance of.
///
/// Units: mm, rad, s. Proof: tests/unit/record/path_matching_test.cpp (against a dynamic program).
class PathMatching {
 public:
  /// What became of the matching at a pose.
  enum class Step : std::uint8_t {
    kWithin,   ///< goes on within tolerance
    kWidened,  ///< with wider tolerances
    kResumed,  ///< on an element farther ahead, within tolerance
    kAstray    ///< nowhere near: deviations are those from where it was last
  };

  /// One element at least.
  explicit PathMatching(std::span<const PathElement> elements) : elements_(elements) {}

  /// The tool goes straight to `pose`, where `tolerance` holds. The first one is the begin.
  Step move(const GaugePose& pose, const Tolerance& tolerance);
  /// Rows are missing before `pose`: the tool may have cut all that takes no more than `time_s`
  /// at `factor` times the programmed feed; where there is none, and above it, at the fastest.
  struct Gap {
    double time_s = 0, factor = 1, fastest_mm_per_s = 0, fastest_rad_per_s = 0;
  };
  Step cross(const GaugePose& pose, const Tolerance& tolerance, const Gap& gap);
  /// The recording is over: is the end of the path reached at its last pose?
  [[nodiscard]] bool finish();

  /// There is no matching within tolerance.
  [[nodiscard]] bool is_broken() const noexcept { return is_broken_; }

  struct Position {
    std::size_t element = 0;
    double t = 0;
  };
  /// Where the tool may be at the last pose: all matchings are between them.
  [[nodiscard]] Position lowest() const noexcept;
  [[nodiscard]] Position highest() const noexcept;
  /// The best match of the last pose, of those that are reached.
  [[nodiscard]] PoseMatch best() const;

  /// Vertices that the tool has surely left, in order. The caller clears them.
  [[nodiscard]] std::vector<VertexPass>& passed() noexcept { return passed_; }
  /// Those that may still be passed, as far as they were.
  [[nodiscard]] std::span<const VertexPass> open() const noexcept { return vertices_; }

 private:
  [[nodiscard]] bool reach(double factor);
  [[nodiscard]] bool widen();
  [[nodiscard]] bool resume();
  Step recover();
  Step look_for_it();
  void extend(const Gap& gap, Position from);
  void adopt();
  void pass_below_first();
  [[nodiscard]] double cross_vertex(std::size_t index, bool is_left, double entry, double factor);
  [[nodiscard]] VertexPass& vertex(std::size_t index);

  std::span<const PathElement> elements_;
  bool has_begun_ = false, is_broken_ = false, is_astray_ = false, is_at_end_ = false;
  GaugePose here_, next_;
  Tolerance tolerance_;
  double factor_ = 1;          ///< on the tolerances at the last pose
  double look_at_factor_ = 0;  ///< beyond it the path ahead is looked at
  int early_looks_ = 0;
  GaugePose looked_from_;                ///< the last look at the path ahead while astray
  double look_step_mm_ = 0;              ///< to the next one
  std::size_t first_ = 0;                ///< element of cells_[0]
  std::vector<Interval> cells_, ahead_;  ///< what is reached of each at the last pose, at the next
  std::vector<VertexPass> vertices_;     ///< from first_vertex_ on
  std::size_t first_vertex_ = 0;
  std::vector<VertexPass> passed_;
};

/// A chord between samples cuts no more than this off a smooth motion, mm.
inline constexpr double kSag_mm = 1e-4;

}  // namespace meridian::record
