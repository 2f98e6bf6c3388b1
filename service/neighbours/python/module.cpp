// SPDX-License-Identifier: Apache-2.0
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <utility>

#include "service/machine/file/config_error.hpp"
#include "service/neighbours/python/machine.hpp"
#include "service/neighbours/python/simulation.hpp"
#include "service/recording/record/words.hpp"

namespace meridian::python {
namespace {

namespace py = pybind11;

/// The numbers of `values`, which live as long as `owner`, in rows of `columns`; 0: one dimension.
template <class T>
py::array view(const std::vector<T>& values, py::ssize_t columns, const py::object& owner) {
  const auto count = static_cast<py::ssize_t>(values.size());
  py::array_t<T> out = columns == 0
                           ? py::array_t<T>({count}, values.data(), owner)
                           : py::array_t<T>({count / columns, columns}, values.data(), owner);
  out.attr("setflags")(false);
  return out;
}

template <auto Member>
py::array column(const py::object& self) {
  return view(self.cast<const Simulation&>().*Member, 0, self);
}
template <auto Member>
py::array rows(const py::object& self) {
  const auto& run = self.cast<const Simulation&>();
  return view(run.*Member, run.joint_count, self);
}

const char* outcome_word(simulate::Outcome outcome) {
  switch (outcome) {
    case simulate::Outcome::kDone:
      return "done";
    case simulate::Outcome::kStopped:
      return "stopped";
    case simulate::Outcome::kRefused:
      return "refused";
    case simulate::Outcome::kStarved:
      return "starved";
    case simulate::Outcome::kFault:
      return "fault";
  }
  return "";
}

template <class Enum>
std::vector<std::string> words(const std::vector<std::uint8_t>& codes) {
  std::vector<std::string> out;
  out.reserve(codes.size());
  for (const std::uint8_t code : codes) {
    out.emplace_back(record::word(static_cast<Enum>(code)));
  }
  return out;
}

void add_machine(py::module_& module) {
  py::class_<BranchSolution>(module, "Solution", "One branch of the inverse kinematics at a pose.")
      .def_readonly("branch", &BranchSolution::branch)
      .def_readonly("joints", &BranchSolution::joints, "mm and rad, machine order")
      .def_readonly("measure", &BranchSolution::measure, "distance from singularity")
      .def_readonly("is_singular", &BranchSolution::is_singular)
      .def_readonly("outside", &BranchSolution::outside,
                    "name of the first joint beyond its travel, or None");
  py::class_<Machine>(module, "Machine",
                      "A machine file: kinematics, joints and limits. Units: mm, rad, s.")
      .def(py::init<const std::string&, const std::string&, std::optional<double>>(),
           py::arg("file"), py::kw_only(), py::arg("frame") = "",
           py::arg("tool_length_mm") = py::none(),
           "Reads a machine file. frame: where the workpiece lies, 'x,y,z[,a,b,c]' in mm and deg.")
      .def_property_readonly("name", [](const Machine& self) { return self.model().name; })
      .def_property_readonly("joint_names", &Machine::joint_names)
      .def_property_readonly("tool_length_mm",
                             [](const Machine& self) { return self.model().tool_length_mm; })
      .def_property_readonly(
          "cycle_s",
          [](const Machine& self) { return static_cast<double>(self.model().cycle_ns) * 1e-9; })
      .def_property_readonly("home", &Machine::home)
      .def_property_readonly("limits", &Machine::limits,
                             "A row a joint: least and largest position, velocity, acceleration, "
                             "jerk; endless joints: -inf, inf.")
      .def("forward", &Machine::forward, py::arg("joints"),
           "Poses (tip x y z, axis i j k) of joints: (joints,) to (6,), (n, joints) to (n, 6).")
      .def("inverse", &Machine::inverse, py::arg("poses"), py::kw_only(),
           py::arg("near") = py::none(),
           "Joints of poses: (6,) to (joints,), (n, 6) to (n, joints). Of the branches inside "
           "travel the one that is soonest reached from the row before, the first from `near` "
           "(home). NaN where none is.")
      .def("solutions", &Machine::solutions, py::arg("pose"),
           "Every branch that puts the tool at one pose, beyond travel too; empty: out of reach.");
}

void add_simulation(py::module_& module) {
  py::class_<Simulation>(module, "Simulation",
                         "A simulated run. Arrays have a row a cycle and cannot be written to.")
      .def_property_readonly(
          "outcome", [](const Simulation& self) { return outcome_word(self.report.outcome); },
          "done, stopped, refused, starved or fault")
      .def_property_readonly("reason", [](const Simulation& self) { return self.report.reason; })
      .def_property_readonly("program_s",
                             [](const Simulation& self) { return self.report.program_s; })
      .def_property_readonly("approach_s",
                             [](const Simulation& self) { return self.report.approach_s; })
      .def_property_readonly("cycle_s", [](const Simulation& self) { return self.report.cycle_s; })
      .def_property_readonly("cut_length_mm",
                             [](const Simulation& self) { return self.report.cut_length_mm; })
      .def_property_readonly("blocks", [](const Simulation& self) { return self.report.blocks; })
      .def_readonly("text", &Simulation::text, "the report of `meridian simulate`")
      .def_property_readonly("cycles", &column<&Simulation::cycles>)
      .def_property_readonly("lines", &column<&Simulation::lines>, "line of the file being cut")
      .def_property_readonly("plan_times", &column<&Simulation::plan_times>, "s on the plan")
      .def_property_readonly("joints", &rows<&Simulation::joints>, "mm and rad, machine order")
      .def_property_readonly("drives", &rows<&Simulation::drives>, "mm and rad, drive order")
      .def_property_readonly("velocities", &rows<&Simulation::velocities>, "of the drives")
      .def_property_readonly(
          "kinds", [](const Simulation& self) { return words<MotionKind>(self.kinds); },
          "approach, cut, rapid, pole_turn, unwind")
      .def_property_readonly("states",
                             [](const Simulation& self) { return words<State>(self.states); });
  module.def(
      "simulate",
      [](const std::string& file, const Machine& machine, const std::string& tools,
         const std::string& transition, const std::string& dialect, const std::string& units,
         std::optional<double> feed_mm_per_min, std::optional<double> unknown_tool_length_mm,
         double tip_tolerance_mm, double axis_tolerance_deg) {
        const py::gil_scoped_release others_run;
        return simulate_file(file, machine,
                             {tools, transition, dialect, units, feed_mm_per_min,
                              unknown_tool_length_mm, tip_tolerance_mm, axis_tolerance_deg});
      },
      py::arg("file"), py::arg("machine"), py::kw_only(), py::arg("tools") = "",
      py::arg("transition") = "", py::arg("dialect") = "", py::arg("units") = "",
      py::arg("feed_mm_per_min") = py::none(), py::arg("unknown_tool_length_mm") = py::none(),
      py::arg("tip_tolerance_mm") = 0.0, py::arg("axis_tolerance_deg") = 0.0,
      "Runs a part program as `meridian simulate` does, bit for bit.\n\nEmpty words and zeros "
      "leave it to machine and file. ValueError: the file cannot be run, with every finding.");
}

}  // namespace

PYBIND11_MODULE(meridian, module) {
  module.doc() = "Meridian, the live five-axis interpolator: kinematics and simulated runs.";
  py::register_exception_translator([](std::exception_ptr error) {
    try {
      if (error) std::rethrow_exception(error);
    } catch (const config::ConfigError& wrong) {
      PyErr_SetString(PyExc_ValueError, wrong.what());
    }
  });
  add_machine(module);
  add_simulation(module);
}

}  // namespace meridian::python
