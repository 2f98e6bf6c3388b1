// SPDX-License-Identifier: Apache-2.0
// The NC program of a random CL program, read back: the CL points are found again, in order, and
// between them the machine that it describes keeps to the path and the feed.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <sstream>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/units.hpp"
#include "property/planner/random_programs.hpp"
#include "service/machine/file/machine_file.hpp"
#include "service/programs/cl/cl_reader.hpp"
#include "service/programs/cl/cl_writer.hpp"
#include "service/programs/post/axis_words.hpp"
#include "service/programs/post/post.hpp"
#include "support/cl_path.hpp"
#include "support/nc_program.hpp"
#include "support/shipped_machines.hpp"

namespace meridian {
namespace {

constexpr unsigned kSeed = 20261121;
constexpr int kPrograms = 12;
constexpr int kLength = 10;
constexpr int kSamples = 8;              // of every NC block, ends included
constexpr double kPointTip_mm = 3e-3;    // words have 1e-4 mm and 1e-5 deg; 1.5 m of arm
constexpr double kPointAxis_rad = 2e-5;  // relaxing onto the pole and a rounded angle
constexpr double kRounding = 1e-6;       // of a tolerance

/// Where the part lies so that the machine reaches it.
MachineModel machine_of(const std::string& name) {
  MachineModel model = config::load_machine(test::shipped_file(name));
  if (model.family == MachineFamily::kRobot) {
    config::place_workpiece(model, config::parse_frame("850,0,250"));
  }
  return model;
}

std::string text_of(const std::vector<ClBlock>& blocks) {
  std::ostringstream out;
  cl::ClWriter writer(out, "TRIAL");
  for (const ClBlock& block : blocks) writer.write(block);
  ClBlock end;
  end.kind = BlockKind::kEnd;
  writer.write(end);
  return out.str();
}

std::vector<ClBlock> blocks_of(const std::string& text) {
  std::vector<ClBlock> blocks;
  cl::ClReader reader(text, "trial.apt");
  for (auto block = reader.next(); block && *block; block = reader.next())
    blocks.push_back(**block);
  return blocks;
}

/// A program that is read back: drives of every block by its words, joints by its drives.
struct ReadBack {
  const MachineModel& model;
  post::AxisWords words;
  test::NcProgramRead nc;
  post::PostOptions options;

  [[nodiscard]] JointVector drives(const test::NcMove& move) const {
    JointVector u{};
    for (int i = 0; i < model.joint_count; ++i) {
      const auto at = move.at.find(words.address(i));
      if (at != move.at.end()) u[i] = words.axis(i, at->second);
    }
    return u;
  }
  [[nodiscard]] ToolPose pose(const JointVector& u) const {
    return forward(model, model.tool_length_mm, joints_of(model, u));
  }

  /// Where the block ends, as its dialect says it.
  [[nodiscard]] ToolPose end_of(const test::NcMove& move) const {
    if (options.dialect == post::Dialect::kJoints) return pose(drives(move));
    const auto vector = [&move](const char* x, const char* y, const char* z) {
      const auto word = [&move](const char* address) {
        const auto at = move.at.find(address);
        return at == move.at.end() ? 0.0 : at->second;
      };
      return Vector3(word(x), word(y), word(z));
    };
    const Eigen::Matrix3d from_machine = model.X_MW.rotation.transpose();
    const Vector3 tip = from_machine * vector("X", "Y", "Z");
    switch (options.dialect) {
      case post::Dialect::kFanuc:
        if (!options.has_vectors) return {tip, pose(drives(move)).axis};
        return {tip, from_machine * vector("I", "J", "K")};
      case post::Dialect::kSiemens:
        return {tip, from_machine * vector("A3", "B3", "C3")};
      default:
        return {tip, from_machine * vector("TX", "TY", "TZ")};
    }
  }

