// SPDX-License-Identifier: Apache-2.0
#include "service/machine/inspect/pose_table.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "meridian/kinematics/jacobian.hpp"
#include "meridian/kinematics/limited.hpp"
#include "meridian/units.hpp"
#include "service/text/printed.hpp"

namespace meridian::inspect {

using text::printed;
namespace {

using nlohmann::ordered_json;

std::string column_name(const JointSpec& joint) {
  return joint.name + (joint.is_rotary ? "_deg" : "_mm");
}

double table_value(const JointSpec& joint, double value) {
  const double at_edge = joint.is_rotary ? units::deg_from_rad(value) : value;
  return std::abs(at_edge) < 5e-10 ? 0.0 : at_edge;
}

/// Windings of all joints together that travel has for this solution.
int windings_of(const MachineModel& model, const JointVector& q) {
  int count = 1;
  for (int i = 0; i < model.joint_count; ++i) {
    const Windings windings = windings_at(model, q, i);
    count *= 1 + windings.down + windings.up;
  }
  return count;
}

std::string csv_row(const std::vector<std::string>& cells) {
  std::string out;
  for (const std::string& cell : cells) out += (out.empty() ? "" : ",") + cell;
  return out + "\n";
}

/// Cells of the joints, then of what moves a stage.
std::vector<std::string> value_cells(const MachineModel& model, const JointVector& q) {
  std::vector<std::string> cells;
  const bool has_drives = has_stage(model);
  const bool is_in_reach = has_drives && stage::is_in_reach(model.stage, q);
  for (int i = 0; i < limited_count(model); ++i) {
    const bool is_drive = i >= model.joint_count;
    const double value = is_drive && !is_in_reach ? std::nan("") : limited_value(model, q, i);
    cells.push_back(printed("%.9f", table_value(limited_spec(model, i), value)));
  }
  if (has_drives) cells.push_back(printed("%.6g", std::abs(stage::determinant(model.stage, q))));
  return cells;
}

std::vector<std::string> value_names(const MachineModel& model) {
  std::vector<std::string> names = joint_columns(model);
  for (int i = model.joint_count; i < limited_count(model); ++i) {
    names.push_back("drive_" + column_name(limited_spec(model, i)));
  }
  if (has_stage(model)) names.emplace_back("dead_point_mm_per_rad");
  return names;
}

std::string outside_name(const MachineModel& model, int outside) {
  return outside < 0 ? "no" : limited_spec(model, outside).name;
}

/// Nothing where the axis is no direction.
ToolPose pose_of_row(const TableRow& row) {
  const auto& v = row.values;
  return {{v[0], v[1], v[2]}, Vector3(v[3], v[4], v[5]).normalized()};
}

/// What of a solution is outside of travel, the keep-out box that it is in, or "tip X".
std::string hindrance_of(const MachineModel& model, const PoseSolution& one) {
  if (one.outside < 0 && one.keep_out >= 0) return model.keep_out.name_of(one.keep_out);
  if (one.outside < 0 && one.tip_outside >= 0) return printed("tip %c", "XYZ"[one.tip_outside]);
  return outside_name(model, one.outside);
}

bool is_reached(const std::vector<PoseSolution>& solutions) {
  return std::any_of(solutions.begin(), solutions.end(),
                     [](const PoseSolution& one) { return one.is_possible(); });
}

JointVector joints_of_row(const MachineModel& model, const TableRow& row) {
  JointVector q{};
  for (int i = 0; i < model.joint_count; ++i) {
    const double value = row.values[static_cast<std::size_t>(i)];
    q[i] = model.joints[i].is_rotary ? units::rad_from_deg(value) : value;
  }
  return q;
}

}  // namespace

std::vector<std::string> pose_columns() { return {"x_mm", "y_mm", "z_mm", "i", "j", "k"}; }

std::vector<std::string> joint_columns(const MachineModel& model) {
  std::vector<std::string> names;
  for (int i = 0; i < model.joint_count; ++i) names.push_back(column_name(model.joints[i]));
  return names;
}

TableResult solve_table(const MachineModel& model, const std::vector<TableRow>& poses) {
  std::vector<std::string> head = {"line", "branch"};
  for (std::string& name : value_names(model)) head.push_back(std::move(name));
  for (const char* const name : {"windings", "measure", "singular", "outside_travel"}) {
    head.emplace_back(name);
  }
  TableResult out{csv_row(head), 0};
  for (const TableRow& row : poses) {
    const ToolPose pose = pose_of_row(row);
    const auto solutions = solve_all(model, pose);
    if (!is_reached(solutions)) ++out.unreached;
    if (solutions.empty()) {
      out.text +=
          printed("# line %u is out of reach: ", row.line) + why_unreachable(model, pose) + "\n";
    }
    for (const PoseSolution& one : solutions) {
      std::vector<std::string> cells = {printed("%u", row.line), printed("%d", one.branch)};
      for (std::string& cell : value_cells(model, one.q)) cells.push_back(std::move(cell));
      cells.push_back(printed("%d", windings_of(model, one.q)));
      cells.push_back(printed("%.6g", one.measure));
      cells.emplace_back(one.is_at_pole ? "yes" : "no");
      cells.push_back(hindrance_of(model, one));
      out.text += csv_row(cells);
    }
  }
  return out;
}

TableResult pose_table(const MachineModel& model, const std::vector<TableRow>& joints) {
  std::vector<std::string> head = {"line"};
  for (std::string& name : pose_columns()) head.push_back(std::move(name));
  head.emplace_back("measure");
  head.emplace_back("outside_travel");
  TableResult out{csv_row(head), 0};
  for (const TableRow& row : joints) {
    const JointVector q = joints_of_row(model, row);
    const ToolPose pose = forward(model, model.tool_length_mm, q);
    const PoseSolution here = solution_of_joints(model, q);
    if (!here.is_possible()) ++out.unreached;
    std::vector<std::string> cells = {printed("%u", row.line)};
    for (int k = 0; k < 3; ++k) cells.push_back(printed("%.9f", pose.tip[k]));
    for (int k = 0; k < 3; ++k) cells.push_back(printed("%.12f", pose.axis[k]));
    cells.push_back(printed("%.6g", measure(model, q)));
    cells.push_back(hindrance_of(model, here));
    out.text += csv_row(cells);
  }
  return out;
}

TableResult solve_table_json(const MachineModel& model, const std::vector<TableRow>& poses) {
  TableResult out;
  ordered_json all = ordered_json::array();
  for (const TableRow& row : poses) {
    const ToolPose pose = pose_of_row(row);
    const auto solutions = solve_all(model, pose);
    if (!is_reached(solutions)) ++out.unreached;
    ordered_json one = ordered_json::parse(to_json(solutions, model, pose));
    one["line"] = row.line;
    all.push_back(std::move(one));
  }
  out.text = all.dump(2) + "\n";
  return out;
}

TableResult pose_table_json(const MachineModel& model, const std::vector<TableRow>& joints) {
  TableResult out;
  ordered_json all = ordered_json::array();
  for (const TableRow& row : joints) {
    const JointVector q = joints_of_row(model, row);
    if (!solution_of_joints(model, q).is_possible()) ++out.unreached;
    ordered_json one = ordered_json::parse(joints_json(model, q));
    one["line"] = row.line;
    all.push_back(std::move(one));
  }
  out.text = all.dump(2) + "\n";
  return out;
}

}  // namespace meridian::inspect
