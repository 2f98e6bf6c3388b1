// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <signal.h>

#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "integration/plant.hpp"
#include "service/protocol/frame_sum.hpp"
#include "service/protocol/limits_sum.hpp"
#include "service/protocol/operator/machine_finder.hpp"

namespace meridian::test {

inline constexpr milliseconds kToolPatience{8000};

/// A word about work frames.
[[nodiscard]] inline FrameOrder order_of(FrameWord word, int number, double x_mm = 0,
                                         const char* name = "") {
  FrameOrder order;
  order.word = word;
  order.frame.number = static_cast<std::uint8_t>(number);
  order.frame.origin_mm = {x_mm, 0, 0};
  std::strncpy(order.frame.name.data(), name, kFrameNameChars);
  return order;
}

/// Somebody who changes the set-up, quoting the status that the test names.
class SetUpOperator {
 public:
  SetUpOperator(Plant& plant, std::uint64_t id)
      : plant_(plant), commands_(plant.participant()), replies_(plant.participant()), id_(id) {}

  /// Says it and waits for nothing.
  void say(const FrameOrder& order, const dds::Status& seen) {
    request_ = {};
    request_.verb = Verb::kFrame;
    request_.frame = order;
    send(seen);
  }
  /// The same of a tool table, made from the one that `seen` reports.
  void say(const std::string& tools, const dds::Status& seen) {
    request_ = {};
    request_.verb = Verb::kTool;
    request_.tool_file = tools;
    request_.tools_seen = seen.tools;
    send(seen);
  }
  /// The same of soft limits.
  void say(const LimitsOrder& order, const dds::Status& seen) {
    request_ = {};
    request_.verb = Verb::kLimits;
    request_.limits = order;
    send(seen);
  }
  /// The same once more, to the letter.
  void repeat() { (void)commands_.write(request_); }
  /// The answer to what was said last.
  [[nodiscard]] std::optional<dds::Reply> answer(milliseconds patience = milliseconds(5000)) {
    dds::Reply reply;
    const bool is_there = eventually(
        [&] {
          while (replies_.take(reply)) {
            if (reply.operator_id == id_ && reply.request == count_) return true;
          }
          return false;
        },
        patience);
    return is_there ? std::optional(reply) : std::nullopt;
  }
  /// Says it until it is not refused as stale.
  template <class Order>
  [[nodiscard]] dds::Reply ask(const Order& order) {
    std::optional<dds::Reply> reply;
    (void)eventually([&] {
      say(order, plant_.status());
      reply = answer();
      return reply && reply->refusal != Refusal::kStale;
    });
    EXPECT_TRUE(reply) << plant_.standing();
    return reply.value_or(dds::Reply{});
  }

 private:
  void send(const dds::Status& seen) {
    (void)eventually(
        [this] { return commands_.matched_readers() > 0 && replies_.matched_writers() > 0; });
    request_.request = ++count_;
    request_.operator_id = id_;
    request_.operator_name = "anna";
    request_.epoch_seen = seen.epoch;
    request_.status_seen = seen.status_sequence;
    request_.service_id_seen = seen.service_id;
    (void)commands_.write(request_);
  }

  Plant& plant_;
  dds::Writer<dds::CommandRequest> commands_;
  dds::Reader<dds::Reply> replies_;
  dds::CommandRequest request_;
  std::uint64_t id_, count_ = 0;
};

/// A tool table with tool 2 so long.
[[nodiscard]] inline std::string tools_of(double length_mm) {
  return "[[tool]]\nnumber = 2\nlength_mm = " + std::to_string(length_mm) + "\nradius_mm = 3\n";
}

/// What the machine topic holds now.
[[nodiscard]] inline dds::MachineInfo reported_by(const Plant& plant) {
  const auto found = stream::find_machines(static_cast<std::uint32_t>(std::stoul(plant.domain())),
                                           "lai", milliseconds(15'000));
  EXPECT_EQ(found.size(), 1U);
  return found.empty() ? dds::MachineInfo{} : found.front();
}

/// `meridian` with `words`, in the domain of the plant.
[[nodiscard]] inline Process tool(const Plant& plant, std::vector<std::string> words) {
  static int count = 0;
  words.insert(words.begin(), "meridian");
  words.insert(words.end(), {"--domain", plant.domain()});
  return Process(words, plant.folder() / ("tool" + std::to_string(++count) + ".log"));
}

/// `refused` asks for a change of the set-up that has to be refused for that reason: here while a
/// program is loaded, running and held.
template <class Refused>
void expect_refused_beside_a_program(Plant& plant, const Refused& refused) {
  plant.start_service();
  plant.start_drives();
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  ASSERT_TRUE(plant.stream(small_program(60, 600, 5), [&](const stream::Station& station) {
    return station.state() == stream::StationState::kComplete &&
           plant.status().state == State::kLoaded;
  })) << plant.station().message();
  refused(Refusal::kProgramPresent);
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kStart));
  ASSERT_TRUE(plant.wait_for(State::kRunning)) << plant.standing();
  refused(Refusal::kWrongState);
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kHold));
  ASSERT_TRUE(plant.wait_for(State::kHeld)) << plant.standing();
  refused(Refusal::kProgramPresent);
}

