// SPDX-License-Identifier: Apache-2.0
// LinuxCNC's interpreter takes the joint programs, and moves to what their words say. It is asked
// where `rs274` (Debian's linuxcnc-uspace) is installed, and skipped by name where it is not.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "support/nc_program.hpp"
#include "unit/post/written.hpp"

namespace meridian {
namespace {

namespace fs = std::filesystem;

const std::string kSmallPart =
    "UNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/6000,RPM,CLW\nFEDRAT/1200,MMPM\nGOTO/60,0,0,0,0,1\n"
    "GOTO/60,30,5,0.1,0.05,0.9937303457\nDELAY/0.5\nRAPID\n"
    "GOTO/60,30,40,0.1,0.05,0.9937303457\nFINI\n";

/// The arguments of every canonical motion that the interpreter gives, X Y Z A B C.
std::vector<std::array<double, 6>> motions(const fs::path& file) {
  std::vector<std::array<double, 6>> out;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (line.find("STRAIGHT_") == std::string::npos) continue;
    std::string numbers = line.substr(line.find('(') + 1);
    for (char& c : numbers) {
      if (c == ',' || c == ')') c = ' ';
    }
    std::istringstream words(numbers);
    std::array<double, 6> at{};
    for (double& value : at) words >> value;
    out.push_back(at);
  }
  return out;
}

class LinuxCnc : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (std::system("command -v rs274 >/dev/null 2>&1") != 0) {
      GTEST_SKIP() << "rs274 (linuxcnc-uspace) is not installed";
    }
    folder_ = fs::temp_directory_path() / ("meridian-rs274-" + std::to_string(getpid()));
    fs::create_directories(folder_);
    std::ofstream(folder_ / "tools.tbl") << "T1 P1 Z100 D10\n";
    std::ofstream(folder_ / "machine.var") << "5220\t1\n";
    std::ofstream(folder_ / "machine.ini")
        << "[EMC]\nVERSION = 1.1\n[RS274NGC]\nPARAMETER_FILE = machine.var\n[TRAJ]\n"
           "COORDINATES = X Y Z A B C\nLINEAR_UNITS = mm\nANGULAR_UNITS = degree\n"
           "[EMCIO]\nTOOL_TABLE = tools.tbl\n";
  }
  void TearDown() override {
    if (!folder_.empty()) fs::remove_all(folder_);
  }

  /// Exit code of the interpreter over `program`; its canonical calls are in calls(). One at a time
  /// on a host: all of them map the same file of tools (/tmp/.tool.mmap).
  [[nodiscard]] int interpret(const std::string& program) const {
    std::ofstream(folder_ / "program.nc") << program;
    const std::string command =
        "cd '" + folder_.string() +
        "' && flock ../meridian-rs274.lock rs274 -i machine.ini -t tools.tbl -v machine.var -g "
        "program.nc calls.txt </dev/null >log.txt 2>&1";
    return std::system(command.c_str());
  }
  [[nodiscard]] fs::path calls() const { return folder_ / "calls.txt"; }

 private:
  fs::path folder_;
};

TEST_P(LinuxCnc, TakesTheProgramAndMovesWhereItsWordsSay) {
  const auto program = test::written(kSmallPart, test::shipped(GetParam()));
  ASSERT_TRUE(program) << program.error().message;
  ASSERT_EQ(interpret(program->text), 0) << program->text;
  const auto moves = test::read_nc(program->text).moves;
  const auto got = motions(calls());
  ASSERT_EQ(got.size(), moves.size());
  ASSERT_GT(got.size(), 5U);
  for (std::size_t n = 0; n < got.size(); ++n) {
    for (const auto& [address, value] : moves[n].at) {
      const std::size_t axis = std::string("XYZABC").find(address);
      ASSERT_NE(axis, std::string::npos);
      EXPECT_NEAR(got[n][axis], value, 6e-5) << address << " of motion " << n;
    }
  }
}

TEST_P(LinuxCnc, RefusesAProgramWithAWordTwice) {
  const auto program = test::written(kSmallPart, test::shipped(GetParam()));
  ASSERT_TRUE(program);
  std::string text = program->text;
  text.insert(text.find("G0 X") + 3, "X0 ");
  EXPECT_NE(interpret(text), 0);
}

INSTANTIATE_TEST_SUITE_P(Shipped, LinuxCnc,
                         testing::Values("trunnion-ac", "trunnion-bc", "lai", "head-table-bc",
                                         "fork-ca"),
                         [](const auto& machine) {
                           std::string name = machine.param;
                           for (char& c : name) {
                             if (c == '-') c = '_';
                           }
                           return name;
                         });

}  // namespace
}  // namespace meridian
