// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "meridian/drive.hpp"
#include "support/heap_watch.hpp"
#include "support/private_domain.hpp"
#include "unit/drive_kit/scripted_hardware.hpp"
#include "unit/drive_kit/wire_service.hpp"

namespace meridian::drive {
namespace {

/// The library as an integrator has it, and a service on the wire.
class Library : public testing::Test {
 protected:
  Library() {
    options_.machine_file = MERIDIAN_SOURCE_DIR "/deploy/machines/lai.toml";
    options_.domain = domain_.id();
    options_.priority = 0;
    options_.bridge_cycles = 100;  // the host of a test takes processors away
    options_.report = [this](const std::string& text) {
      const std::lock_guard lock(mutex_);
      said_.push_back(text);
    };
  }
  ~Library() override {
    stop();
    drives_.reset();  // its threads use what is below
  }
  void start() {
    drives_.emplace(options_, motors_);
    thread_ = std::thread([this] {
      while (!is_stopping_) {
        const watch::HeapWatch heap;
        drives_->work();
        const watch::HeapCalls calls = heap.calls();
        if (calls != watch::HeapCalls{} && calls_.empty())
          calls_ = watch::HeapWatch::callers(calls);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
  }
  void stop() {
    is_stopping_ = true;
    if (thread_.joinable()) thread_.join();
  }
  [[nodiscard]] bool is_said(const std::string& text) {
    for (int n = 0; n < 300; ++n) {
      {
        const std::lock_guard lock(mutex_);
        for (const std::string& one : said_) {
          if (one.find(text) != std::string::npos) return true;
        }
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

  const support::PrivateDomain domain_;
  Options options_;
  test::ScriptedHardware motors_;
  std::optional<Drives> drives_;
  std::atomic<bool> is_stopping_{false};
  std::thread thread_;
  std::string calls_;  ///< who made heap calls in work()
  std::mutex mutex_;
  std::vector<std::string> said_;
};

TEST_F(Library, MotorsFollowAServiceAndNoPeriodMakesAHeapCall) {
  start();
  test::WireService service({.domain = domain_.id(), .machine = "lai"});
  ASSERT_TRUE(service.enable());
  double x = 0;
  for (int n = 0; n < 400; ++n) service.period(0x0F, x += 0.01, kSetpointEnabled);
  for (int n = 0; n < 50; ++n) service.period(0x0F, x, kSetpointEnabled);
  EXPECT_NEAR(service.feedback.position[0], x, 1e-9);
  EXPECT_EQ(service.feedback.service_id, 7U);
  EXPECT_EQ(service.feedback.joint_mask, 0x1FU);
  stop();
  EXPECT_NEAR(motors_.outputs[0].position, x, 1e-9);
  EXPECT_EQ(calls_, "");
  EXPECT_EQ(drives_->counts().reports_lost, 0U);
  EXPECT_GT(drives_->counts().setpoints, 400U);
  EXPECT_TRUE(is_said("operation enabled"));
}

TEST_F(Library, TheStopInputAndAFaultAreReported) {
  motors_.is_stop_open = true;
  start();
  test::WireService service({.domain = domain_.id(), .machine = "lai"});
  ASSERT_TRUE(service.enable());
  EXPECT_TRUE(service.feedback.is_emergency_stop);
  stop();
  motors_.readings[2].error = 0x2310;
  for (int n = 0; n < 5; ++n) drives_->work();
  EXPECT_EQ(drives_->status(2).error, 0x2310);
  EXPECT_STREQ(drives_->status(2).state, "fault");
  EXPECT_TRUE(is_said("fault (error 2310h)"));
}

TEST_F(Library, AnotherServiceIsDroppedCountedAndNamed) {
  start();
  const dds::ParticipantOptions lai{.domain = domain_.id(), .machine = "lai"};
  test::WireService service(lai), other(lai, 8);
  ASSERT_TRUE(service.enable());
  for (int n = 0; n < 600; ++n) {
    service.period(0x0F, 0, kSetpointEnabled);
    other.period(0x0F, 50, kSetpointEnabled);
  }
  EXPECT_EQ(service.feedback.position[0], 0);
  EXPECT_EQ(service.feedback.service_id, 7U);
  stop();
  EXPECT_GT(drives_->counts().dropped, 100U);
  EXPECT_TRUE(is_said("are dropped: the drives obey"));
}

TEST_F(Library, AServiceThatDiesIsBridgedThenTheDrivesRampDownAndAreFree) {
  options_.bridge_cycles = 20;
  start();
  std::optional<test::WireService> service;
  service.emplace(dds::ParticipantOptions{.domain = domain_.id(), .machine = "lai"});
  ASSERT_TRUE(service->enable());
  service->period(0x0F, 0, kSetpointEnabled);
  service.reset();
  EXPECT_TRUE(is_said("fault (error 8700h)"));
  test::WireService next({.domain = domain_.id(), .machine = "lai"}, 9);
  for (int n = 0; n < 5000 && next.feedback.service_id != 9; ++n) next.period(0x06, 0, 0);
  EXPECT_EQ(next.feedback.service_id, 9U);
}

TEST_F(Library, ActionsAreDoneOneAfterTheOtherOrRefusedWithTheReason) {
  std::vector<std::string> done;
  options_.act = [&](const Action& action) {
    done.push_back(action.words);
    return std::string(action.kind == ActionKind::kToolChange ? "no such tool" : "");
  };
  start();
  test::WireService service({.domain = domain_.id(), .machine = "lai"});
  ASSERT_TRUE(service.enable());
  dds::Action action;
  action.kind = meridian::ActionKind::kSpindleClockwise;
  action.value = 8000;
  action.id = 1;
  (void)service.actions.write(action);
  action.kind = meridian::ActionKind::kToolChange;
  action.value = 99;
  action.id = 2;
  (void)service.actions.write(action);
  std::vector<dds::ActionDone> answers;
  for (int n = 0; n < 5000 && answers.size() < 2; ++n) {
    service.period(0x0F, 0, kSetpointEnabled);
    for (dds::ActionDone one; service.actions_done.take(one);) answers.push_back(one);
  }
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_TRUE(answers[0].is_done);
  EXPECT_FALSE(answers[1].is_done);
  EXPECT_EQ(answers[1].text, "no such tool");
  EXPECT_EQ(done.front(), "spindle clockwise 8000 rev/min");
}

TEST_F(Library, DrivesThatSomebodyElseReportsAreNotStartedTwice) {
  start();
  test::ScriptedHardware motors;
  try {
    const Drives second(options_, motors);
    ADD_FAILURE() << "both report the same joints";
  } catch (const DriveError& error) {
    EXPECT_NE(std::string(error.what()).find("are reported by"), std::string::npos) << error.what();
  }
  options_.is_beside_others = true;
  EXPECT_NO_THROW(Drives(options_, motors));
}

TEST_F(Library, RunKeepsTheCycleTimeUntilItIsStopped) {
  drives_.emplace(options_, motors_);
  int asked = 0;
  drives_->run([&] { return ++asked > 50; });
  EXPECT_EQ(drives_->counts().periods, 50U);
  EXPECT_GE(motors_.exchanged_s, 50e-9 * static_cast<double>(drives_->cycle_ns()) * (1 - 1e-9));
}

TEST_F(Library, RunLeavesTheThreadInTheClassThatItHad) {
  options_.priority = 2;
  drives_.emplace(options_, motors_);
  sched_param before{.sched_priority = 1};
  if (::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &before) != 0)
    GTEST_SKIP() << "no right to the real-time class here";
  sched_param within{}, after{};
  int policy = SCHED_OTHER;
  drives_->run([&] {
    ::pthread_getschedparam(::pthread_self(), &policy, &within);
    return true;
  });
  ::pthread_getschedparam(::pthread_self(), &policy, &after);
  const sched_param normal{};
  ::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &normal);
  EXPECT_EQ(within.sched_priority, 2);
  EXPECT_EQ(policy, SCHED_FIFO);
  EXPECT_EQ(after.sched_priority, 1);
}

}  // namespace
}  // namespace meridian::drive
