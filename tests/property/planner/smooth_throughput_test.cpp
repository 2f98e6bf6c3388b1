// SPDX-License-Identifier: Apache-2.0

/// What a block costs on dense five-axis data, at the begin and at the end of a long program, and
/// whether memory stays as it is. A longer run: MERIDIAN_BLOCKS=1000000
/// smooth_property_test --gtest_filter='SmoothThroughput*'

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "property/planner/smooth_trace.hpp"
#include "service/host/probe/budgets.hpp"
#include "support/cpu_time.hpp"
#include "support/dense_block.hpp"
#include "support/draws.hpp"
#include "support/machines.hpp"

namespace meridian::test::smooth_throughput {
namespace {

/// Resident memory, MiB.
double resident_mib() {
  std::ifstream file("/proc/self/statm");
  double all = 0, resident = 0;
  file >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

/// What one part of a program cost.
struct Part {
  double cpu = 0, motion = 0;
  int blocks = 0;
  [[nodiscard]] double per_block() const { return cpu / blocks; }
};

/// A smooth program, planned and read as a cycle that needs no time would.
class Stream {
 public:
  Stream(double step, double feed)
      : model_(bench_machine()),
        step_(step),
        feed_(feed),
        planner_(model_),
        writer_(port_),
        reader_(port_) {
    planner_.begin(joints_of(model_, dense_block(0, step, feed)), model_.tool_length_mm, 0,
                   {Transition::kSmooth, 0, 0});
  }

  /// Takes `blocks` more; false where one was refused.
  bool run(int blocks, Part& part) {
    const double begin = cpu_s(), before = motion_;
    for (int n = 0; n < blocks; ++n) {
      const ClBlock block = dense_block(next_++, step_, feed_);
      PlanStatus status = planner_.plan(block, writer_).status;
      for (int tries = 0; status == PlanStatus::kNoRoom && tries < 100; ++tries) {
        read();
        status = planner_.plan(block, writer_).status;
      }
      if (status != PlanStatus::kOk) return false;
      if (n % 16 == 0) read();
    }
    read();
    part = {cpu_s() - begin, motion_ - before, blocks};
    return true;
  }

 private:
  void read() {
    while (!is_before_tail()) {
      const TimePiece* piece = reader_.advance();
      if (piece == nullptr) return;
      motion_ += piece->duration;
    }
  }
  bool is_before_tail() {
    const TimePiece* next = reader_.look_ahead(1);
    if (next == nullptr) return true;
    if (!next->is_tail) return false;
    for (std::size_t i = 2;; ++i) {
      const TimePiece* later = reader_.look_ahead(i);
      if (later == nullptr) return true;
      if (later->window != next->window) return later->is_from_rest;
    }
  }

  MachineModel model_;
  double step_, feed_;
  SmoothPlanner planner_;
  MotionPort port_;
  MotionWriter writer_;
  MotionReader reader_;
  std::uint64_t next_ = 0;
  double motion_ = 0;
};

struct Density {
  double step_mm, feed_mm_per_s;
  int blocks;
};

TEST(SmoothThroughput, ABlockCostsTheSameAtTheEndOfALongProgram) {
  const char* const wanted = std::getenv("MERIDIAN_BLOCKS");
  for (const Density& density : {Density{0.0001, 5, 500000}, Density{0.002, 50, 100000},
                                 Density{0.05, 50, 20000}, Density{0.3, 50, 16000}}) {
    SCOPED_TRACE(testing::Message() << density.step_mm << " mm");
    const int blocks = wanted != nullptr ? std::atoi(wanted) : draws(density.blocks);
    const auto stream = std::make_unique<Stream>(density.step_mm, density.feed_mm_per_s);
    Part warm, first, middle, last;
    ASSERT_TRUE(stream->run(blocks / 10, warm));
    const double memory = resident_mib();
    ASSERT_TRUE(stream->run(blocks / 5, first));
    ASSERT_TRUE(stream->run(blocks / 2, middle));
    ASSERT_TRUE(stream->run(blocks / 5, last));
    const double cpu = first.cpu + middle.cpu + last.cpu;
    const double motion = first.motion + middle.motion + last.motion;
    std::printf(
        "%.4f mm at %.0f mm/s, %d blocks: %.2f us per block, the last fifth %.2f of the first; "
        "%.0f "
        "blocks/s, %.0f s of motion per s; %.2f MiB more\n",
        density.step_mm, density.feed_mm_per_s, blocks, 1e6 * cpu / (0.9 * blocks),
        last.per_block() / first.per_block(), 0.9 * blocks / cpu, motion / cpu,
        resident_mib() - memory);
    if (kIsTimed) {
      const probe::Budget drift = probe::load_budget("planner_drift");
      EXPECT_TRUE(drift.is_kept(1e6 * last.per_block(), 1e6 * first.per_block()))
          << 1e6 * last.per_block() << "; " << to_text(drift, 1e6 * first.per_block());
    }
    const probe::Budget growth = probe::load_budget("planner_growth");
    const double grown_mib = resident_mib() - memory;
    EXPECT_TRUE(growth.is_kept(grown_mib)) << grown_mib << "; " << to_text(growth);
  }
}

}  // namespace
}  // namespace meridian::test::smooth_throughput
