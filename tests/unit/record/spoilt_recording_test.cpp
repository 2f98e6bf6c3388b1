// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "check_fixture.hpp"
#include "meridian/geometry/great_circle.hpp"

/// check() on a path that retraces itself, stands still, turns at rest and runs into an arc: right
/// recordings pass, each spoilt one fails. Made without planner and cycle, no limit of a joint
/// helps.
namespace meridian::record {
namespace {

using test::cut_to;
using test::path_of;
using test::Scratch;

constexpr double kFeed_mm_per_s = 15;

/// Poses per cycle, and the block that each is in.
struct Motion {
  std::vector<ToolPose> poses;
  std::vector<std::size_t> block;
};

[[nodiscard]] ToolPose pose_of(const ClBlock& block) {
  return {to_vector(block.tip_mm), to_vector(block.axis).normalized()};
}

[[nodiscard]] ToolPose between(const ToolPose& a, const ToolPose& b, double t) {
  const GreatCircle circle = find_great_circle(a.axis, b.axis);
  return {a.tip + t * (b.tip - a.tip),
          axis_on_circle(circle.begin, circle.normal, t * circle.turn)};
}

/// Rest to rest in every block.
[[nodiscard]] Motion exact(const std::vector<ClBlock>& blocks) {
  Motion out{{pose_of(blocks[0])}, {1}};
  for (std::size_t i = 1; i < blocks.size(); ++i) {
    const ToolPose a = pose_of(blocks[i - 1]), b = pose_of(blocks[i]);
    const double length = (b.tip - a.tip).norm(), turn = angle_between(a.axis, b.axis);
    const double min = std::max({1.9 * length / kFeed_mm_per_s, 1.9 * turn / 0.5, 0.012});
    const int cycles = static_cast<int>(std::ceil(min / 1e-3));
    for (int n = 1; n <= cycles; ++n) {
      const double u = static_cast<double>(n) / cycles;
      out.poses.push_back(between(a, b, u * u * u * (10 - 15 * u + 6 * u * u)));
      out.block.push_back(i);
    }
  }
  return out;
}

/// On through the blocks at one speed, corners rounded by averaging three times over three cycles.
[[nodiscard]] Motion smooth(const std::vector<ClBlock>& blocks) {
  constexpr double kStep_mm = 0.006;
  Motion out{std::vector<ToolPose>(12, pose_of(blocks[0])), std::vector<std::size_t>(12, 1)};
  double carry = 0;
  for (std::size_t i = 1; i < blocks.size(); ++i) {
    const ToolPose a = pose_of(blocks[i - 1]), b = pose_of(blocks[i]);
    const double length = std::max((b.tip - a.tip).norm(), 15 * angle_between(a.axis, b.axis));
    for (; carry < length; carry += kStep_mm) {
      out.poses.push_back(between(a, b, carry / length));
      out.block.push_back(i);
    }
    carry -= length;
  }
  out.poses.resize(out.poses.size() + 12, pose_of(blocks.back()));
  out.block.resize(out.poses.size(), blocks.size() - 1);
  for (int round = 0; round < 3; ++round) {
    const std::vector<ToolPose> from = out.poses;
    for (std::size_t n = 1; n + 1 < from.size(); ++n) {
      out.poses[n].tip = (from[n - 1].tip + from[n].tip + from[n + 1].tip) / 3;
      out.poses[n].axis = (from[n - 1].axis + from[n].axis + from[n + 1].axis).normalized();
    }
  }
  return out;
}

/// The blocks of the path, and where its parts begin.
struct Program {
  std::vector<ClBlock> blocks;
  std::size_t line = 0, corner = 0, retrace = 0, turn = 0, plunge = 0, arc_end = 0, two = 0;

  Program() {
    go({0, 0, 20}, 0.30);
    line = go({8, 0, 20}, 0.30);
    corner = line;
    go({8, 6, 20}, 0.30);
    retrace = go({8, 9, 20}, 0.30);
    go({8, 6, 20}, 0.30);
    go({8, 9, 20}, 0.30);
    for (int n = 0; n < 3; ++n) go({8, 6, 20}, 0.30);
    go({14, 6, 22}, 0.45);
    turn = go({14, 6, 22}, 0.55);
    go({14, 6, 22}, 0.45);
    plunge = go({14, 6, 19}, 0.45);
    go({14, 6, 22}, 0.45);
    for (int n = 1; n <= 30; ++n) go({14 + 0.005 * n, 6 + 0.002 * (n % 3), 22}, 0.45);
    for (int n = 1; n <= 60; ++n) {
      const double angle = n * std::numbers::pi / 120;
      go({14.15 + 5 * std::sin(angle), 11 - 5 * std::cos(angle), 22}, 0.45);
    }
    arc_end = blocks.size() - 1;
    go({22.15, 5.8, 22}, 0.45);  // turns back by 150 deg
    two = go({22, 2, 22}, 0.45);
    go({16, 2, 25}, 0.45);
    go({16, 2, 30}, 0.45);
  }

