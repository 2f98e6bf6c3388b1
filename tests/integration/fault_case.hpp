// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "integration/checked_part.hpp"
#include "integration/fault_kinds.hpp"
#include "integration/plant.hpp"
#include "integration/witness.hpp"
#include "service/host/soak/watch/host_watch.hpp"

namespace meridian::test {

class SetUpWords;

/// One fault in one phase, done to station, service and drives as processes: what comes of it, the
/// way back, the rest of the program, and the verdict on what was recorded.
class FaultCase {
 public:
  FaultCase(const LiveFault& fault, const Phase& phase);
  ~FaultCase();
  FaultCase(const FaultCase&) = delete;
  FaultCase& operator=(const FaultCase&) = delete;

  /// Runs all of it. Failures are those of GoogleTest.
  void run();
  /// What came of it, as in the table; valid behind run().
  [[nodiscard]] const std::string& letter() const noexcept { return letter_; }
  /// What the host did meanwhile that may have failed it; empty: nothing.
  [[nodiscard]] std::string host_said() const;

 private:
  void set_up();
  void start_station(std::uint32_t from_line);
  void start_program(std::uint32_t from_line);
  void reach_phase();
  void provoke();
  void send_rubbish();
  void kill_service();
  void start_attacker();
  void restart_killed_service();
  void break_off_recovery(std::uint32_t line);
  void enable_again();
  void stop_station();

  [[nodiscard]] std::string wait_for_outcome();
  [[nodiscard]] bool waits_for_fault(milliseconds patience);
  void mend();
  void go_on();              ///< the machine did not stop for it
  void recover_and_go_on();  ///< from Fault or a new service
  void replace_station();
  [[nodiscard]] std::uint32_t reported_by_journal();
  [[nodiscard]] std::string transition() const;
  void resume_held();
  void run_to_end(PartCut& cut, bool is_kept_waiting = false);
  void check_all();

  [[nodiscard]] bool has_ended() { return station_ && station_->wait(milliseconds(0)).has_value(); }
  [[nodiscard]] std::uint32_t fed_line() const;
  [[nodiscard]] bool is_piped() const noexcept;
  [[nodiscard]] bool ends_service() const noexcept;
  [[nodiscard]] std::string story();
  void expect_provoked();
  void expect_joint();

  static constexpr milliseconds kLong{20'000};

  const LiveFault& fault_;
  const Phase& phase_;
  const FaultPart part_;
  soak::HostWatch host_;
  std::unique_ptr<Hosts> hosts_;  ///< outlives what runs on them
  std::unique_ptr<Plant> plant_;
  std::unique_ptr<Witness> witness_;
  std::unique_ptr<dds::Reader<dds::Action>> actions_;
  std::unique_ptr<SetUpWords> set_up_words_;
  InputPipe console_;
  std::unique_ptr<InputPipe> source_;
  std::unique_ptr<Process> station_, attacker_;
  int unread_log_ = -1;  ///< the service's log as a pipe
  std::string part_file_, letter_;
  std::vector<std::string> service_words_;
  int stations_ = 0;

  PartCut first_{};                  ///< up to where the program was broken off, or all of it
  std::optional<PartCut> second_;    ///< the rest
  std::uint64_t lost_before_ = 0;    ///< cycles that this service had lost before the rest
  std::uint32_t line_long_ago_ = 0;  ///< that was cut when a journal may have been written last
  bool has_program_ = false;         ///< one was started when it was broken off
};

}  // namespace meridian::test
