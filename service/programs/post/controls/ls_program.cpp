// SPDX-License-Identifier: Apache-2.0
// FANUC robots' LS: J moves with their time, positions as joints of group 1.
#include <algorithm>
#include <cmath>

#include "service/programs/post/controls/nc_text.hpp"
#include "service/programs/post/controls/robot_program.hpp"

namespace meridian::post {
namespace {

constexpr int kMaxPositions = 32767;  // of a program
constexpr double kMaxMs = 32000;      // of a move

class LsProgram final : public RobotProgram {
 public:
  using RobotProgram::RobotProgram;

  void dwell(double seconds) override {
    statement("WAIT " + fixed(std::ceil(seconds * 100 - 1e-6) / 100, 2) + "(sec)");
  }

  void end() override {
    line({"/POS"});
    line({positions_.substr(0, positions_.empty() ? 0 : positions_.size() - 1)});
    line({"/END"});
  }

 protected:
  void open(const std::vector<std::string>& notes) override {
    line({"/PROG  ", name()});
    line({"/ATTR"});
    line({"COMMENT = \"MERIDIAN\";"});
    line({"DEFAULT_GROUP = 1,*,*,*,*;"});
    line({"/MN"});
    for (const std::string& note : notes) remark(note);
    remark(options().is_forearm_coupled ? "J3 COUNTS FROM THE HORIZONTAL"
                                        : "J3 COUNTS FROM THE UPPER ARM");
    statement("UFRAME_NUM=0");
    statement("UTOOL_NUM=1");
  }

  void halt(const std::string& why) override {
    remark(why);
    statement("PAUSE");
  }

  void move(const RobotMove& to) override {
    if (++count_ > kMaxPositions) {
      refuse("a program of more than " + std::to_string(kMaxPositions) +
             " positions; split the CL file ahead of this line");
    }
    const std::string number = std::to_string(count_);
    const double ms = std::max(1.0, std::ceil(to.seconds * 1000 - 1e-6));
    if (ms > kMaxMs) refuse("a move of more than 32 s");
    const std::string speed = to.is_first ? "5%" : fixed(ms, 0) + "msec";
    statement("J P[" + number + "] " + speed + " FINE");
    positions_ += "P[" + number + "]{\n   GP1:\n\tUF : 0, UT : 1,\n\t";
    for (int k = 0; k < axes().count(); ++k) {
      if (k > 0) positions_ += k == 3 ? ",\n\t" : ", ";
      positions_ += "J" + std::to_string(k + 1) + " = ";
      positions_ += fixed(to.deg[k], kRotaryDecimals) + " deg";
    }
    positions_ += "\n};\n";
  }

 private:
  void statement(const std::string& text) { block({std::to_string(++line_), ": ", text, " ;"}); }
  /// A remark has 32 characters.
  void remark(const std::string& text) {
    for (std::size_t k = 0; k < text.size(); k += 32) statement("!" + text.substr(k, 32));
  }

  std::string positions_;
  int line_ = 0, count_ = 0;
};

}  // namespace

std::unique_ptr<Program> make_ls_program(const ProgramParts& parts) {
  return std::make_unique<LsProgram>(parts);
}

}  // namespace meridian::post
