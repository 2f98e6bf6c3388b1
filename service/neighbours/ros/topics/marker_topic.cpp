// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/topics/marker_topic.hpp"

#include <array>

#include "service/neighbours/ros/message_types.hpp"
#include "service/neighbours/ros/units.hpp"

namespace meridian::ros {
namespace {

// Of visualization_msgs/Marker.
constexpr std::int32_t kCube = 1, kCylinder = 3, kLineStrip = 4;
constexpr double kTrailWidth_m = 0.0005;

using Colour = std::array<float, 4>;

[[nodiscard]] Colour colour_of(scene::Part part) noexcept {
  switch (part) {
    case scene::Part::kBase:
      return {0.35F, 0.38F, 0.42F, 1};
    case scene::Part::kMoving:
      return {0.62F, 0.66F, 0.71F, 1};
    case scene::Part::kJoint:
      return {0.16F, 0.47F, 0.75F, 1};
    case scene::Part::kTable:
      return {0.30F, 0.33F, 0.37F, 0.7F};
    case scene::Part::kTool:
      break;
  }
  return {0.95F, 0.62F, 0.14F, 1};
}
constexpr Colour kTrailColour{1, 0.35F, 0.21F, 1};

struct Marker {
  std::string_view frame, name;
  std::int32_t id = 0, type = 0;
  Vector3 centre_m = Vector3::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Vector3 size_m = Vector3::Zero();
  Colour colour{};
};

/// What stands in front of its points.
void put_marker(Cdr& message, std::int64_t due_ns, const Marker& marker) {
  message.put_header(due_ns, marker.frame).put(marker.name);
  message.put(marker.id).put(marker.type).put(std::int32_t{0});  // to be added
  for (const double value : marker.centre_m) message.put(value);
  for (const double part : marker.rotation.coeffs()) message.put(part);
  for (const double value : marker.size_m) message.put(value);
  for (const float part : marker.colour) message.put(part);
  message.put(std::int32_t{0}).put(std::uint32_t{0});  // lives on
  message.put(true);                                   // and moves with its frame
}

/// What stands behind its points: colours, texture, text and mesh, of which there are none.
void put_marker_end(Cdr& message) {
  message.put_count(0).put("");
  message.put_time(0).put("").put("").put_count(0).put_count(0);
  message.put("").put("").put("").put_count(0).put(false);
}

}  // namespace

MarkerTopic::MarkerTopic(mcap::Writer& writer, const MachineModel& model,
                         const scene::LinkFrames& frames)
    : writer_(writer),
      machine_(add_topic(writer, "/machine", markers_type())),
      trail_(add_topic(writer, "/trail", markers_type())),
      bodies_(scene::bodies_of(model, frames, model.tool_length_mm)) {
  points_.reserve(kMaxPoints);
}

void MarkerTopic::write(std::int64_t due_ns, const Vector3& tip_mm) {
  if (!has_bodies_) write_bodies(due_ns);
  has_bodies_ = true;
  if (point_pace_.is_due(due_ns) && tip_mm.allFinite()) {
    const Array3 point{rounded(m_from_mm(tip_mm.x()), kScreenPlaces),
                       rounded(m_from_mm(tip_mm.y()), kScreenPlaces),
                       rounded(m_from_mm(tip_mm.z()), kScreenPlaces)};
    if (points_.size() < kMaxPoints) {
      points_.push_back(point);
    } else {
      points_[oldest_] = point;
      oldest_ = (oldest_ + 1) % kMaxPoints;
    }
    is_written_ = false;
  }
  if (trail_pace_.is_due(due_ns)) write_trail(due_ns);
}

void MarkerTopic::finish(std::int64_t due_ns) {
  if (!is_written_) write_trail(due_ns);
}

void MarkerTopic::write_bodies(std::int64_t due_ns) {
  message_.begin().put_count(bodies_.size());
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const scene::Body& body = bodies_[i];
    const double width = m_from_mm(body.width_mm);
    put_marker(message_, due_ns,
               {.frame = body.frame,
                .name = "machine",
                .id = static_cast<std::int32_t>(i),
                .type = body.shape == scene::Shape::kBox ? kCube : kCylinder,
                .centre_m = 1e-3 * body.centre_mm,
                .rotation = scene::from_z_to(body.axis),
                .size_m = Vector3(width, width, m_from_mm(body.length_mm)),
                .colour = colour_of(body.part)});
    message_.put_count(0);
    put_marker_end(message_);
  }
  (void)writer_.write(machine_, static_cast<std::uint64_t>(due_ns), message_.bytes());
}

void MarkerTopic::write_trail(std::int64_t due_ns) {
  is_written_ = true;
  message_.begin().put_count(1);
  put_marker(message_, due_ns,
             {.frame = "workpiece",
              .name = "trail",
              .type = kLineStrip,
              .size_m = Vector3(kTrailWidth_m, 0, 0),
              .colour = kTrailColour});
  message_.put_count(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    for (const double value : points_[(oldest_ + i) % points_.size()]) message_.put(value);
  }
  put_marker_end(message_);
  (void)writer_.write(trail_, static_cast<std::uint64_t>(due_ns), message_.bytes());
}

}  // namespace meridian::ros
