// SPDX-License-Identifier: Apache-2.0
#include "service/panel/program/program_preview.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "service/analysis/simulate/held_by.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/panel/program/program_path.hpp"
#include "service/text/whole_file.hpp"

namespace meridian::panel {
namespace {

[[nodiscard]] stream::PreflightMachine machine() {
  stream::PreflightMachine out;
  out.model = config::load_machine(MERIDIAN_SOURCE_DIR "/deploy/machines/trunnion-ac.toml");
  out.tools = config::load_tools(MERIDIAN_SOURCE_DIR "/deploy/tools.toml");
  return out;
}

/// A program in a file that goes with the test.
class Part {
 public:
  explicit Part(const std::string& points)
      : file_(std::filesystem::temp_directory_path() /
              ("meridian-preview-" + std::to_string(::getpid()) + ".apt")) {
    EXPECT_TRUE(text::write_whole(file_.string(),
                                  "UNITS/MM\nMULTAX/ON\nFEDRAT/1200,MMPM\n" + points + "FINI\n"));
  }
  ~Part() { std::filesystem::remove(file_); }
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;
  [[nodiscard]] std::string file() const { return file_.string(); }

 private:
  std::filesystem::path file_;
};

[[nodiscard]] std::vector<ProgramPath::Point> points_in(const std::string& bytes) {
  std::vector<ProgramPath::Point> points(bytes.size() / sizeof(ProgramPath::Point));
  std::memcpy(points.data(), bytes.data(), points.size() * sizeof(ProgramPath::Point));
  return points;
}

constexpr auto kNeverOvertaken = [] { return false; };

TEST(ProgramPreview, ThePathOfACutRunsAtItsFeedThroughItsPoints) {
  const Part part("GOTO/0,0,50,0,0,1\nGOTO/40,0,50,0,0,1\nGOTO/40,30,50,0,0,1\n");
  const auto here = machine();
  const auto run = simulate_program(part.file(), reader_for(here, 0), here, kNeverOvertaken);
  ASSERT_TRUE(run);
  EXPECT_TRUE(run->has_run) << run->reason;
  EXPECT_GT(run->program_s, 70 / 20.0);
  const auto points = points_in(run->path);
  ASSERT_GT(points.size(), 1000U);
  EXPECT_NEAR(static_cast<double>(points.back().time_s), run->program_s, 0.05);
  EXPECT_NEAR(points.back().tip_mm[0], 40, 1e-3);
  EXPECT_NEAR(points.back().tip_mm[1], 30, 1e-3);
  float fastest = 0;
  for (const auto& point : points) fastest = std::max(fastest, point.feed_mm_per_min);
  EXPECT_NEAR(static_cast<double>(fastest), 1200, 3);
  EXPECT_EQ(run->limits[1], "feed");
}

TEST(ProgramPreview, APointKnowsItsBlockItsFeedItsJointsAndWhatHeldIt) {
  const Part part("GOTO/0,0,50,0,0,1\nGOTO/40,0,50,0,0,1\nGOTO/40,30,50,0,0,1\n");
  const auto here = machine();
  const auto run = simulate_program(part.file(), reader_for(here, 0), here, kNeverOvertaken);
  ASSERT_TRUE(run);
  const auto points = points_in(run->path);
  ASSERT_GT(points.size(), 1000U);
  for (const auto& point : points) {
    EXPECT_NE(point.cause, ProgramPath::kUndecided);
    JointVector joints{};
    for (std::size_t i = 0; i < joints.size(); ++i)
      joints[i] = static_cast<double>(point.joints[i]);
    const Vector3 tip = forward(here.model, here.model.tool_length_mm, joints).tip;
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(tip[k], static_cast<double>(point.tip_mm[static_cast<std::size_t>(k)]), 1e-2);
    }
  }
  const auto& middle = points[points.size() / 2];
  EXPECT_FLOAT_EQ(middle.programmed_mm_per_min, 1200);
  EXPECT_GT(points.back().block, points.front().block);
  // It sets off from a rest and comes to one; at its feed nothing is lost.
  const auto cause = [](simulate::Cause one) { return static_cast<std::uint32_t>(one); };
  EXPECT_EQ(points[points.size() - 5].cause, cause(simulate::Cause::kRest));
  EXPECT_TRUE(std::any_of(points.begin(), points.end(), [&](const auto& point) {
    return point.cause == cause(simulate::Cause::kFeed) && point.limit == simulate::kFeedLimit;
  }));
}

TEST(ProgramPreview, ASimulationThatIsOvertakenEnds) {
  const Part part("GOTO/0,0,50,0,0,1\nGOTO/100,0,50,0,0,1\nGOTO/-100,0,50,0,0,1\n");
  const auto here = machine();
  EXPECT_FALSE(simulate_program(part.file(), reader_for(here, 0), here, [] { return true; }));
}

TEST(ProgramPreview, ARestartBeginsAtItsLine) {
  const Part part("GOTO/0,0,50,0,0,1\nGOTO/40,0,50,0,0,1\nGOTO/40,30,50,0,0,1\n");
  const auto here = machine();
  const auto whole = simulate_program(part.file(), reader_for(here, 0), here, kNeverOvertaken);
  const auto rest = simulate_program(part.file(), reader_for(here, 6), here, kNeverOvertaken);
  ASSERT_TRUE(whole && rest);
  EXPECT_TRUE(rest->has_run) << rest->reason;
  EXPECT_LT(rest->program_s, whole->program_s);
  const auto points = points_in(rest->path);
  ASSERT_FALSE(points.empty());
  EXPECT_NEAR(points.front().tip_mm[0], 40, 0.1);
  EXPECT_TRUE(std::any_of(points.begin(), points.end(), [](const auto& p) { return p.line == 6; }));
}

TEST(ProgramPreview, APartThatLiesOutOfReachFitsElsewhere) {
  const Part part("GOTO/1500,0,50,0,0,1\nGOTO/1540,0,50,0,0,1\n");
  const auto here = machine();
  const auto reader = reader_for(here, 0);
  EXPECT_TRUE(stream::preflight(part.file(), reader, here).is_refused);
  const std::string words = find_where_it_fits(part.file(), reader, here);
  EXPECT_TRUE(words.starts_with("It fits with the workpiece at ")) << words;
}

TEST(ProgramPreview, ALongPathKeepsItsTimeAndGrowsNoFurther) {
  const MachineModel model = machine().model;
  ProgramPath path(model);
  CycleRecord record;
  constexpr int kCycles = 600'000;
  for (int i = 0; i < kCycles; ++i) {
    record.joints[0] = 1e-4 * i;
    path.add(record, {.time_s = 1e-3, .path_mm = 1e-4, .limit = 1, .tool_length_mm = 100});
  }
  EXPECT_LE(path.points().size(), ProgramPath::kMaxPoints);
  EXPECT_GT(path.points().size(), ProgramPath::kMaxPoints / 4);
  EXPECT_NEAR(path.points().back().time_s, 600, 0.1);
  EXPECT_NEAR(path.points()[1000].feed_mm_per_min, 6, 0.01);
}

}  // namespace
}  // namespace meridian::panel
