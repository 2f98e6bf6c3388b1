// SPDX-License-Identifier: Apache-2.0
#include "service/host/soak/report/report_files.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "service/host/process/programs.hpp"

namespace meridian::soak {
namespace {

TEST(ReportFiles, LieBesideTheReport) {
  EXPECT_EQ(text_beside("a/soak.json"), "a/soak.txt");
  EXPECT_EQ(kept_beside("a/soak.json"), "a/soak.kept");
  EXPECT_EQ(text_beside("soak"), "soak.txt");
  EXPECT_EQ(text_beside(""), "") << "no report, no text";
  EXPECT_EQ(refusal_to_report("a/soak.json", {"part.cl"}), "");
  EXPECT_EQ(refusal_to_report("", {"part.cl"}), "");
}

TEST(ReportFiles, AreNotCalledAsTheReportItself) {
  EXPECT_EQ(refusal_to_report("a/soak.txt", {}),
            "a/soak.txt: is the name of the text beside the report, which is JSON; take "
            "a/soak.json");
  EXPECT_NE(refusal_to_report("soak.kept", {}).find("soak.kept: is the name of the folder"),
            std::string::npos);
}

TEST(ReportFiles, LieOverNothingThatTheSoakReads) {
  const process::ScratchFolder folder;
  const auto program = folder.path() / "part.txt";
  std::ofstream(program) << "FINI";
  EXPECT_EQ(refusal_to_report(folder.path() / "part.json", {"", program.string()}),
            program.string() + ": is read by this run; name another file to write");
}

}  // namespace
}  // namespace meridian::soak
