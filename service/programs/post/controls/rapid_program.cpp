// SPDX-License-Identifier: Apache-2.0
// ABB RAPID: MoveAbsJ, each move with its time.
#include <cmath>

#include "service/programs/post/controls/nc_text.hpp"
#include "service/programs/post/controls/robot_program.hpp"

namespace meridian::post {
namespace {

class RapidProgram final : public RobotProgram {
 public:
  using RobotProgram::RobotProgram;

  void dwell(double seconds) override { block({"WaitTime ", fixed(seconds, 3), ";"}); }
  void end() override {
    line({"ENDPROC"});
    line({"ENDMODULE"});
  }

 protected:
  void open(const std::vector<std::string>& notes) override {
    line({"MODULE ", name()});
    for (const std::string& note : notes) line({"! ", note});
    line({"PROC main()"});
  }

  void halt(const std::string& why) override {
    line({"! ", why});
    block({"Stop;"});
  }

  void move(const RobotMove& to) override {
    std::string joints = "[[";
    for (int k = 0; k < kRobotAxes; ++k) {
      if (k > 0) joints += ",";
      joints += fixed(k < axes().count() ? to.deg[k] : 0, kRotaryDecimals);
    }
    joints += "],[9E9,9E9,9E9,9E9,9E9,9E9]]";
    // The time stands in place of the speed, which has to be there all the same.
    const std::string speed =
        to.is_first ? "v50" : "v50\\T:=" + fixed(std::ceil(to.seconds * 1e4 - 1e-6) * 1e-4, 4);
    block({"MoveAbsJ ", joints, "\\NoEOffs,", speed, ",fine,tool0;"});
  }
};

}  // namespace

std::unique_ptr<Program> make_rapid_program(const ProgramParts& parts) {
  return std::make_unique<RapidProgram>(parts);
}

}  // namespace meridian::post
