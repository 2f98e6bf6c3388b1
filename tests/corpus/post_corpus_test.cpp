// SPDX-License-Identifier: Apache-2.0
// Real CL files as NC programs in joint words: every CL point is found again, in order.
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <utility>

#include "corpus/simulated_file.hpp"
#include "meridian/kinematics/kinematics.hpp"
#include "service/programs/post/axis_words.hpp"
#include "service/programs/post/post.hpp"
#include "support/nc_program.hpp"

namespace meridian {
namespace {

constexpr double kPointTip_mm = 2e-4;  // words have 1e-4 mm and 1e-5 deg, at most 0.5 m of arm
constexpr double kPointAxis = 1e-5;    // relaxing onto the pole, rounded angles

class PostCorpus : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(PostCorpus, EveryPointOfARealFileIsFoundAgain) {
  const auto [name, machine] = GetParam();
  const auto file = test::shared_folder() / "cl_corpus" / name;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  MachineModel model = config::load_machine(std::string(MERIDIAN_SOURCE_DIR) + "/deploy/machines/" +
                                            machine + ".toml");
  std::ifstream in(file, std::ios::binary);
  cl::ClReader reader(in, name, test::corpus_reader());
  const auto program = post::write_nc(reader, name, model, test::corpus_tools(model), {});
  ASSERT_TRUE(program) << program.error().line << ": " << program.error().message;
  const auto words = *post::AxisWords::of(model);
  const auto nc = test::read_nc(program->text);

  std::ifstream again(file, std::ios::binary);
  cl::ClReader points(again, name, test::corpus_reader());
  std::size_t at = 0;
  int found = 0;
  for (auto block = points.next(); block && *block; block = points.next()) {
    if (!is_motion((*block)->kind)) continue;
    const auto is_there = [&, &b = **block](const test::NcMove& move) {
      JointVector q{};
      for (int i = 0; i < model.joint_count; ++i) {
        const auto word = move.at.find(words.address(i));
        if (word != move.at.end()) q[i] = words.axis(i, word->second);
      }
      const ToolPose pose = forward(model, model.tool_length_mm, q);
      return (pose.tip - to_vector(b.tip_mm)).norm() < kPointTip_mm &&
             (pose.axis - to_vector(b.axis)).norm() < kPointAxis;
    };
    while (at < nc.moves.size() && !is_there(nc.moves[at])) ++at;
    ASSERT_LT(at, nc.moves.size()) << "CL line " << (*block)->line << " is not in the program";
    ++found;
  }
  std::printf("%s on %s: %d CL points, %zu NC moves\n", name, machine, found, nc.moves.size());
  EXPECT_GT(found, 50);
}

INSTANTIATE_TEST_SUITE_P(
    Shared, PostCorpus,
    testing::Values(std::pair{"nx_simple_block.cls", "lai"},
                    std::pair{"nx_simple_block.cls", "trunnion-ac"},
                    std::pair{"ramsai_1-3_plan_5x_depincage_double.apt", "lai"},
                    std::pair{"ramsai_1-3_plan_5x_depincage_double.apt", "trunnion-ac"}),
    [](const auto& run) {
      std::string name = std::string(run.param.second) + "_" + run.param.first;
      for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
      return name;
    });

}  // namespace
}  // namespace meridian
