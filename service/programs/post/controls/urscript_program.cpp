// SPDX-License-Identifier: Apache-2.0
// Universal Robots: movej in radians, each move with its time.
#include <cmath>

#include "meridian/units.hpp"
#include "service/programs/post/controls/nc_text.hpp"
#include "service/programs/post/controls/robot_program.hpp"

namespace meridian::post {
namespace {

constexpr int kRadianDecimals = 7;  // finer than 1e-5 degree

class UrScriptProgram final : public RobotProgram {
 public:
  using RobotProgram::RobotProgram;

  void dwell(double seconds) override { block({"  sleep(", fixed(seconds, 3), ")"}); }
  void end() override {
    line({"end"});
    line({name(), "()"});
  }

 protected:
  void open(const std::vector<std::string>& notes) override {
    line({"def ", name(), "():"});
    for (const std::string& note : notes) line({"  # ", note});
  }

  void halt(const std::string& why) override {
    block({"  popup(\"", why, "\", title=\"", name(), "\", warning=True, blocking=True)"});
  }

  void move(const RobotMove& to) override {
    std::string joints = "[";
    for (int k = 0; k < kRobotAxes; ++k) {
      if (k > 0) joints += ", ";
      joints += fixed(units::rad_from_deg(to.deg[k]), kRadianDecimals);
    }
    const std::string time = fixed(std::ceil(to.seconds * 1e4 - 1e-6) * 1e-4, 4);
    block({"  movej(", joints, "], ", to.is_first ? "a=0.2, v=0.1" : "t=" + time, ")"});
  }
};

}  // namespace

std::unique_ptr<Program> make_urscript_program(const ProgramParts& parts) {
  return std::make_unique<UrScriptProgram>(parts);
}

}  // namespace meridian::post