  /// Between two blocks, as the controller moves.
  [[nodiscard]] ToolPose between(const test::NcMove& from, const test::NcMove& to, double u) const {
    const JointVector at = test::between(drives(from), drives(to), u);
    if (options.dialect == post::Dialect::kJoints) return pose(at);
    const ToolPose begin = end_of(from), end = end_of(to);
    const Vector3 tip = begin.tip + u * (end.tip - begin.tip);
    if (options.dialect == post::Dialect::kFanuc && !options.has_vectors)
      return {tip, pose(at).axis};
    return {tip, cl::turn_towards(begin.axis.normalized(), end.axis.normalized(), u)};
  }
};

bool is_at(const ToolPose& a, const ToolPose& b) {
  return (a.tip - b.tip).norm() < kPointTip_mm && test::angle_of(a.axis, b.axis) < kPointAxis_rad;
}

/// Least time in which the drives go evenly from `a` to `b` with no joint and no drive too fast.
double min_time(const MachineModel& model, const JointVector& a, const JointVector& b) {
  constexpr int kParts = 16;
  double longest = 0;
  LimitedVector last = limited_of(model, joints_of(model, a));
  for (int n = 1; n <= kParts; ++n) {
    const double share = static_cast<double>(n) / kParts;
    const LimitedVector at = limited_of(model, joints_of(model, test::between(a, b, share)));
    for (int i = 0; i < limited_count(model); ++i) {
      const double rate = kParts * std::abs(at[i] - last[i]);
      longest = std::max(longest, rate / limited_spec(model, i).limits.velocity);
    }
    last = at;
  }
  return longest;
}

struct Counts {
  int programs = 0, refused = 0, nc_blocks = 0, turns = 0, at_feed = 0;
  double worst = 0;
};

class PostRoundTrip : public testing::TestWithParam<std::string> {
 protected:
  MachineModel model = machine_of(GetParam());
  Counts counts;

  void check_feed(const ReadBack& read, const test::NcMove& move, const test::NcMove& before,
                  const test::ClPath& path) {
    if (move.is_rapid) return;
    const double max = model.max_feed_mm_per_s;
    const double feed = path.block.feed_meaning == FeedMeaning::kTip
                            ? std::min(path.block.feed, max)
                            : std::min(path.length() * path.block.feed, max);
    const double length = (read.end_of(move).tip - read.end_of(before).tip).norm();
    constexpr double kDigits_mm = 5e-3;  // rounded words at both ends
    if (read.options.dialect != post::Dialect::kJoints) {
      ASSERT_TRUE(move.is_tool_centre && !move.is_inverse) << "NC line " << move.line;
      if (length < 0.1) return;
      EXPECT_NEAR(move.feed / 60, feed, 1e-3 * feed + 1e-3) << "NC line " << move.line;
      ++counts.at_feed;
      return;
    }
    ASSERT_TRUE(move.is_inverse && move.has_feed) << "NC line " << move.line;
    const double seconds = 60 / move.feed;
    const double by_joints = min_time(model, read.drives(before), read.drives(move));
    EXPECT_GE(seconds, by_joints * (1 - 1e-6)) << "a joint is too fast, NC line " << move.line;
    EXPECT_LE(length, feed * seconds * (1 + 1e-9) + kDigits_mm) << "NC line " << move.line;
    if (path.block.is_arc || path.block.feed_meaning != FeedMeaning::kTip) return;
    if (seconds > 1.01 * by_joints + 1e-3 && length > 0.1) {
      EXPECT_NEAR(length / seconds, feed, feed * (6e-4 + 2 * kDigits_mm / length))
          << "NC line " << move.line;
      ++counts.at_feed;
    }
  }

  /// Largest deviation from `way` of the motion between two blocks, in tolerances.
  static double worst_between(const ReadBack& read, const test::NcMove& from,
                              const test::NcMove& to, const test::ClPath& path,
                              const post::PostOptions& options) {
    double worst = 0;
    for (int k = 0; k <= kSamples; ++k) {
      const ToolPose pose = read.between(from, to, static_cast<double>(k) / kSamples);
      worst = std::max(worst, test::deviation(path, pose, *options.chord_mm, *options.axis_rad));
    }
    return worst;
  }

