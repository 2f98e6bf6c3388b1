// SPDX-License-Identifier: Apache-2.0

/// The smooth path as a stream: seams, names, feeds, chunks, lag and memory.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "property/path/band_check.hpp"
#include "property/path/hostile_path.hpp"
#include "support/heap_watch.hpp"

namespace meridian::test {
namespace {

ClBlock line_to(std::uint64_t sequence, const Vector3& tip) {
  ClBlock block;
  block.sequence = sequence;
  block.line = static_cast<std::uint32_t>(sequence) + 1;
  block.tip_mm = to_array(tip);
  block.feed = 50;
  block.feed_meaning = FeedMeaning::kTip;
  return block;
}

/// Blocks of `step` mm along a wave in tip and axis, or straight with size 0.
std::vector<ClBlock> wave(std::size_t count, double step, double size = 1) {
  std::vector<ClBlock> blocks;
  for (std::size_t n = 0; n < count; ++n) {
    const double x = step * static_cast<double>(n);
    blocks.push_back(line_to(n, {x, 5 * size * std::sin(x / 9), 2 * size * std::cos(x / 7)}));
    const double tilt = 0.3 + 0.1 * size * std::sin(x / 11);
    blocks.back().axis = {std::sin(tilt), 0, std::cos(tilt)};
  }
  return blocks;
}

bool is_same(const BandRun& a, const BandRun& b) {
  if (a.spans.size() != b.spans.size() || a.ends.size() != b.ends.size()) return false;
  for (std::size_t n = 0; n < a.spans.size(); ++n) {
    const BandSpan &x = a.spans[n], &y = b.spans[n];
    if (x.u0 != y.u0 || x.length != y.length || x.c != y.c || x.sequence != y.sequence ||
        x.feed_mm_per_s != y.feed_mm_per_s) {
      return false;
    }
  }
  for (std::size_t n = 0; n < a.ends.size(); ++n) {
    if (a.ends[n].u != b.ends[n].u || a.ends[n].sequence != b.ends[n].sequence) return false;
  }
  return true;
}

void expect_smooth_joins(const BandRun& run) {
  for (std::size_t n = 1; n < run.spans.size(); ++n) {
    const BandSpan &a = run.spans[n - 1], &b = run.spans[n];
    ASSERT_EQ(a.u0 + a.length, b.u0) << "span " << n;
    const auto end = pose_on(a.c, Jet<3>::variable(a.length));
    const auto begin = pose_on(b.c, Jet<3>::variable(0.0));
    double size = 1;  // a derivative over the span, in mm and rad
    for (int order = 0; order <= 3; ++order, size *= std::min(a.length, b.length)) {
      for (int i = 0; i < 3; ++i) {
        const double tip = end.tip[i].derivative(order) - begin.tip[i].derivative(order);
        const double axis = end.axis[i].derivative(order) - begin.axis[i].derivative(order);
        ASSERT_LE(std::abs(tip) * size, 1e-11) << "span " << n;
        ASSERT_LE(std::abs(axis) * size, 1e-13) << "span " << n;
      }
    }
  }
}

TEST(BandStream, HasThreeContinuousDerivativesAcrossSpansAndWindows) {
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const BandRun run = run_band(HostilePath(seed).make(16));
    ASSERT_GT(run.spans.size(), 200U);
    expect_smooth_joins(run);
  }
}

TEST(BandStream, IsTheSameBitForBitHoweverTheBlocksArrive) {
  for (std::uint32_t seed = 1; seed <= 12; ++seed) {
    const auto blocks = HostilePath(seed).make(24);
    const BandRun every = run_band(blocks);
    BandSpline spline;  // used twice: begin() forgets
    const BandRun once = run_band(spline, blocks, {}, [](std::size_t) { return false; });
    EXPECT_TRUE(is_same(every, once)) << "seed " << seed;
    std::mt19937 engine(seed);
    const BandRun some =
        run_band(spline, blocks, {}, [&](std::size_t) { return engine() % 37 == 0; });
    EXPECT_TRUE(is_same(every, some)) << "seed " << seed;
  }
}

/// What is committed is final: a stream that ends early gives the same spans as far as it goes
/// before finish().
TEST(BandStream, CommitsNothingThatLaterBlocksCouldChange) {
  const auto blocks = HostilePath(5).make(40);
  BandSpline late;
  const BandRun whole = run_band(late, blocks, {}, [](std::size_t) { return false; });
  for (std::size_t cut = 3; cut < blocks.size(); cut += 1 + blocks.size() / 40) {
    BandSpline spline;
    BandRun part;
    spline.begin(pose_of(blocks[0]), {});
    for (std::size_t n = 1; n < cut; ++n) {
      ASSERT_TRUE(spline.push(blocks[n]));
      part.take_all(spline);
    }
    ASSERT_LE(part.spans.size(), whole.spans.size());
    for (std::size_t n = 0; n < part.spans.size(); ++n) {
      ASSERT_EQ(part.spans[n].c, whole.spans[n].c) << "cut " << cut << " span " << n;
    }
  }
}

TEST(BandStream, EndsNotFarBehindTheLastBlock) {
  double longest = 0;
  for (const double step : {0.02, 0.3, 1.0}) {
    const auto blocks = wave(static_cast<std::size_t>(900 / step), step, step < 1 ? 1 : 0);
    const ProgrammedPath path(blocks);
    BandSpline spline;
    BandRun run;
    spline.begin(pose_of(blocks[0]), {});
    double u = 0;
    for (std::size_t n = 1; n < blocks.size(); ++n) {
      ASSERT_TRUE(spline.push(blocks[n]));
      u += std::hypot((pose_of(blocks[n]).tip - pose_of(blocks[n - 1]).tip).norm(),
                      50 * angle_between(pose_of(blocks[n]).axis, pose_of(blocks[n - 1]).axis));
      run.take_all(spline);
      longest = std::max(longest, u - run.end());
    }
  }
  std::printf("the committed spline ends at most %.1f mm behind the last block\n", longest);
  EXPECT_LE(longest, 175);
}

TEST(BandStream, NamesBlocksAndBoundsFeedsOfAllThatASpanTouches) {
  std::vector<ClBlock> blocks = {line_to(0, {0, 0, 0}), line_to(3, {20, 0, 0}),
                                 line_to(4, {20, 0, 0}), line_to(5, {20, 30, 0}),
                                 line_to(9, {20, 30, 40})};
  blocks[1].feed = 40;
  blocks[3].feed = 60;
  blocks[4].feed_meaning = FeedMeaning::kInverseTime;
  blocks[4].feed = 0.5;  // 2 s for 40 mm
  const BandRun run = run_band(blocks);
  ASSERT_EQ(run.ends.size(), 3U);  // the second block has no length
  EXPECT_EQ(run.ends[0].sequence, 3U);
  EXPECT_EQ(run.ends[1].line, 6U);
  EXPECT_NEAR(run.ends[1].u, 50, 1e-12);
  EXPECT_NEAR(run.ends[2].feed_mm_per_s, 20, 1e-12);
  for (const BandSpan& span : run.spans) {
    const double end = span.u0 + span.length;
    const double slowest = span.u0 < 20 ? 40 : span.u0 < 50 ? 60 : 1e300;
    if (span.u0 >= 50) {
      EXPECT_NEAR(span.feed_mm_per_s, end < 55 ? 60 : 20, 1e-9) << "the fastest within 5 mm";
    } else {
      EXPECT_EQ(span.feed_mm_per_s, slowest) << span.u0;
    }
    if (end > 50) {
      EXPECT_NEAR(span.u_speed_mm_per_s, 20, 1e-9);
      EXPECT_LT(span.turn_rad_per_s, 0.1) << "no block turns the axis";
    } else {
      EXPECT_GT(span.u_speed_mm_per_s, 1e300) << span.u0;
      EXPECT_GT(span.turn_rad_per_s, 1e300) << span.u0;
    }
    EXPECT_EQ(span.sequence, span.u0 < 20 ? 3U : span.u0 < 50 ? 5U : 9U) << span.u0;
  }
}

/// A block of 0.1 um in a second on a span of 12 um took two minutes.
TEST(BandStream, TakesTheTimesOfTheShortestBlocksInInverseTimeAndNoMore) {
  std::vector<ClBlock> blocks = {line_to(0, {0, 0, 0}), line_to(1, {20, 0, 0})};
  double x = 20, time_s = 0;
  for (const double dx : {1e-4, 0.003, 2e-5, 0.09}) {
    x += dx;
    ClBlock block = line_to(blocks.size(), {x, 0, 0});
    block.feed_meaning = FeedMeaning::kInverseTime;
    block.feed = 2;  // half a second each
    time_s += 1 / block.feed;
    blocks.push_back(block);
  }
  blocks.push_back(line_to(blocks.size(), {x + 20, 0, 0}));
  double min_s = 0;
  for (const BandSpan& span : run_band(blocks).spans) {
    min_s += span.length / span.u_speed_mm_per_s;
  }
  EXPECT_GE(min_s, time_s * (1 - 1e-9));
  EXPECT_LE(min_s, 1.2 * time_s);
}

/// Where its span was as slow as the slowest block on it, a block of 0.05 mm in 0.1 s took 20 s.
TEST(BandStream, CutsASpanWhereASlowBlockInInverseTimeBeginsOrEnds) {
  struct Timed {
    double length_mm, time_s;  // 0: a block with tip feed
  };
  const std::vector<Timed> timed = {{5, 0.1},  {0.05, 0.1}, {0.3, 60}, {0.2, 0.05},
                                    {0.4, 30}, {0.06, 0},   {0.3, 60}, {5, 0}};
  std::vector<ClBlock> blocks = {line_to(0, {0, 0, 0})};
  double x = 0;
  for (const auto& [length_mm, time_s] : timed) {
    x += length_mm;
    blocks.push_back(line_to(blocks.size(), {x, 0.01 * std::sin(9 * x), 0}));
    if (time_s == 0) continue;
    blocks.back().feed_meaning = FeedMeaning::kInverseTime;
    blocks.back().feed = 1 / time_s;
  }
  const BandRun run = run_band(blocks);
  ASSERT_EQ(run.ends.size(), timed.size());
  expect_smooth_joins(run);
  double begin = 0;
  for (std::size_t n = 0; n < timed.size(); ++n) {
    const double end = run.ends[n].u;
    double time_s = 0;
    for (const BandSpan& span : run.spans) {
      const double from = std::max(begin, span.u0), to = std::min(end, span.u0 + span.length);
      if (to > from) time_s += (to - from) / span.u_speed_mm_per_s;
    }
    EXPECT_GE(time_s, timed[n].time_s * (1 - 1e-9)) << "block " << n + 1;
    EXPECT_LE(time_s, timed[n].time_s * (1 + 1e-9)) << "block " << n + 1;
    begin = end;
  }
}

TEST(BandStream, TakesPathsShorterThanAnyStep) {
  for (const double length : {1e-5, 1e-3, 0.1, 2.0, 3.0}) {
    const std::vector<ClBlock> blocks = {line_to(0, {7, 0, 0}), line_to(1, {7, length, 0})};
    const BandRun run = run_band(blocks);
    ASSERT_FALSE(run.spans.empty()) << length;
    EXPECT_NEAR(run.end(), length, 1e-15);
    EXPECT_NEAR(pose_at_u(run, length).tip[1], length, 1e-15);
  }
  BandSpline spline;
  EXPECT_TRUE(run_band({line_to(0, {7, 0, 0}), line_to(1, {7, 1e-7, 0})}).spans.empty());
  spline.begin(pose_of(line_to(0, {0, 0, 0})), {});
  EXPECT_EQ(spline.next(), nullptr);
  EXPECT_FALSE(spline.is_done());
  spline.finish();
  EXPECT_TRUE(spline.is_done());
}

TEST(BandStream, NeedsNoMoreMemoryForTheShortestBlocks) {
  BandSpline spline;
  const watch::HeapWatch heap;
  const ClBlock first = line_to(0, {0, 0, 0});
  spline.begin(pose_of(first), {});
  std::size_t spans = 0;
  double end = 0;
  const auto take = [&] {
    while (const BandSpan* span = spline.next()) {
      ++spans;
      end = span->u0 + span->length;
    }
  };
  constexpr std::uint64_t kCount = 300000;
  for (std::uint64_t n = 1; n <= kCount; ++n) {
    const double x = 1e-4 * static_cast<double>(n);
    const ClBlock block = line_to(n, {x, 5 * std::sin(x / 5), 0});
    int tries = 0;
    while (!spline.push(block)) {
      take();
      ASSERT_LT(++tries, 2) << "block " << n;
    }
  }
  spline.finish();
  take();
  EXPECT_TRUE(spline.is_done());
  EXPECT_GT(end, 1e-4 * kCount);
  EXPECT_GT(spans, 100U);
  if (watch::is_heap_watched()) {
    EXPECT_EQ(heap.calls(), watch::HeapCalls{});
  }
}

/// A block that is cut into more segments than there is room for is taken up bit by bit.
TEST(BandStream, TakesABlockOfAnyLength) {
  ClBlock block = line_to(1, {0, 0, 2e4});
  block.is_arc = true;
  block.centre_mm = {1000, 0, 0};
  block.sweep_rad = 2 * std::numbers::pi;
  const BandRun run = run_band({line_to(0, {0, 0, 0}), block}, {0.001, 1e-3, {}});
  EXPECT_NEAR(run.end(), std::hypot(2e4, 2000 * std::numbers::pi), 1);
  EXPECT_NEAR(pose_at_u(run, run.end()).tip[2], 2e4, 1e-9);
}

}  // namespace
}  // namespace meridian::test
