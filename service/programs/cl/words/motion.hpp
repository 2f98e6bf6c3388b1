// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "service/programs/cl/interpreter/modal.hpp"
#include "service/programs/cl/refusal.hpp"
#include "service/programs/cl/text/statement.hpp"

/// What every word that moves needs: unit and frames in force, points and axes in W, a feed.
namespace meridian::cl {

inline constexpr double kAxisNormTolerance = 1e-3;  ///< a rounded or sloppy axis is normalised

/// Puts unit and frames in force that were set since the motion before.
[[nodiscard]] Outcome begin_motion(Modal& m, std::uint32_t line);

/// copying.cpp: the transformation of the pattern that is repeated, for the points behind; `before`
/// was in force so far.
void put_copy_in_force(Modal& m, const Frame& before);

/// A point as written, in W; refused beyond 1e6 mm.
[[nodiscard]] Expected<Vector3, Refusal> point_in_w(const Modal& m, const double* xyz);

/// A tool axis as written becomes the modal one.
[[nodiscard]] Outcome set_axis(Modal& m, const double* ijk, ToolAxis::Source source);

/// What the tool axis is at a point that leaves it out: as the dialect means it.
[[nodiscard]] Outcome axis_left_out(Modal& m, std::uint32_t line);

/// Refuses a feed that contradicts the default unit of a file without a unit word.
[[nodiscard]] Outcome check_unit_by_feed(const Modal& m, FeedUnit feed);

/// The feed of the motion that comes: RAPID is used up by it.
[[nodiscard]] Expected<MotionFeed, Refusal> next_feed(Modal& m, std::uint32_t line);

/// The feed in force, whatever RAPID says.
[[nodiscard]] Expected<MotionFeed, Refusal> cutting_feed(Modal& m, std::uint32_t line);

/// Three numbers of a statement from `first` on.
[[nodiscard]] inline std::array<double, 3> numbers_from(const Statement& s, std::size_t first) {
  return {s.arguments[first].number, s.arguments[first + 1].number, s.arguments[first + 2].number};
}

/// arcs.cpp: the arc of `pending` to `tip`, with the modal axis.
[[nodiscard]] Outcome run_arc(Modal& m, const PendingArc& pending, const Vector3& tip,
                              std::uint32_t line);
/// arcs.cpp: the arc whose end a list of points has still to give.
[[nodiscard]] Outcome end_listed_arc(Modal& m);

/// cycles.cpp: the hole of the active cycle at `point`, along the modal axis.
[[nodiscard]] Outcome run_hole(Modal& m, const Vector3& point, std::uint32_t line);

}  // namespace meridian::cl
