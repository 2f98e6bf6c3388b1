// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "service/host/process/programs.hpp"
#include "service/recording/trace/kept_files.hpp"
#include "service/recording/trace/slow_cycles.hpp"
#include "service/recording/trace/trace_text.hpp"
#include "service/recording/trace/tracer.hpp"

namespace meridian::trace {
namespace {

constexpr std::int64_t kUs = 1000, kMs = 1'000'000;

TEST(SpanWriter, WritesNothingWhereItIsOffAndCountsWhatHasNoRoom) {
  SpanWriter off(nullptr);
  EXPECT_FALSE(off.is_on());
  off.write(Doing::kStep, 0, 1, 0);
  const auto ring = std::make_unique<SpanRing>();
  SpanWriter on(ring.get());
  EXPECT_TRUE(on.is_on());
  on.stage(Doing::kGather, 10, 30, 7);
  EXPECT_TRUE(ring->spans.empty()) << "staged spans are shown together";
  on.write(Doing::kStep, 30, 30 + (std::int64_t{1} << 40), 7);
  Span span;
  ASSERT_TRUE(ring->spans.try_pop(span));
  EXPECT_EQ(span.doing, Doing::kGather);
  EXPECT_EQ(span.begin_ns, 10);
  EXPECT_EQ(span.took_ns, 20);
  EXPECT_EQ(span.arg, 7U);
  ASSERT_TRUE(ring->spans.try_pop(span));
  EXPECT_EQ(span.took_ns, INT32_MAX) << "as long as can be said";
  for (std::size_t i = 0; i < decltype(ring->spans)::capacity() + 3; ++i) {
    on.write(Doing::kStep, 0, 1, i);
  }
  EXPECT_EQ(ring->lost, 3U);
}

/// A service whose cycles take what the test says.
class TracerTest : public testing::Test {
 protected:
  void cycle(std::int64_t late_ns = 20 * kUs, std::int64_t step_ns = 3 * kUs) {
    SpanWriter pen(&rings_->cycle);
    const std::int64_t due_ns = now_ns_, woke_ns = due_ns + late_ns, done_ns = woke_ns + step_ns;
    ++cycle_;
    pen.stage(Doing::kWakeUp, due_ns, woke_ns, cycle_);
    pen.stage(Doing::kGather, woke_ns, woke_ns + kUs, cycle_);
    pen.stage(Doing::kStep, woke_ns + kUs, done_ns, cycle_);
    pen.stage(Doing::kWakeOther, done_ns, done_ns + 2 * kUs, cycle_);
    pen.stage(Doing::kShow, done_ns + 2 * kUs, done_ns + 3 * kUs, cycle_);
    pen.publish();
    SpanWriter(&rings_->publisher).write(Doing::kWrite, done_ns, done_ns + 20 * kUs, cycle_);
    now_ns_ += kMs + (late_ns / kMs) * kMs;
  }
  /// So many good cycles, with a look of the tracer after every tenth.
  void run(Tracer& tracer, int cycles) {
    for (int i = 0; i < cycles; ++i) {
      cycle();
      if (i % 10 == 9) tracer.work(now_ns_);
    }
  }
  [[nodiscard]] TraceOptions options() const {
    TraceOptions options;
    options.folder = folder_.path() / "traces";
    options.limits = {500 * kUs, 400 * kUs};
    options.every_ns = 1000 * kMs;
    options.max_files = 2;
    return options;
  }
  [[nodiscard]] std::unique_ptr<Tracer> tracer() {
    return std::make_unique<Tracer>(options(), TraceOrigin{"la\"i", "1.0", "host"}, *rings_,
                                    [this](const std::string& text) { said_.push_back(text); });
  }
  [[nodiscard]] std::vector<std::filesystem::path> files() const {
    std::set<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::directory_iterator(options().folder)) {
      found.insert(entry.path());
    }
    return {found.begin(), found.end()};
  }
  [[nodiscard]] static std::string text_of(const std::filesystem::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  const process::ScratchFolder folder_;
  const std::unique_ptr<Rings> rings_ = std::make_unique<Rings>();
  std::int64_t now_ns_ = 5000 * kMs;
  std::uint64_t cycle_ = 0;
  std::vector<std::string> said_;
};

[[nodiscard]] std::size_t count_of(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++count;
  return count;
}

TEST_F(TracerTest, ShowsWhatWasAroundALateCycle) {
  const auto tracer = this->tracer();
  run(*tracer, 200);
  EXPECT_TRUE(files().empty()) << "nothing was slow";
  const std::uint64_t late = cycle_ + 1;
  cycle(7 * kMs + 300 * kUs);
  run(*tracer, 20);
  EXPECT_TRUE(files().empty()) << "what comes after it is not there yet";
  run(*tracer, 50);
  ASSERT_EQ(files().size(), 1U);
  const std::string text = text_of(files()[0]);
  EXPECT_NE(text.find("slow: cycle " + std::to_string(late) + " woke 7300.0 us late"),
            std::string::npos)
      << text.substr(0, 1500);
  EXPECT_NE(text.find("\"machine\": \"la\\\"i\""), std::string::npos);
  // Due 50 ms after the window begins; what its span says is what the clock said.
  EXPECT_NE(text.find("\"ts\": 50000.000, \"dur\": 7300.000, \"args\": {\"cycle\": " +
                      std::to_string(late)),
            std::string::npos);
  const std::size_t steps = count_of(text, "\"step\"");
  EXPECT_GE(steps, 50U + 1U + 19U);
  EXPECT_LE(steps, 50U + 1U + 22U);
  EXPECT_EQ(count_of(text, "\"DDS write\""), steps);
  EXPECT_EQ(said_.size(), 1U);
}

TEST_F(TracerTest, IsWhatAJsonReaderReads) {
  const auto tracer = this->tracer();
  run(*tracer, 100);
  cycle(20 * kUs, 450 * kUs);  // not late, but long
  run(*tracer, 60);
  ASSERT_EQ(files().size(), 1U);
  if (std::system("python3 --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no python3";
  const std::string script =
      "import json, sys; t = json.load(open(sys.argv[1])); e = t['traceEvents']; "
      "x = [i for i in e if i['ph'] == 'X']; assert len(x) > 300, len(x); "
      "assert all(i['dur'] >= 0 and {'name', 'cat', 'pid', 'tid', 'ts'} <= i.keys() for i in x); "
      "assert max(x, key=lambda i: i['dur'])['name'] == 'step'; "
      "assert len([i for i in e if i['ph'] == 'i']) == 1; "
      "assert t['otherData']['machine'] == 'la\"i'";
  const std::string file = (folder_.path() / "read.py").string();
  std::ofstream(file) << script << "\n";
  EXPECT_EQ(std::system(("python3 '" + file + "' '" + files()[0].string() + "'").c_str()), 0)
      << text_of(files()[0]).substr(0, 3000);
}

TEST_F(TracerTest, WritesSeldomAndKeepsTheWorst) {
  const auto tracer = this->tracer();
  const auto stall = [&](std::int64_t late_ns, int then) {
    cycle(late_ns);
    run(*tracer, then);
  };
  run(*tracer, 100);
  stall(1200 * kUs, 100);
  stall(1500 * kUs, 100);
  EXPECT_EQ(files().size(), 1U) << "a second has not passed";
  stall(3 * kMs, 100);
  EXPECT_EQ(files().size(), 2U) << "twice as bad is worth another";
  run(*tracer, 1000);
  stall(900 * kUs, 100);
  EXPECT_EQ(said_.size(), 2U) << "the folder is full of worse ones";
  stall(2 * kMs, 100);
  ASSERT_EQ(files().size(), 2U);
  EXPECT_EQ(files()[0].filename().string().substr(0, 12), "slow-2000us-");
  EXPECT_EQ(files()[1].filename().string().substr(0, 12), "slow-3000us-");
  KeptFiles later(options().folder, 2);  // those of earlier services count
  EXPECT_FALSE(later.would_keep(1500 * kUs));
  EXPECT_TRUE(later.would_keep(2500 * kUs));
}

/// The window of a cycle that was hardly slow is still open when the worst of all comes.
TEST_F(TracerTest, ShowsTheWorstCycleThatComesBehindAWindowNotYetWritten) {
  const auto tracer = this->tracer();
  run(*tracer, 100);
  cycle(600 * kUs);
  for (int i = 0; i < 24; ++i) cycle();
  const std::uint64_t worst = cycle_ + 1;
  cycle(40 * kMs);
  run(*tracer, 100);
  ASSERT_EQ(files().size(), 2U);
  EXPECT_EQ(count_of(text_of(files()[0]) + text_of(files()[1]),
                     "slow: cycle " + std::to_string(worst) + " woke 40000.0 us late"),
            1U);
}

TEST_F(TracerTest, IsNoneWhereItsFolderCannotBeMadeAndTheReasonIsReported) {
  TraceOptions options = this->options();
  options.folder = "/proc/nowhere";
  const auto tracer = make_tracer(options, TraceOrigin{"lai", "1.0", "host"}, *rings_, {},
                                  [this](const std::string& text) { said_.push_back(text); });
  EXPECT_EQ(tracer, nullptr);
  ASSERT_EQ(said_.size(), 1U);
  EXPECT_EQ(said_[0].rfind("no traces: ", 0), 0U) << said_[0];
  EXPECT_NE(said_[0].find("/proc/nowhere"), std::string::npos) << said_[0];
}

TEST_F(TracerTest, IsNotWrittenThroughALinkThatLiesInItsWay) {
  KeptFiles kept(options().folder, 5);
  const auto other = folder_.path() / "other";
  std::ofstream(other) << "not ours";
  const std::time_t now = std::time(nullptr);
  for (std::time_t t = now; t < now + 30; ++t) {  // whatever second it is written in
    std::tm parts{};
    ::gmtime_r(&t, &parts);
    char name[64];
    (void)std::strftime(name, sizeof name, "slow-2000us-%Y%m%dT%H%M%SZ.part", &parts);
    std::filesystem::create_symlink(other, options().folder / name);
  }
  const auto file = kept.add(2 * kMs, "{}");
  ASSERT_FALSE(file.empty());
  EXPECT_EQ(text_of(other), "not ours");
  EXPECT_EQ(text_of(file), "{}");
}

TEST_F(TracerTest, KeepsWhatWasBeforeAStallThatOnlyTheCycleSleptThrough) {
  const auto tracer = this->tracer();
  run(*tracer, 100);
  const std::int64_t due_ns = now_ns_;
  for (int i = 0; i < 30; ++i) tracer->work(due_ns + i * 10 * kMs);
  cycle(300 * kMs);
  run(*tracer, 100);
  ASSERT_EQ(files().size(), 1U);
  EXPECT_GE(count_of(text_of(files()[0]), "\"step\""), 50U);
}

}  // namespace
}  // namespace meridian::trace
