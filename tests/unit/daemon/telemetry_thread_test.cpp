// SPDX-License-Identifier: Apache-2.0
#include "service/daemon/threads/telemetry_thread.hpp"

#include <gtest/gtest.h>
#include <spdlog/sinks/null_sink.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <thread>

#include "service/transport/reader.hpp"
#include "support/machines.hpp"
#include "support/private_domain.hpp"

namespace meridian::interpolator {
namespace {

class TelemetryThreadTest : public testing::Test {
 protected:
  ~TelemetryThreadTest() override {
    std::filesystem::remove(path_);
    std::filesystem::remove(record::operator_events_path(path_.string()));
  }

  void emit(EventCode code, std::uint64_t a, std::uint64_t b = 0) {
    Event event;
    event.code = code;
    event.cycle = 7;
    event.a = a;
    event.b = b;
    EXPECT_TRUE(ports_->telemetry_events.try_push(event));
  }
  /// The next cycle's record.
  void record(State state) {
    CycleRecord record;
    record.setpoint.cycle = ++cycle_;
    record.setpoint.epoch = state == State::kFault ? 2 : 1;
    record.state = state;
    EXPECT_TRUE(ports_->records.try_push(record));
  }
  /// A station asks for a session, and intake takes it in.
  void open_session() {
    dds::Writer<dds::SessionRequest> station(participant_);
    dds::SessionRequest request;
    request.session = 5;
    request.station = "cam";
    request.program = "part.apt";
    (void)station.write(request);
    std::thread taking([this] { intake_->run(); });
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (intake_->view().session == 0 && std::chrono::steady_clock::now() < patience) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ports_->is_stopping = true;
    taking.join();
  }
  /// Lets the thread drain what was emitted, and end; the status is its last.
  void run() {
    dds::Reader<dds::Status> statuses(participant_);
    TelemetryThread thread(participant_, model_, service_, 1, dds::RealtimeMode::kBestEffort,
                           *intake_, clock_, recorder_, journal_, flight_, log_, *ports_);
    ports_->is_stopping = true;
    thread.run();
    while (statuses.take(status_)) {
    }
  }
  /// The planner has laid out how a program of `epoch` is approached, and the machine is Loaded.
  void plan_approach(std::uint16_t epoch) {
    CycleView view;
    view.cycles_run = 1;
    view.epoch = epoch;
    view.is_dry_run = true;
    view.record.state = State::kLoaded;
    ports_->telemetry_view.store(view);
    emit(EventCode::kStateChanged, static_cast<std::uint64_t>(State::kLoaded));
    Approach approach;
    approach.is_planned = true;
    approach.epoch = epoch;
    approach.line = 12;
    ports_->approach_for_status.store(approach);
  }
  /// Whether a message comes that ends with `words`, while the thread works on.
  [[nodiscard]] bool comes(dds::Reader<dds::Status>& statuses, const std::string& words,
                           std::chrono::milliseconds patience = std::chrono::seconds(10)) {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (std::chrono::steady_clock::now() < end) {
      while (statuses.take(status_)) {
        if (status_.message.ends_with(words)) return true;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  /// What the file of events holds afterwards.
  [[nodiscard]] std::string events() {
    recorder_.stop();
    recorder_.run();
    std::ostringstream text;
    text << std::ifstream(record::operator_events_path(path_.string())).rdbuf();
    return text.str();
  }

  const std::filesystem::path path_ = std::filesystem::temp_directory_path() /
                                      ("meridian-telemetry-" + std::to_string(::getpid()) + ".csv");
  const MachineModel model_ = test::lai_machine();
  const support::PrivateDomain domain_;
  dds::Participant participant_{{.domain = domain_.id(), .machine = model_.name}};
  const std::unique_ptr<Ports> ports_ = std::make_unique<Ports>();
  config::ServiceConfig service_;
  const stream::ToolLengths tools_;
  const std::unique_ptr<Intake> intake_ =
      std::make_unique<Intake>(participant_, model_, tools_, service_, 1, *ports_);
  StatusClock clock_;
  telemetry::Recorder recorder_{path_.string(), model_};
  const std::shared_ptr<spdlog::logger> log_ =
      std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::null_sink_mt>());
  telemetry::Journal journal_{"", model_.name};
  telemetry::FlightRecorder flight_{{}, model_, log_};
  dds::Status status_;
  std::uint64_t cycle_ = 0;
};

TEST_F(TelemetryThreadTest, PublishesThePlanTimeAheadWhereAProgramMovesAndWhereItRests) {
  MotionWriter planner(ports_->motion);
  ASSERT_TRUE(planner.stage(TimePiece{}));
  planner.publish();
  ports_->planned_s = 5;
  for (const State state : {State::kRunning, State::kHeld, State::kStarved, State::kStepping}) {
    CycleView view;
    view.record.state = state;
    view.record.plan_time_s = 3;
    ports_->telemetry_view.store(view);
    run();
    EXPECT_EQ(status_.planned_s, 2) << name_of(state);
  }
}

/// Events come through the commands thread, up to 2 ms after the state.
TEST_F(TelemetryThreadTest, NoStatusHasAStateAheadOfTheAlarmThatLedToIt) {
  dds::Reader<dds::Status> statuses(participant_);
  TelemetryThread thread(participant_, model_, service_, 1, dds::RealtimeMode::kBestEffort,
                         *intake_, clock_, recorder_, journal_, flight_, log_, *ports_);
  std::thread running([&thread] { thread.run(); });
  const auto show = [this](State state) {
    CycleView view;
    view.cycles_run = 1;
    view.record.state = state;
    ports_->telemetry_view.store(view);
    std::this_thread::sleep_for(std::chrono::milliseconds(40));
  };
  show(State::kHoming);
  emit(EventCode::kStateChanged, static_cast<std::uint64_t>(State::kHoming));
  show(State::kReady);
  emit(EventCode::kAlarm, static_cast<std::uint64_t>(Alarm::kHomingFailed));
  emit(EventCode::kStateChanged, static_cast<std::uint64_t>(State::kReady),
       static_cast<std::uint64_t>(State::kHoming));
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (status_.state != State::kReady && std::chrono::steady_clock::now() < end) {
    if (!statuses.take(status_)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(status_.state, State::kReady);
  EXPECT_EQ(status_.alarm, Alarm::kHomingFailed);
  ports_->is_stopping = true;
  running.join();
}

TEST_F(TelemetryThreadTest, RecordsWhatWasDone) {
  emit(EventCode::kAccepted, 0, static_cast<std::uint64_t>(Verb::kHold));
  run();
  EXPECT_EQ(events(), "cycle,verb,argument,block,span\n7,hold,0\n");
}

TEST_F(TelemetryThreadTest, RecordsThatOptionalStopsStopWhereTheServiceBeginsSo) {
  service_.optional_stop = true;
  emit(EventCode::kAccepted, 0, static_cast<std::uint64_t>(Verb::kStart));
  run();
  EXPECT_EQ(events(), "cycle,verb,argument,block,span\n0,optional_stop,1\n7,start,0\n");
}

TEST_F(TelemetryThreadTest, RecordsWhatWasLostOnTheWay) {
  emit(EventCode::kAccepted, 0, static_cast<std::uint64_t>(Verb::kHold));
  ports_->events_overrun = 2;
  run();
  EXPECT_EQ(events(), "cycle,verb,argument,block,span\n7,hold,0\nincomplete\n");
}

TEST_F(TelemetryThreadTest, NamesTheGroupThatIsSilentWithTheDriveThatIsMissed) {
  DriveWords words;
  words.oldest_group = 4;
  words.oldest_mask = 0b11000;
  ports_->drive_words_for_status.store(words);
  emit(EventCode::kAlarm, static_cast<std::uint64_t>(Alarm::kFeedbackLost), 3);
  run();
  EXPECT_EQ(status_.message.rfind("no feedback from drive theta1; check", 0), 0U);
  EXPECT_NE(status_.message.find("; drive group 4 is silent: theta1, theta2"), std::string::npos)
      << status_.message;
}

TEST_F(TelemetryThreadTest, SaysThatAStopInputIsMissed) {
  DriveWords words;
  words.oldest_group = 9;
  ports_->drive_words_for_status.store(words);
  emit(EventCode::kAlarm, static_cast<std::uint64_t>(Alarm::kFeedbackLost), kNoJoint);
  run();
  EXPECT_EQ(status_.message.rfind("no feedback from what has the stop input; check", 0), 0U);
  EXPECT_NE(status_.message.find("; drive group 9 is silent"), std::string::npos)
      << status_.message;
}

TEST_F(TelemetryThreadTest, SaysWhatASessionDidBehindTheAlarmThatHoldsTheProgram) {
  open_session();
  emit(EventCode::kAlarm, static_cast<std::uint64_t>(Alarm::kActionFailed));
  run();
  EXPECT_EQ(status_.alarm, Alarm::kActionFailed);
  EXPECT_NE(status_.message.find("action"), std::string::npos) << status_.message;
  EXPECT_NE(status_.message.find("; station cam opened part.apt"), std::string::npos)
      << status_.message;
}

TEST_F(TelemetryThreadTest, SaysWhatASessionDidAloneWhereThereIsNoAlarm) {
  open_session();
  run();
  EXPECT_EQ(status_.message, "station cam opened part.apt");
}

TEST_F(TelemetryThreadTest, SaysHowTheProgramWentBehindTheAlarmThatEndedIt) {
  for (const State state : {State::kApproaching, State::kFaultStop, State::kFault}) record(state);
  emit(EventCode::kAlarm, static_cast<std::uint64_t>(Alarm::kEmergencyStop));
  run();
  EXPECT_EQ(status_.message,
            "emergency stop input is open; release it, then reset; the program ended by a fault in "
            "block 0, line 0: 0 blocks in 0.0 s");
}

TEST_F(TelemetryThreadTest, ForgetsTheAlarmWithTheFaultThoughNoStatusSaysOff) {
  const auto change = [this](State from, State to) {
    emit(EventCode::kStateChanged, static_cast<std::uint64_t>(to),
         static_cast<std::uint64_t>(from));
    record(to);
  };
  change(State::kReady, State::kFaultStop);
  emit(EventCode::kAlarm, static_cast<std::uint64_t>(Alarm::kEmergencyStop));
  change(State::kFaultStop, State::kFault);
  change(State::kFault, State::kOff);
  change(State::kOff, State::kEnabling);
  run();
  EXPECT_EQ(status_.alarm, Alarm::kNone);
}

TEST_F(TelemetryThreadTest, SaysHowTheProgramWentNotThatItsSessionIsThere) {
  open_session();
  for (const State state : {State::kApproaching, State::kRunning, State::kReady}) record(state);
  run();
  EXPECT_EQ(status_.message, "the program ran to its end: 0 blocks in 0.0 s");
}

const std::string kApproachWords = "approach to line 12: none, the tool is there";

TEST_F(TelemetryThreadTest, KeepsTheApproachInTheStatusWhateverTheStationDoesAndPublishesItAtOnce) {
  service_.status_rate_hz = 0.05;  // by itself not again before this test is over
  dds::Reader<dds::Status> statuses(participant_);
  CycleView view;
  view.cycles_run = 1;
  view.record.state = State::kLoaded;
  ports_->telemetry_view.store(view);
  TelemetryThread thread(participant_, model_, service_, 1, dds::RealtimeMode::kBestEffort,
                         *intake_, clock_, recorder_, journal_, flight_, log_, *ports_);
  std::thread running([&] { thread.run(); });
  EXPECT_TRUE(comes(statuses, "")) << "the first";
  plan_approach(1);
  EXPECT_TRUE(comes(statuses, kApproachWords));
  open_session();  // the thread ends behind it
  running.join();
  EXPECT_TRUE(comes(statuses, "station cam opened part.apt; " + kApproachWords)) << status_.message;
}

/// Words that quote an older status are overtaken.
TEST_F(TelemetryThreadTest, PublishesAtOnceWhatTheMachineMadeOfAStop) {
  service_.status_rate_hz = 1;
  CycleView view;
  view.cycles_run = 1;
  ports_->telemetry_view.store(view);
  dds::Reader<dds::Status> statuses(participant_);
  TelemetryThread thread(participant_, model_, service_, 1, dds::RealtimeMode::kBestEffort,
                         *intake_, clock_, recorder_, journal_, flight_, log_, *ports_);
  std::thread running([&] { thread.run(); });
  EXPECT_TRUE(comes(statuses, "")) << "the first";
  const std::int64_t first_ns = status_.time_ns;
  emit(EventCode::kRefused, 3, static_cast<std::uint64_t>(Verb::kAbort));
  EXPECT_TRUE(comes(statuses, ""));
  EXPECT_LT(status_.time_ns - first_ns, 1'000'000'000) << "a period";
  ports_->is_stopping = true;
  running.join();
}

TEST_F(TelemetryThreadTest, PublishesNoApproachOfAProgramThatIsVoid) {
  for (const std::uint64_t epoch : {1U, 2U}) {
    plan_approach(1);
    status_.message.clear();
    dds::Reader<dds::Status> statuses(participant_);
    TelemetryThread thread(participant_, model_, service_, 1, dds::RealtimeMode::kBestEffort,
                           *intake_, clock_, recorder_, journal_, flight_, log_, *ports_);
    ports_->is_stopping = false;
    std::thread running([&] { thread.run(); });
    EXPECT_TRUE(comes(statuses, kApproachWords));
    emit(EventCode::kAlarm, static_cast<std::uint64_t>(Alarm::kActionFailed));
    emit(EventCode::kStateChanged, static_cast<std::uint64_t>(State::kReady),
         static_cast<std::uint64_t>(State::kHeld));
    emit(EventCode::kEpochAdvanced, epoch);
    emit(EventCode::kStateChanged, static_cast<std::uint64_t>(State::kApproaching),
         static_cast<std::uint64_t>(State::kLoaded));
    ports_->is_stopping = true;
    running.join();
    while (statuses.take(status_)) continue;
    EXPECT_EQ(status_.message == kApproachWords, epoch == 1) << status_.message;
  }
}

TEST_F(TelemetryThreadTest, NotesNothingOfADryRunWhoseBeginWasLostAmongTheEvents) {
  const std::filesystem::path folder = path_.string() + ".journal";
  for (const bool is_dry : {false, true}) {
    int written = 0;
    telemetry::Journal journal(folder, model_.name,
                               [&](const auto&, const auto&) { return ++written, 0; });
    CycleView view;
    view.cycles_run = 1;
    view.is_dry_run = is_dry;
    ports_->telemetry_view.store(view);
    dds::Reader<dds::Status> statuses(participant_);
    TelemetryThread thread(participant_, model_, service_, 1, dds::RealtimeMode::kBestEffort,
                           *intake_, clock_, recorder_, journal, flight_, log_, *ports_);
    ports_->is_stopping = false;
    std::thread running([&] { thread.run(); });
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (!statuses.take(status_) && std::chrono::steady_clock::now() < patience) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    emit(EventCode::kBlockStarted, 3);
    emit(EventCode::kStateChanged, static_cast<std::uint64_t>(State::kApproaching));
    ports_->is_stopping = true;
    running.join();
    journal.stop();
    journal.run([](const std::string&) {});
    EXPECT_EQ(status_.is_dry_run, is_dry);
    EXPECT_EQ(written > 0, !is_dry);
  }
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace meridian::interpolator
