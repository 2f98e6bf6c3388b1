// SPDX-License-Identifier: Apache-2.0
#include "service/neighbours/ros/message_types.hpp"

#include <algorithm>
#include <cctype>
#include <initializer_list>

#include "meridian/cycle/cycle_data.hpp"
#include "meridian/kinematics/limited.hpp"
#include "service/recording/record/words.hpp"

namespace meridian::ros {
namespace {

struct Definition {
  std::string_view name;  ///< package/Type
  std::string_view text;
};

constexpr Definition kTime{"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"};
constexpr Definition kHeader{"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"};
constexpr Definition kPoint{"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"};
constexpr Definition kVector{"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"};
constexpr Definition kQuaternion{"geometry_msgs/Quaternion",
                                 "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"};
constexpr Definition kPose{"geometry_msgs/Pose",
                           "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"};

/// A definition with those of `others` that it refers to behind it, as readers of MCAP expect them.
[[nodiscard]] std::string with(std::string text, std::initializer_list<Definition> others) {
  for (const Definition& other : others) {
    if (text.find(other.name) == std::string::npos) continue;
    text.append(80, '=').append("\nMSG: ").append(other.name).append("\n").append(other.text);
  }
  return text;
}

/// Constants and the field that has them, so that a plot shows words.
template <class Enum>
void add_enum(std::string& text, const std::string& field, Enum last) {
  for (int i = 0; i <= static_cast<int>(last); ++i) {
    std::string name = field + "_" + std::string(record::word(static_cast<Enum>(i)));
    for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    text.append("uint8 ").append(name).append("=").append(std::to_string(i)).append("\n");
  }
  text.append("uint8 ").append(field).append("\n");
}

[[nodiscard]] std::string fields_of(std::string_view type, const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : field_names(names)) {
    text.append(type).append(" ").append(name).append("\n");
  }
  return text;
}

[[nodiscard]] std::vector<std::string> limited_names(const MachineModel& model) {
  std::vector<std::string> names;
  for (int i = 0; i < limited_count(model); ++i) names.push_back(limited_spec(model, i).name);
  return names;
}

[[nodiscard]] std::vector<std::string> drive_names(const MachineModel& model) {
  std::vector<std::string> names;
  for (int i = 0; i < model.joint_count; ++i) names.push_back(drive_spec(model, i).name);
  return names;
}

}  // namespace

MessageType joint_state_type() {
  return {"sensor_msgs/msg/JointState",
          with("std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n"
               "float64[] effort\n",
               {kHeader, kTime})};
}

MessageType pose_stamped_type() {
  return {"geometry_msgs/msg/PoseStamped", with("std_msgs/Header header\ngeometry_msgs/Pose pose\n",
                                                {kHeader, kTime, kPose, kPoint, kQuaternion})};
}

MessageType log_type() {
  return {"rcl_interfaces/msg/Log",
          with("byte DEBUG=10\nbyte INFO=20\nbyte WARN=30\nbyte ERROR=40\nbyte FATAL=50\n"
               "builtin_interfaces/Time stamp\nuint8 level\nstring name\nstring msg\n"
               "string file\nstring function\nuint32 line\n",
               {kTime})};
}

