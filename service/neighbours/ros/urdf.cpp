// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/urdf.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <iterator>
#include <locale>
#include <sstream>
#include <string_view>
#include <vector>

#include "service/machine/scene/bodies.hpp"
#include "service/machine/scene/link_frames.hpp"
#include "service/neighbours/ros/units.hpp"

namespace meridian::ros {
namespace {

[[nodiscard]] std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

/// Roll, pitch, yaw as URDF has them: about the fixed axes x, y, z, one after the other.
[[nodiscard]] Vector3 roll_pitch_yaw(const Eigen::Matrix3d& rotation) {
  const double pitch = std::atan2(-rotation(2, 0), std::hypot(rotation(0, 0), rotation(1, 0)));
  if (std::abs(rotation(2, 0)) > 1 - 1e-12) {  // about one axis alone: all of it is the yaw
    return {0, pitch, std::atan2(-rotation(0, 1), rotation(1, 1))};
  }
  return {std::atan2(rotation(2, 1), rotation(2, 2)), pitch,
          std::atan2(rotation(1, 0), rotation(0, 0))};
}

class Description {
 public:
  explicit Description(const MachineModel& model)
      : model_(model), frames_(model), bodies_(scene::bodies_of(model, frames_, tool_mm())) {
    text_.imbue(std::locale::classic());
    text_.precision(12);
  }

  [[nodiscard]] std::string text() {
    text_ << "<?xml version=\"1.0\"?>\n<robot name=\"" << escaped(model_.name) << "\">\n";
    materials();
    link(scene::LinkFrames::root());
    const std::vector<scene::LinkFrame> at_zero = frames_.at(JointVector{}, tool_mm());
    const std::size_t head = frames_.tree().head.size();
    for (std::size_t i = 0; i < at_zero.size(); ++i) {
      const bool is_table = i > head;
      const auto& screws = is_table ? frames_.tree().table : frames_.tree().head;
      const std::size_t at = is_table ? i - head - 1 : i;
      link(at_zero[i].name);
      joint(at_zero[i], at < screws.size() ? &screws[at] : nullptr);
    }
    text_ << "</robot>\n";
    return text_.str();
  }

 private:
  [[nodiscard]] double tool_mm() const noexcept { return model_.tool_length_mm; }

  void numbers(std::string_view name, const Vector3& value) {
    text_ << " " << name << "=\"" << value.x() << " " << value.y() << " " << value.z() << "\"";
  }
  void origin(const char* indent, const Vector3& from_mm, const Eigen::Matrix3d& rotation) {
    text_ << indent << "<origin";
    numbers("xyz", Vector3(from_mm * m_from_mm(1)));
    numbers("rpy", roll_pitch_yaw(rotation));
    text_ << "/>\n";
  }

  void materials() {
    struct Material {
      const char *name, *rgba;
    };
    constexpr Material kMaterials[] = {{"base", "0.35 0.38 0.42 1"},
                                       {"moving", "0.62 0.66 0.71 1"},
                                       {"joint", "0.16 0.47 0.75 1"},
                                       {"table", "0.30 0.33 0.37 0.7"},
                                       {"tool", "0.95 0.62 0.14 1"}};
    for (const Material& material : kMaterials) {
      text_ << "  <material name=\"" << material.name << "\"><color rgba=\"" << material.rgba
            << "\"/></material>\n";
    }
  }
  [[nodiscard]] static const char* material_of(scene::Part part) noexcept {
    switch (part) {
      case scene::Part::kBase:
        return "base";
      case scene::Part::kMoving:
        return "moving";
      case scene::Part::kJoint:
        return "joint";
      case scene::Part::kTable:
        return "table";
      case scene::Part::kTool:
        break;
    }
    return "tool";
  }

  void link(const std::string& name) {
    text_ << "  <link name=\"" << escaped(name) << "\">\n";
    for (const scene::Body& body : bodies_) {
      if (body.frame == name) visual(body);
    }
    text_ << "  </link>\n";
  }
  void visual(const scene::Body& body) {
    text_ << "    <visual>\n";
    origin("      ", body.centre_mm, scene::from_z_to(body.axis).toRotationMatrix());
    const double length = m_from_mm(body.length_mm), width = m_from_mm(body.width_mm);
    text_ << "      <geometry>";
    if (body.shape == scene::Shape::kBox) {
      text_ << "<box";
      numbers("size", {width, width, length});
      text_ << "/>";
    } else {
      text_ << "<cylinder radius=\"" << width / 2 << "\" length=\"" << length << "\"/>";
    }
    text_ << "</geometry>\n      <material name=\"" << material_of(body.part)
          << "\"/>\n    </visual>\n";
  }

  /// The joint between a link and its parent; fixed where no screw moves it.
  void joint(const scene::LinkFrame& frame, const scene::Screw* screw) {
    const JointSpec* const spec =
        screw != nullptr ? &model_.joints[static_cast<std::size_t>(screw->joint)] : nullptr;
    const char* const type = spec == nullptr    ? "fixed"
                             : !spec->is_rotary ? "prismatic"
                             : spec->is_endless ? "continuous"
                                                : "revolute";
    text_ << "  <joint name=\"" << escaped(spec != nullptr ? spec->name : frame.name + "_mount")
          << "\" type=\"" << type << "\">\n";
    text_ << "    <parent link=\"" << escaped(frame.parent) << "\"/>\n    <child link=\""
          << escaped(frame.name) << "\"/>\n";
    origin("    ", frame.pose.translation(), frame.pose.linear());
    if (spec != nullptr) {
      text_ << "    <axis";
      numbers("xyz", screw->direction);
      text_ << "/>\n";
      limits(*spec);
    }
    text_ << "  </joint>\n";
  }
  /// The effort, which URDF requires, is not known here: nobody is to drive by it.
  void limits(const JointSpec& spec) {
    text_ << "    <limit";
    if (!(spec.is_rotary && spec.is_endless)) {
      text_ << " lower=\"" << in_ros_units(spec, spec.limits.travel_min) << "\" upper=\""
            << in_ros_units(spec, spec.limits.travel_max) << "\"";
    }
    text_ << " velocity=\"" << in_ros_units(spec, spec.limits.velocity) << "\" effort=\"0\"/>\n";
  }

  const MachineModel& model_;
  scene::LinkFrames frames_;
  std::vector<scene::Body> bodies_;
  std::ostringstream text_;
};

}  // namespace

std::string urdf_of(const MachineModel& model) { return Description(model).text(); }

}  // namespace meridian::ros
