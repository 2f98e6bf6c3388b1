// SPDX-License-Identifier: Apache-2.0
// KUKA KRL: PTP to axis positions, speed in whole percent of the axes' own.
#include <algorithm>
#include <cmath>

#include "service/programs/post/controls/nc_text.hpp"
#include "service/programs/post/controls/robot_program.hpp"

namespace meridian::post {
namespace {

constexpr int kFirstPercent = 10;  // from wherever the arm stands

class KrlProgram final : public RobotProgram {
 public:
  using RobotProgram::RobotProgram;

  void dwell(double seconds) override { block({"WAIT SEC ", fixed(seconds, 3)}); }
  void end() override { line({"END"}); }

 protected:
  void open(const std::vector<std::string>& notes) override {
    line({"&ACCESS RVP"});
    line({"&REL 1"});
    line({"DEF ", name(), "()"});
    for (const std::string& note : notes) line({"; ", note});
    line({"; 100 PERCENT IS THE VELOCITY OF EACH JOINT IN THE MACHINE FILE"});
    block({"BAS (#INITMOV,0)"});
  }

  void halt(const std::string& why) override {
    line({"; ", why});
    block({"HALT"});
  }

  void move(const RobotMove& to) override {
    int percent = kFirstPercent;
    if (!to.is_first) {
      const double share = to.full_speed_s / to.seconds;
      percent = std::min(100, static_cast<int>(std::floor(100 * share * (1 + 1e-9))));
    }
    if (percent < 1) {
      refuse(
          "KRL has no axis speed below 1 percent, and this move asks for less: it would be "
          "faster than its feed; raise the feed, or lower the rated axis speeds of controller "
          "and machine file alike");
      percent = 1;
    }
    if (percent != percent_) {
      percent_ = percent;
      for (int k = 1; k <= axes().count(); ++k) {
        block({"$VEL_AXIS[", std::to_string(k), "]=", std::to_string(percent)});
      }
    }
    block({"PTP {E6AXIS: ", numbered(to, "A"), "}"});
  }

 private:
  int percent_ = 0;
};

}  // namespace

std::unique_ptr<Program> make_krl_program(const ProgramParts& parts) {
  return std::make_unique<KrlProgram>(parts);
}

}  // namespace meridian::post
