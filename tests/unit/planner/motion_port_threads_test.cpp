// SPDX-License-Identifier: Apache-2.0

/// The motion port between two real threads: the planner writes as fast as there is room, the
/// cycle's side takes piece after piece. Run by the thread sanitizer too.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>
#include <thread>

#include "bench/planned_path.hpp"
#include "meridian/planner/motion_port.hpp"
#include "meridian/planner/rest_to_rest.hpp"
#include "support/machines.hpp"

namespace meridian {
namespace {

constexpr std::uint64_t kBlocks = 6'000;  // more pieces than the port holds: it fills and drains

TEST(MotionPort, HandsEveryPieceOverInOrderWithItsPathBetweenTwoThreads) {
  const MachineModel machine = test::lai_machine();
  const auto port = std::make_unique<MotionPort>();
  RestToRestPlanner planner(machine);
  planner.begin({}, machine.tool_length_mm, 1);
  std::atomic<bool> is_planned{false};
  std::atomic<bool> is_refused{false};
  std::uint64_t times_it_was_full = 0;

  std::thread writing([&] {
    MotionWriter writer(*port);
    for (std::uint64_t i = 0; i < kBlocks && !is_refused;) {
      const PlanStatus status = planner.plan(bench::block_on_path(i), writer).status;
      if (status == PlanStatus::kOk) {
        ++i;
      } else if (status == PlanStatus::kNoRoom) {
        ++times_it_was_full;
        std::this_thread::yield();
      } else {
        is_refused = true;
      }
    }
    is_planned.store(true, std::memory_order_release);
  });

  MotionReader reader(*port);
  reader.set_epoch(1);
  std::uint64_t pieces = 0;
  std::uint64_t out_of_order = 0;
  std::uint64_t without_path = 0;
  std::uint64_t jumps = 0;
  std::uint64_t last_sequence = 0;
  JointVector last_end{};
  std::uint64_t last_path = 0;
  for (;;) {
    const bool is_last_look = is_planned.load(std::memory_order_acquire);
    const TimePiece* const piece = reader.advance();
    if (piece == nullptr) {
      if (is_last_look) {
        break;
      }
      std::this_thread::yield();
      continue;
    }
    const PathPiece* const path = reader.path();
    out_of_order += piece->sequence < last_sequence ? 1 : 0;
    without_path += path == nullptr || path->index != piece->path_index ? 1 : 0;
    if (path != nullptr && (pieces == 0 || path->index != last_path)) {
      for (int joint = 0; joint < machine.joint_count; ++joint) {
        jumps += pieces > 0 && std::abs(path->joints_begin[joint] - last_end[joint]) > 1e-9 ? 1 : 0;
      }
      last_path = path->index;
      last_end = path->joints_end;
    }
    last_sequence = piece->sequence;
    ++pieces;
  }
  writing.join();

  EXPECT_FALSE(is_refused);
  EXPECT_GT(pieces, 3 * kBlocks);
  EXPECT_EQ(out_of_order, 0U);
  EXPECT_EQ(without_path, 0U);
  EXPECT_EQ(jumps, 0U);
  EXPECT_EQ(last_sequence, kBlocks - 1);
  std::printf("%llu pieces of %llu blocks, the port was full %llu times\n",
              static_cast<unsigned long long>(pieces), static_cast<unsigned long long>(kBlocks),
              static_cast<unsigned long long>(times_it_was_full));
}

}  // namespace
}  // namespace meridian
