// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <chrono>

#include "service/machine/file/machine_file.hpp"
#include "service/panel/desks/request_guard.hpp"
#include "service/panel/motion.hpp"
#include "service/panel/page.hpp"
#include "service/panel/serve/hub.hpp"
#include "service/panel/serve/news.hpp"

namespace meridian::panel {
namespace {

using namespace std::chrono_literals;

[[nodiscard]] const MachineModel& trunnion() {
  static const MachineModel kModel =
      config::load_machine(MERIDIAN_SOURCE_DIR "/deploy/machines/trunnion-ac.toml");
  return kModel;
}

const Site kLoopback{8090, ""};
const Site kBehindProxy{8090, "cell-4.shop:8443"};

TEST(RequestGuard, KnowsItsOwnNames) {
  EXPECT_TRUE(is_own_host("127.0.0.1:8090", kLoopback));
  EXPECT_TRUE(is_own_host("localhost:8090", kLoopback));
  EXPECT_TRUE(is_own_host("[::1]:8090", kLoopback));
  EXPECT_TRUE(is_own_host("localhost:8090", kBehindProxy));
  EXPECT_TRUE(is_own_host("cell-4.shop:8443", kBehindProxy));
  EXPECT_FALSE(is_own_host("cell-4.shop:8443", kLoopback));
  for (const char* const foreign :
       {"", "evil.example:8090", "127.0.0.1", "127.0.0.1:80", "127.0.0.1:80901",
        "localhost.evil.example:8090", "cell-4.shop", "cell-4.shop:8090"}) {
    EXPECT_FALSE(is_own_host(foreign, kLoopback)) << foreign;
    EXPECT_FALSE(is_own_host(foreign, kBehindProxy)) << foreign;
  }
}

TEST(RequestGuard, BrowsersLeaveOutThePortOfHttp) {
  const Site plain{80, ""};
  EXPECT_EQ(port_in_host(80), "");
  EXPECT_EQ(port_in_host(8090), ":8090");
  for (const char* const own : {"127.0.0.1", "localhost", "[::1]", "127.0.0.1:80"}) {
    EXPECT_TRUE(is_own_host(own, plain)) << own;
  }
  EXPECT_TRUE(is_own_origin("http://127.0.0.1", "127.0.0.1", plain));
  for (const char* const foreign : {"127.0.0.1:8090", "127.0.0.1.evil.example", ""}) {
    EXPECT_FALSE(is_own_host(foreign, plain)) << foreign;
  }
}

TEST(RequestGuard, AnotherSiteIsNoOrigin) {
  EXPECT_TRUE(is_own_origin("http://localhost:8090", "localhost:8090", kLoopback));
  for (const char* const foreign : {"", "null", "http://evil.example", "http://localhost:8091",
                                    "https://localhost:8090", "http://127.0.0.1:8090"}) {
    EXPECT_FALSE(is_own_origin(foreign, "localhost:8090", kLoopback)) << foreign;
  }
}

TEST(RequestGuard, BehindAProxyThePageIsSecured) {
  EXPECT_TRUE(is_own_origin("https://cell-4.shop:8443", "cell-4.shop:8443", kBehindProxy));
  EXPECT_TRUE(is_own_origin("http://localhost:8090", "localhost:8090", kBehindProxy));
  for (const char* const foreign :
       {"http://cell-4.shop:8443", "https://cell-4.shop", "https://evil.example:8443", "null"}) {
    EXPECT_FALSE(is_own_origin(foreign, "cell-4.shop:8443", kBehindProxy)) << foreign;
  }
}

TEST(RequestGuard, ReadsThePublicAddressAsABrowserWritesIt) {
  EXPECT_EQ(public_host_of("https://cell-4.shop:8443"), "cell-4.shop:8443");
  EXPECT_EQ(public_host_of("https://Cell-4.Shop/"), "cell-4.shop");
  EXPECT_EQ(public_host_of("https://10.0.0.7:443"), "10.0.0.7");
  for (const char* const bad : {"", "cell-4.shop", "http://cell-4.shop", "https://", "https://a/b",
                                "https://a b", "https://user@a"}) {
    EXPECT_FALSE(public_host_of(bad)) << bad;
  }
}

TEST(Hub, AReaderThatWasAwayGetsTheNewestOfEachKind) {
  Hub hub;
  Hub::Cursor cursor;
  hub.publish(Hub::kFrame, "old");
  hub.publish(Hub::kFrame, "new");
  hub.publish(Hub::kMachine, "machine");
  const auto texts = hub.wait(cursor, 0ms);
  ASSERT_EQ(texts.size(), 2U);
  EXPECT_EQ(*texts[0], "machine");
  EXPECT_EQ(*texts[1], "new");
  EXPECT_TRUE(hub.wait(cursor, 0ms).empty());
}

TEST(Hub, AClosedHubLetsItsReadersGo) {
  Hub hub;
  Hub::Cursor cursor;
  hub.publish(Hub::kFrame, "frame");
  hub.close();
  EXPECT_TRUE(hub.wait(cursor, 10s).empty());
}

/// Joint X of the machine at `x` mm in cycle `cycle`.
[[nodiscard]] Setpoint setpoint_at(std::uint64_t cycle, double x) {
  Setpoint setpoint;
  setpoint.cycle = cycle;
  setpoint.position[0] = x;
  setpoint.flags = kSetpointEnabled;
  return setpoint;
}

TEST(Motion, ShareOfTheVelocityLimitIsThatOfTheFiniteDifference) {
  Motion motion(trunnion());
  motion.add(setpoint_at(1, 0));
  motion.add(setpoint_at(2, 0.15));  // 150 mm/s of 300
  EXPECT_NEAR(motion.shares()[0][0], 0.5, 1e-9);
  EXPECT_EQ(motion.shares()[0][1], 0);  // one difference gives no acceleration
  motion.clear();
  EXPECT_EQ(motion.shares()[0][0], 0);
}

TEST(Motion, ALostCycleMakesNoFalseAcceleration) {
  Motion motion(trunnion());
  motion.add(setpoint_at(1, 0));
  motion.add(setpoint_at(2, 0.1));
  motion.add(setpoint_at(5, 0.4));
  motion.add(setpoint_at(6, 0.5));
  EXPECT_NEAR(motion.shares()[0][0], 1.0 / 3, 1e-9);
  EXPECT_EQ(motion.shares()[0][1], 0);
}

TEST(Motion, AnotherToolIsNoFeed) {
  Motion motion(trunnion());
  motion.add(setpoint_at(1, 0));
  motion.add(std::array{setpoint_at(2, 0.1)}, trunnion().tool_length_mm + 25);
  EXPECT_NEAR(motion.samples().back().feed_mm_per_s, 100, 1e-6);
}

TEST(Motion, AToolChangesAtTheLastRest) {
  Motion motion(trunnion(), 1);
  const double before = trunnion().tool_length_mm;
  motion.add(std::array{setpoint_at(1, 0)}, before);
  motion.add(std::array{setpoint_at(2, 0.1), setpoint_at(3, 0.2), setpoint_at(4, 0.2),
                        setpoint_at(5, 0.3)},
             before + 25);
  const auto& trail = motion.trail();
  ASSERT_EQ(trail.size(), 5U);
  for (std::size_t i = 1; i < 3; ++i) {
    EXPECT_NEAR(trail[i].pose.tip[2], trail[0].pose.tip[2], 1e-12) << i;
  }
  for (std::size_t i = 3; i < 5; ++i) {
    EXPECT_NEAR(trail[i].pose.tip[2], trail[0].pose.tip[2] - 25, 1e-9) << i;
  }
}

TEST(Motion, TheTrailIsForwardKinematics) {
  Motion motion(trunnion(), 1);
  motion.add(setpoint_at(8, 12.5));
  ASSERT_EQ(motion.trail().size(), 1U);
  EXPECT_NEAR(motion.trail()[0].pose.tip[0], 12.5, 1e-12);
  EXPECT_NEAR(motion.trail()[0].pose.axis[2], 1, 1e-15);
}

TEST(Motion, FeedbackIsComparedWithTheSetpointThatItSaw) {
  Motion motion(trunnion());
  motion.add(setpoint_at(1, 1.0));
  motion.add(setpoint_at(2, 2.0));
  motion.add_feedback(1, 1, JointVector{0.75});
  EXPECT_NEAR(motion.following()[0], 0.25, 1e-12);
  motion.add_feedback(777, 1, JointVector{100});  // never seen
  EXPECT_NEAR(motion.following()[0], 0.25, 1e-12);
}

TEST(News, AnAlarmOfAProgramNamesItsLineAndBlock) {
  News news;
  dds::Status status;
  status.alarm = Alarm::kDriveFault;
  status.alarm_joint = 0;
  status.alarm_line = 9;
  status.block = 2;
  EXPECT_TRUE(news.add(status, trunnion(), {}));
  const std::string& text = news.items().back().text;
  EXPECT_NE(text.find("line 9"), std::string::npos) << text;
  EXPECT_NE(text.find("block 2"), std::string::npos) << text;
}

TEST(News, AnAlarmIsReportedOnceWithItsRemedy) {
  News news;
  dds::Status status;
  status.service_id = 7;
  EXPECT_FALSE(news.add(status, trunnion(), {}));
  status.alarm = Alarm::kEmergencyStop;
  EXPECT_TRUE(news.add(status, trunnion(), {}));
  EXPECT_FALSE(news.add(status, trunnion(), {}));
  ASSERT_EQ(news.items().size(), 1U);
  EXPECT_EQ(news.items()[0].severity, Severity::kAlarm);
  EXPECT_NE(news.items()[0].text.find("reset"), std::string::npos) << news.items()[0].text;
}

TEST(News, KeepsNoMoreThanItsRoom) {
  News news;
  dds::Status status;
  status.service_id = 7;
  for (int i = 0; i < 1000; ++i) {
    status.message = std::to_string(i);
    news.add(status, trunnion(), {});
  }
  EXPECT_EQ(news.items().size(), News::kKept);
  EXPECT_EQ(news.items().back().text, "999");
}

TEST(Page, IsWhatItsBudgetAllows) {
  std::size_t bytes = 0;
  for (const char* const path : {"/", "/panel.js", "/panel.css"}) {
    const auto file = find_page_file(path);
    ASSERT_TRUE(file) << path;
    bytes += file->bytes.size();
  }
  EXPECT_LT(bytes, 1'000'000U);
  EXPECT_FALSE(find_page_file("/../etc/passwd"));
  EXPECT_NE(viewer_html().find("MERIDIAN_REPORT"), std::string_view::npos);
}

}  // namespace
}  // namespace meridian::panel