  std::size_t go(const Vector3& tip, double tilt) {
    blocks.push_back(
        cut_to(static_cast<std::uint32_t>(blocks.size() + 1), tip, tilt, kFeed_mm_per_s));
    return blocks.size() - 1;
  }
};

class SpoiltRecording : public test::Check, public testing::WithParamInterface<bool> {
 protected:
  SpoiltRecording() {
    lift_joint_limits();
    blocks = program.blocks;
    options.tip_tolerance_mm = 0.01;
    options.axis_tolerance_rad = units::rad_from_deg(0.1);
  }

  [[nodiscard]] static Motion run_of(const std::vector<ClBlock>& wanted) {
    return GetParam() ? smooth(wanted) : exact(wanted);
  }

  /// Records the poses, with rest around them.
  void make_records(const Motion& run) {
    records.clear();
    JointVector joints{};
    const auto add = [&](const ToolPose& pose, std::size_t block) {
      joints = solve(model, model.tool_length_mm, pose, 0, joints).q;
      CycleRecord row;
      row.setpoint.cycle = records.size();
      row.setpoint.due_ns = static_cast<std::int64_t>(records.size()) * model.cycle_ns;
      row.setpoint.flags = kSetpointEnabled;
      row.setpoint.position = row.joints = joints;
      row.setpoint.line = blocks[std::min(block, blocks.size() - 1)].line;
      row.state = State::kRunning;
      row.motion = MotionKind::kCut;
      records.push_back(row);
    };
    for (int n = 0; n < 20; ++n) add(run.poses.front(), 1);
    for (std::size_t n = 0; n < run.poses.size(); ++n) add(run.poses[n], run.block[n]);
    for (int n = 0; n < 20; ++n) add(run.poses.back(), run.block.back());
  }

  void expect(bool passes, const std::string& what, const Motion& run) {
    make_records(run);
    const CheckReport report = this->run();
    EXPECT_EQ(report.passed(), passes) << what << "\n" << to_text(report);
  }

  /// The recording of the blocks as `spoil` leaves them, held against those of the program.
  void expect_of(bool passes, const std::string& what,
                 const std::function<void(std::vector<ClBlock>&)>& spoil) {
    std::vector<ClBlock> spoilt = blocks;
    spoil(spoilt);
    expect(passes, what, run_of(spoilt));
  }

  [[nodiscard]] static std::size_t middle_of_block(const Motion& run, std::size_t block) {
    const auto first = std::find(run.block.begin(), run.block.end(), block);
    const auto last = std::find(run.block.rbegin(), run.block.rend(), block);
    return static_cast<std::size_t>((first - run.block.begin()) +
                                    (last.base() - run.block.begin())) /
           2;
  }

