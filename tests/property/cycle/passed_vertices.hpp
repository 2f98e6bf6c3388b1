// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "meridian/geometry/great_circle.hpp"
#include "meridian/geometry/vector3.hpp"
#include "meridian/path/cl_block.hpp"

namespace meridian::test {

/// The other way of the tolerance: how far the way of the tool stays away from the vertices of its
/// program, tip and axis together.
class PassedVertices {
 public:
  PassedVertices(const std::vector<ClBlock>& blocks, double tip_mm, double axis_rad)
      : tip_mm_(tip_mm), axis_rad_(axis_rad) {
    double u = 0;
    for (const ClBlock& block : blocks) {
      const ToolPose pose{to_vector(block.tip_mm), to_vector(block.axis).normalized()};
      if (is_motion(block.kind)) {
        const ToolPose& last = vertices_.empty() ? pose : vertices_.back().pose;
        begin_.push_back(u);
        u += std::hypot((pose.tip - last.tip).norm(), 50 * angle_between(pose.axis, last.axis));
        vertices_.push_back({pose, u, kNever});
      } else {
        begin_.push_back(u);
      }
      end_.push_back(u);
    }
  }

  /// The next pose of the tool, while the block at `index` is cut. `goes_on`: one cycle behind the
  /// last one, so that the tool took the straight way but for the sag of an even acceleration.
  void add(std::size_t index, const ToolPose& pose, bool goes_on) {
    poses_ = {poses_[1], poses_[2], pose};
    known_ = goes_on ? std::min(known_ + 1, 3) : 1;
    farthest_ = std::max(farthest_, index);
    const double low = begin_[index] - kBehind_mm, high = end_[index] + kAhead_mm;
    const auto first = std::lower_bound(vertices_.begin(), vertices_.end(), low,
                                        [](const Vertex& v, double u) { return v.u < u; });
    for (auto vertex = first; vertex != vertices_.end() && vertex->u <= high; ++vertex) {
      vertex->off = std::min(vertex->off, off(vertex->pose, vertex->off));
    }
  }

  /// Largest distance, in tolerances, from a vertex that the tool has left behind, of all of them
  /// where the program `is_over`.
  [[nodiscard]] double worst(bool is_over) const {
    double worst = 0;
    for (const Vertex& vertex : vertices_) {
      if (!is_over && vertex.u >= begin_[farthest_]) break;
      worst = std::max(worst, vertex.off);
    }
    return worst;
  }

 private:
  static constexpr double kNever = 1e9;
  static constexpr double kBehind_mm = 0.3, kAhead_mm = 2.5;  // a span is named by where it begins

  struct Vertex {
    ToolPose pose;
    double u = 0;    ///< chord length from the first, 50 mm per rad of the axis
    double off = 0;  ///< least distance so far, in tolerances
  };

  /// Distance of the vertex from the way between the last two poses, if it is below `min`.
  [[nodiscard]] double off(const ToolPose& vertex, double min) const {
    const ToolPose& from = poses_[known_ > 1 ? 1 : 2];
    const Vector3 tip = poses_[2].tip - from.tip, axis = poses_[2].axis - from.axis;
    const double sag =
        known_ < 3 ? 0 : (poses_[0].tip - 2 * poses_[1].tip + poses_[2].tip).norm() / 8;
    const auto off_at = [&](double t) {
      const double to_tip = (from.tip + t * tip - vertex.tip).norm() - sag;
      return std::max(to_tip / tip_mm_, (from.axis + t * axis - vertex.axis).norm() / axis_rad_);
    };
    const double at_end = off_at(1);
    if (at_end - std::max(tip.norm() / tip_mm_, axis.norm() / axis_rad_) > min) return min;
    double low = 0, high = 1;
    for (int n = 0; n < 30; ++n) {
      const double left = low + (high - low) / 3, right = high - (high - low) / 3;
      (off_at(left) < off_at(right) ? high : low) = off_at(left) < off_at(right) ? right : left;
    }
    return std::min(at_end, off_at(0.5 * (low + high)));
  }

  double tip_mm_, axis_rad_;
  std::vector<Vertex> vertices_;
  std::vector<double> begin_, end_;  ///< of every block
  std::array<ToolPose, 3> poses_{};  ///< newest last
  int known_ = 0;
  std::size_t farthest_ = 0;
};

}  // namespace meridian::test