  void check(const std::string& cl_text, const std::string& nc_text,
             const post::PostOptions& options) {
    const ReadBack read{model, *post::AxisWords::of(model), test::read_nc(nc_text), options};
    const std::vector<ClBlock> blocks = blocks_of(cl_text);
    const auto paths = test::paths_of(blocks);
    ASSERT_GT(paths.size(), 0U);
    const ToolPose first{to_vector(blocks[0].tip_mm), to_vector(blocks[0].axis).normalized()};
    const auto& moves = read.nc.moves;
    const bool has_joints = options.dialect == post::Dialect::kJoints;
    std::size_t n = 0;
    while (n < moves.size() &&
           !((has_joints || moves[n].is_tool_centre) && is_at(read.end_of(moves[n]), first))) {
      ++n;
    }
    ASSERT_LT(n, moves.size()) << "the first point is not in the program";
    std::size_t at = 0;  // way in force
    std::size_t before = n;
    for (++n; n < moves.size(); ++n) {
      while (at < paths.size() && paths[at].block.line != moves[n].cl_line) {
        ASSERT_TRUE(is_at(read.end_of(moves[before]), paths[at].end))
            << "no block ends on CL line " << paths[at].block.line;
        ++at;
      }
      ASSERT_LT(at, paths.size()) << "no such CL line, NC line " << moves[n].line;
      const double worst = worst_between(read, moves[before], moves[n], paths[at], options);
      ASSERT_LE(worst, 1 + kRounding)
          << "NC line " << moves[n].line << ", CL line " << paths[at].block.line;
      counts.worst = std::max(counts.worst, worst);
      check_feed(read, moves[n], moves[before], paths[at]);
      if (is_at(read.end_of(moves[before]), read.end_of(moves[n]))) ++counts.turns;
      before = n;
    }
    while (at < paths.size() && is_at(read.end_of(moves[before]), paths[at].end)) ++at;
    ASSERT_EQ(at, paths.size()) << "CL points are missing";
    counts.nc_blocks += static_cast<int>(moves.size());
  }

  /// Random programs in `dialect`, written and read back.
  void run(post::PostOptions options, int programs) {
    test::RandomPrograms draw(kSeed);
    options.has_line_words = true;
    options.offset_number = 1;
    for (int n = 0; n < programs; ++n) {
      SCOPED_TRACE(n);
      const std::string text = text_of(draw.program(model, kLength));
      options.chord_mm = draw.log_uniform(0.004, 0.05);
      options.axis_rad = units::rad_from_deg(draw.log_uniform(0.02, 0.5));
      cl::ClReader reader(text, "trial.apt");
      const auto program = post::write_nc(reader, "trial.apt", model, {}, options);
      if (!program) {
        EXPECT_GT(program.error().line, 0U) << program.error().message;
        ++counts.refused;
        continue;
      }
      ++counts.programs;
      check(text, program->text, options);
      if (HasFatalFailure()) {
        std::printf("%s\n%s\n", text.c_str(), program->text.c_str());
        return;
      }
    }
    std::printf("%s: %d programs, %d refused, %d NC blocks, %d at rest, %d at feed, worst %.3f\n",
                GetParam().c_str(), counts.programs, counts.refused, counts.nc_blocks, counts.turns,
                counts.at_feed, counts.worst);
    EXPECT_GT(counts.programs, programs / 3);
    EXPECT_GT(counts.at_feed, 2);
  }
};

TEST_P(PostRoundTrip, JointWordsGiveTheClPathBackWithinTheTolerancesAndAtTheFeed) {
  run({}, kPrograms);
}

TEST_P(PostRoundTrip, ToolCentreWordsGiveTheClPathBackInEveryDialect) {
  // Robots have no X Y Z, and no control knows a stage: refused, see tests/unit/post.
  if (model.family == MachineFamily::kRobot || has_stage(model)) return;
  post::PostOptions options;
  options.dialect = post::Dialect::kFanuc;
  run(options, kPrograms / 2);
  for (const auto dialect :
       {post::Dialect::kFanuc, post::Dialect::kSiemens, post::Dialect::kHeidenhain}) {
    counts = {};
    options.dialect = dialect;
    options.has_vectors = dialect == post::Dialect::kFanuc;
    run(options, kPrograms / 2);
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, PostRoundTrip, testing::ValuesIn(test::shipped_machines()),
                         test::test_name);

}  // namespace
}  // namespace meridian