MessageType transforms_type() {
  return {"tf2_msgs/msg/TFMessage",
          with("geometry_msgs/TransformStamped[] transforms\n",
               {{"geometry_msgs/TransformStamped",
                 "std_msgs/Header header\nstring child_frame_id\n"
                 "geometry_msgs/Transform transform\n"},
                kHeader,
                kTime,
                {"geometry_msgs/Transform",
                 "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
                kVector,
                kQuaternion})};
}

MessageType markers_type() {
  return {"visualization_msgs/msg/MarkerArray",
          with("visualization_msgs/Marker[] markers\n",
               {{"visualization_msgs/Marker",
                 "int32 CUBE=1\nint32 CYLINDER=3\nint32 LINE_STRIP=4\nint32 ADD=0\n"
                 "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\n"
                 "geometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\n"
                 "std_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\n"
                 "bool frame_locked\ngeometry_msgs/Point[] points\n"
                 "std_msgs/ColorRGBA[] colors\nstring texture_resource\n"
                 "sensor_msgs/CompressedImage texture\n"
                 "visualization_msgs/UVCoordinate[] uv_coordinates\nstring text\n"
                 "string mesh_resource\nvisualization_msgs/MeshFile mesh_file\n"
                 "bool mesh_use_embedded_materials\n"},
                kHeader,
                kTime,
                kPose,
                kPoint,
                kQuaternion,
                kVector,
                {"std_msgs/ColorRGBA", "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"},
                {"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
                {"sensor_msgs/CompressedImage",
                 "std_msgs/Header header\nstring format\nuint8[] data\n"},
                {"visualization_msgs/UVCoordinate", "float32 u\nfloat32 v\n"},
                {"visualization_msgs/MeshFile", "string filename\nuint8[] data\n"}})};
}

MessageType cycle_type(const MachineModel& model, const Contents& contents) {
  std::string text =
      "std_msgs/Header header\n"
      "uint64 cycle\n"
      "meridian_msgs/Positions position  # sent, m or rad\n"
      "geometry_msgs/Point tip  # in the workpiece frame, m\n";
  if (contents.has_feedback) text += "meridian_msgs/Feedback feedback  # of the drives, m or rad\n";
  if (contents.has_state) text += "uint64 block  # number in the program\nfloat64 plan_time  # s\n";
  if (contents.has_velocity) text += "meridian_msgs/Velocities velocity  # m/s or rad/s\n";
  text +=
      "meridian_msgs/Axis axis  # of the tool, to the shank, in the workpiece frame\n"
      "float32 feed  # of the tip against the workpiece, m/s\n"
      "float32 turn  # of the tool axis against the workpiece, rad/s\n";
  if (contents.has_state) {
    text +=
        "float32 rate  # plan time per time\n"
        "float32 lateness  # of the wake-up, s\n"
        "float32 computation  # of the cycle before, s\n";
  }
  text +=
      "uint32 line  # of the CL file\n"
      "uint16 epoch  # counts programs\n"
      "uint16 flags  # 1 drives follow, 2 moving, 4 FaultStop, 8 dry run, 16 dry run leads\n";
  if (contents.has_state) {
    add_enum(text, "state", static_cast<State>(kStateCount - 1));
    add_enum(text, "kind", MotionKind::kRewind);
  }
  if (contents.has_alarm) add_enum(text, "alarm", Alarm::kFeedbackTooFast);
  const std::string positions = fields_of("float64", limited_names(model));
  const std::string velocities = fields_of("float32", limited_names(model));
  const std::string feedback = fields_of("float64", drive_names(model));
  return {"meridian_msgs/msg/Cycle",
          with(std::move(text), {kHeader,
                                 kTime,
                                 kPoint,
                                 {"meridian_msgs/Positions", positions},
                                 {"meridian_msgs/Velocities", velocities},
                                 {"meridian_msgs/Feedback", feedback},
                                 {"meridian_msgs/Axis", "float32 x\nfloat32 y\nfloat32 z\n"}})};
}

MessageType limit_shares_type(const MachineModel& model) {
  return {"meridian_msgs/msg/LimitShares",
          with("std_msgs/Header header\n" + fields_of("meridian_msgs/Shares", limited_names(model)),
               {kHeader,
                kTime,
                {"meridian_msgs/Shares",
                 "# largest share of the limit since the message before, 1 is the limit\n"
                 "float32 velocity\nfloat32 acceleration\nfloat32 jerk\n"}})};
}

MessageType drives_type(const MachineModel& model, const Contents& contents) {
  std::string text =
      "std_msgs/Header header\n"
      "uint64 cycle_seen  # newest setpoint that the drives had taken\n";
  std::string drive =
      "# feedback less the setpoint that it had seen, m or rad, the largest since the message "
      "before\n"
      "float32 following_error\n";
  if (contents.has_statuswords) {
    text += "float64 age  # of the newest report, s; -1: none yet\nbool emergency_stop\n";
    drive += "uint16 statusword  # CiA 402, 6041h; 0: silent\nuint16 error  # CiA 402, 603Fh\n";
  }
  return {"meridian_msgs/msg/Drives",
          with(text + fields_of("meridian_msgs/Drive", drive_names(model)),
               {kHeader, kTime, {"meridian_msgs/Drive", drive}})};
}

std::vector<std::string> field_names(const std::vector<std::string>& names) {
  std::vector<std::string> out;
  for (const std::string& name : names) {
    std::string field;
    for (const char c : name) {
      const auto letter = static_cast<unsigned char>(c);
      field.push_back(letter < 128 && std::isalnum(letter) != 0
                          ? static_cast<char>(std::tolower(letter))
                          : '_');
    }
    if (field.empty() || std::isalpha(static_cast<unsigned char>(field[0])) == 0) {
      field.insert(0, "joint_");
    }
    std::string free = field;
    for (int n = 2; std::find(out.begin(), out.end(), free) != out.end() || free == "header"; ++n) {
      free = field + "_" + std::to_string(n);
    }
    out.push_back(std::move(free));
  }
  return out;
}

std::uint16_t add_topic(mcap::Writer& writer, std::string_view topic, const MessageType& type) {
  return writer.add_channel(writer.add_schema(type.name, "ros2msg", type.text), topic, "cdr");
}

}  // namespace meridian::ros
