// SPDX-License-Identifier: Apache-2.0
#include "service/machine/file/sections/mesh_file.hpp"

#include <gtest/gtest.h>

#include <string>

#include "service/machine/file/config_error.hpp"
#include "service/machine/file/machine_file.hpp"
#include "support/text_file.hpp"

namespace meridian::config {
namespace {

std::vector<Mesh> meshes_of(const std::string& rows) {
  const std::string text =
      test::read_text(MERIDIAN_SOURCE_DIR "/deploy/machines/lai.toml") + "\n" + rows;
  return parse_meshes(text, "lai.toml", parse_machine(text, "lai.toml"));
}

std::string refusal_of_meshes(const std::string& rows) {
  try {
    (void)meshes_of(rows);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(MeshFile, NamesWhatEachBodyMovesWith) {
  EXPECT_TRUE(meshes_of("").empty());
  const auto meshes = meshes_of(
      "[[mesh]]\nlink = \"base\"\nfile = \"bed.stl\"\n"
      "[[mesh]]\nlink = \"theta2\"\nfile = \"head_2.stl\"\n"
      "[[mesh]]\nlink = \"part\"\nfile = \"blank.stl\"\n");
  ASSERT_EQ(meshes.size(), 3U);
  EXPECT_EQ(meshes[1].link, "theta2");
  EXPECT_EQ(meshes[1].file, "head_2.stl");
}

TEST(MeshFile, RefusesOtherLinksAndNamesThatLeadElsewhere) {
  const auto row = [](const std::string& link, const std::string& file) {
    return "[[mesh]]\nlink = \"" + link + "\"\nfile = \"" + file + "\"\n";
  };
  EXPECT_NE(refusal_of_meshes(row("door", "a.stl")).find("the name of a joint"), std::string::npos);
  for (const char* file : {"../a.stl", "/etc/a.stl", ".stl", "..stl", "a.obj", "a b.stl"}) {
    EXPECT_NE(refusal_of_meshes(row("base", file)).find("without a folder"), std::string::npos)
        << file;
  }
  EXPECT_NE(refusal_of_meshes("[[mesh]]\nlink = \"base\"\n").find("file"), std::string::npos);
  EXPECT_NE(
      refusal_of_meshes("[[mesh]]\nlink = \"base\"\nfile = \"a.stl\"\nscale = 2\n").find("scale"),
      std::string::npos);
}

TEST(MeshFile, TakesNoMoreThanAPictureCanShow) {
  std::string rows;
  for (std::size_t i = 0; i <= kMaxMeshes; ++i) {
    rows += "[[mesh]]\nlink = \"base\"\nfile = \"a.stl\"\n";
  }
  EXPECT_NE(refusal_of_meshes(rows).find("at most 32"), std::string::npos);
}

}  // namespace
}  // namespace meridian::config