/// The part, enabled, streamed, cut to its end.
inline void cut(Plant& plant, const std::string& part) {
  ASSERT_TRUE(plant.enable()) << plant.service().said();
  Process station({"meridian", "stream", part, "--domain", plant.domain(), "--wait-end"},
                  plant.folder() / "station.log");
  ASSERT_TRUE(plant.wait_for(State::kLoaded)) << station.said() << plant.service().said();
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kStart));
  ASSERT_EQ(station.wait(milliseconds(60'000)), 0) << station.said() << plant.service().said();
  ASSERT_NO_FATAL_FAILURE(plant.must(Verb::kDisable));
  ASSERT_TRUE(plant.wait_for(State::kOff)) << plant.standing();
}

inline void end_service(Plant& plant) {
  plant.service().send_signal(SIGTERM);
  ASSERT_EQ(plant.service().wait(kToolPatience), 0) << plant.service().said();
}

/// A station that names the set-up which its program was checked with.
class SetUpStation {
 public:
  explicit SetUpStation(Plant& plant)
      : requests_(plant.participant()), credits_(plant.participant()) {}

  [[nodiscard]] bool is_connected() {
    return eventually(
        [&] { return requests_.matched_readers() > 0 && credits_.matched_writers() > 0; },
        kToolPatience);
  }
  /// What a session names of its set-up, as sums; 0: not named.
  struct Checked {
    std::uint64_t frame = 0, tools = 0, limits = 0;
  };
  /// What the service answers to a session that was checked so.
  [[nodiscard]] dds::Credit open(std::uint64_t session, const Checked& checked) {
    dds::SessionRequest request;
    request.session = session;
    request.station = "cam";
    request.program = "part.apt";
    request.frame = checked.frame;
    request.tools = checked.tools;
    request.limits = checked.limits;
    (void)requests_.write(request);
    dds::Credit credit;
    EXPECT_TRUE(eventually([&] { return credits_.take(credit) && credit.session == session; }));
    return credit;
  }

 private:
  dds::Writer<dds::SessionRequest> requests_;
  dds::Reader<dds::Credit> credits_;
};

/// `meridian ctl limits` with these words.
[[nodiscard]] inline Process ctl_limits(const Plant& plant, std::vector<std::string> words) {
  words.insert(words.begin(), {"ctl", "limits"});
  return tool(plant, words);
}

/// A move of the joints is refused for `why`: nothing moves, and the machine is free.
inline void expect_move_refused(Plant& plant, const std::string& joints, const std::string& why) {
  const JointVector before = plant.status().joints;
  Process move = tool(plant, {"ctl", "move", "--joints", joints, "--feed", "3000"});
  EXPECT_NE(move.wait(milliseconds(20'000)), 0) << move.said();
  EXPECT_NE(move.said().find(why), std::string::npos) << move.said();
  EXPECT_EQ(plant.status().joints, before);
  EXPECT_TRUE(plant.runs_until([](const dds::Status& status) {
    return status.state == State::kReady && status.session == 0;
  })) << plant.standing();
}

/// A move of joint b3 to `b3_mm` is made.
inline void expect_moved(Plant& plant, int b3_mm) {
  Process move =
      tool(plant, {"ctl", "move", "--joints", "b3=" + std::to_string(b3_mm), "--feed", "3000"});
  EXPECT_EQ(move.wait(milliseconds(20'000)), 0) << move.said();
  EXPECT_NEAR(plant.status().joints[0], b3_mm, 1e-9);
}

/// The service ends, and the one behind it has the soft limits `wanted`; the list shows `row`.
inline void expect_limits_outlive_the_service(Plant& plant, const SoftLimits& wanted,
                                              const std::string& row) {
  ASSERT_NO_FATAL_FAILURE(end_service(plant));
  plant.start_service();
  EXPECT_EQ(reported_by(plant).soft_limits, wanted);
  EXPECT_EQ(plant.status().limits, stream::limits_sum(wanted));
  Process list = ctl_limits(plant, {"list"});
  ASSERT_EQ(list.wait(kToolPatience), 0) << list.said();
  EXPECT_NE(list.said().find(row), std::string::npos) << list.said();
}

/// `meridian stream` refuses the part for `why`, with its line, before anything moves.
inline void expect_refused_by_preflight(Plant& plant, const std::string& part,
                                        const std::string& why) {
  Process stream = tool(plant, {"stream", part});
  EXPECT_EQ(stream.wait(kToolPatience), 3) << stream.said();
  EXPECT_NE(stream.said().find(why), std::string::npos) << stream.said();
  EXPECT_NE(stream.said().find("part.apt:"), std::string::npos) << stream.said();
}

}  // namespace meridian::test