  Program program;
};

template <class Items>
void drop(Items& items, std::size_t first, std::size_t count) {
  const auto from = items.begin() + static_cast<std::ptrdiff_t>(first);
  items.erase(from, from + static_cast<std::ptrdiff_t>(count));
}

template <class Items>
void repeat(Items& items, std::size_t first, std::size_t count) {
  const Items again(items.begin() + static_cast<std::ptrdiff_t>(first),
                    items.begin() + static_cast<std::ptrdiff_t>(first + count));
  items.insert(items.begin() + static_cast<std::ptrdiff_t>(first), again.begin(), again.end());
}

TEST_P(SpoiltRecording, PassesWhereItIsRightAndHeldAndWithoutDuplicates) {
  const Motion right = run_of(blocks);
  expect(true, "right", right);
  Motion held = right;
  const std::size_t at = middle_of_block(held, program.line);
  held.poses.insert(held.poses.begin() + static_cast<std::ptrdiff_t>(at), 300, held.poses[at]);
  held.block.insert(held.block.begin() + static_cast<std::ptrdiff_t>(at), 300, held.block[at]);
  expect(true, "held", held);
  expect_of(true, "duplicates left out",
            [&](auto& spoilt) { drop(spoilt, program.retrace + 4, 2); });
}

TEST_P(SpoiltRecording, FailsWhereBlocksAreSkippedOrRepeatedOrChangeTheirOrder) {
  const Program& p = program;
  expect_of(false, "a retrace skipped", [&](auto& b) { drop(b, p.retrace, 2); });
  expect_of(false, "both retraces skipped", [&](auto& b) { drop(b, p.retrace, 4); });
  expect_of(false, "a retrace too many", [&](auto& b) { repeat(b, p.retrace, 2); });
  expect_of(false, "a turn skipped", [&](auto& b) { drop(b, p.turn, 2); });
  expect_of(false, "a turn too many", [&](auto& b) { repeat(b, p.turn, 2); });
  expect_of(false, "a plunge skipped", [&](auto& b) { drop(b, p.plunge, 2); });
  expect_of(false, "a plunge too many", [&](auto& b) { repeat(b, p.plunge, 2); });
  expect_of(false, "the arc's end cut off", [&](auto& b) { drop(b, p.arc_end - 3, 4); });
  expect_of(false, "a block skipped", [&](auto& b) { drop(b, p.two, 1); });
  expect_of(false, "the last block skipped", [&](auto& b) { b.pop_back(); });
  expect_of(false, "two blocks swapped", [&](auto& b) { std::swap(b[p.two], b[p.two + 1]); });
  expect_of(false, "nothing cut", [&](auto& b) { b.resize(2), b[1] = b[0]; });
}

TEST_P(SpoiltRecording, FailsWhereTipOrAxisIsOutOfTolerance) {
  const Program& p = program;
  expect_of(false, "a corner cut", [&](auto& b) {
    ClBlock on = b[p.corner];
    b[p.corner].tip_mm[0] -= 0.03;
    on.tip_mm[1] += 0.03;
    b.insert(b.begin() + static_cast<std::ptrdiff_t>(p.corner) + 1, on);
  });
  expect_of(false, "a retrace too short", [&](auto& b) { b[p.retrace].tip_mm[1] -= 0.015; });
  const Motion right = run_of(blocks);
  const std::size_t at = middle_of_block(right, p.line);
  for (const Vector3& by : {Vector3(0, 0.02, 0), Vector3(0, 0, 0.011)}) {
    Motion aside = right;
    for (std::size_t n = at; n < at + 5; ++n) aside.poses[n].tip += by;
    expect(false, "tip aside", aside);
  }
  Motion tilted = right;
  for (std::size_t n = at; n < at + 5; ++n) {
    tilted.poses[n].axis = (tilted.poses[n].axis + Vector3(0, 0.0035, 0)).normalized();
  }
  expect(false, "axis aside", tilted);
  Motion within = right;
  for (std::size_t n = at; n < at + 5; ++n) within.poses[n].tip[2] += 0.009;
  EXPECT_FALSE(has((make_records(within), run()), Finding::Kind::kTip)) << "inside the tolerance";
}

TEST_P(SpoiltRecording, FailsWhereTheToolGoesBackOrJumpsOrEndsEarly) {
  const Motion right = run_of(blocks);
  const std::size_t at = middle_of_block(right, program.line);
  Motion back = right;
  const ToolPose here = back.poses[at];
  for (int n = 1; n <= 40; ++n) {
    ToolPose pose = here;
    pose.tip[0] -= 0.03 * (n <= 20 ? n : 40 - n) / 20.0;
    back.poses.insert(back.poses.begin() + static_cast<std::ptrdiff_t>(at) + n, pose);
    back.block.insert(back.block.begin() + static_cast<std::ptrdiff_t>(at) + n, program.line);
  }
  expect(false, "30 um back and on again", back);
  Motion jump = right;
  drop(jump.poses, at, 50);
  drop(jump.block, at, 50);
  expect(false, "a jump along the path", jump);
  Motion early = right;
  const std::size_t left_out = GetParam() ? 40 : 150;
  drop(early.poses, right.poses.size() - left_out, left_out);
  drop(early.block, right.poses.size() - left_out, left_out);
  expect(false, "ends early", early);
  blocks[program.line].feed *= 0.2;
  expect(false, "faster than the feed of one block", right);
}

INSTANTIATE_TEST_SUITE_P(ExactAndSmooth, SpoiltRecording, testing::Bool(),
                         [](const auto& of) { return of.param ? "Smooth" : "Exact"; });

}  // namespace
}  // namespace meridian::record
