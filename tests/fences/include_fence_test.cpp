// SPDX-License-Identifier: Apache-2.0
#include "fences/include_fence.hpp"

#include <gtest/gtest.h>

namespace meridian::fences {
namespace {

const std::vector<std::string> kSources{".hpp", ".cpp", ".h", ".c"};

std::vector<Finding> findings_of(const std::string& path, const std::string& text) {
  const AllowedIncludes allowed =
      read_allowed_includes({"rules",
                             {"base: std", "geometry: std eigen base  # ground",
                              "service/programs/cl: std std.io geometry"}});
  return find_forbidden_includes({{path, split_lines(text)}}, allowed);
}

TEST(IncludeFence, HoldsForTheProject) {
  const AllowedIncludes allowed =
      read_allowed_includes(read_file(MERIDIAN_SOURCE_DIR, "tests/fences/allowed_includes.txt"));
  std::size_t files = 0;
  for (const char* const folder : {"include", "service"}) {
    const auto sources = read_tree(MERIDIAN_SOURCE_DIR, folder, kSources);
    files += sources.size();
    EXPECT_EQ(to_text(find_forbidden_includes(sources, allowed)), "");
  }
  EXPECT_GT(files, 10U) << "the fence saw hardly any file";
}

TEST(IncludeFence, LetsAllowedArrowsPass) {
  EXPECT_EQ(to_text(findings_of("include/meridian/geometry/a.hpp",
                                "#include <Eigen/Core>\n#include <cmath>\n"
                                "#include \"meridian/units.hpp\"\n"
                                "#include \"meridian/geometry/b.hpp\"\n")),
            "");
}

TEST(IncludeFence, AnAllowedHeaderStandsForItselfAlone) {
  const AllowedIncludes allowed{{"path", {"meridian/kinematics/joints.hpp"}}};
  const auto findings = find_forbidden_includes({{"include/meridian/path/a.hpp",
                                                  {"#include \"meridian/kinematics/joints.hpp\"",
                                                   "#include \"meridian/kinematics/lai.hpp\""}}},
                                                allowed);
  EXPECT_EQ(to_text(findings), "include/meridian/path/a.hpp:2: path may not include kinematics\n");
}

TEST(IncludeFence, CatchesAnArrowUpwards) {
  EXPECT_EQ(to_text(findings_of("include/meridian/geometry/a.hpp",
                                "#pragma once\n#include \"meridian/planner/plan.hpp\"\n")),
            "include/meridian/geometry/a.hpp:2: geometry may not include planner\n");
}

TEST(IncludeFence, CatchesTheWorldInTheCore) {
  for (const char* const include :
       {"<dds/dds.h>", "<spdlog/spdlog.h>", "<toml++/toml.h>", "<thread>", "<fstream>",
        "<unistd.h>", "<idl/drives.h>", "\"generated.hpp\"", "\"service/transport/writer.hpp\"",
        "\"../units.hpp\""}) {
    EXPECT_EQ(
        findings_of("service/core/geometry/a.cpp", std::string("  #  include ") + include).size(),
        1U)
        << include;
  }
}

TEST(IncludeFence, CatchesAServiceRoomThatMeetsAnother) {
  EXPECT_EQ(
      to_text(findings_of("service/programs/cl/reader.cpp",
                          "#include \"service/transport/writer.hpp\"")),
      "service/programs/cl/reader.cpp:1: service/programs/cl may not include service/transport\n");
}

TEST(IncludeFence, CatchesARoomWithoutARow) {
  EXPECT_EQ(findings_of("service/elsewhere/a.cpp", "").size(), 1U);
}

}  // namespace
}  // namespace meridian::fences
