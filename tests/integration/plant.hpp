// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "integration/process.hpp"
#include "service/protocol/station/station.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/followed.hpp"
#include "service/transport/reader.hpp"
#include "service/transport/writer.hpp"
#include "support/private_domain.hpp"

namespace meridian::test {

/// Service and drives as processes on a private domain, with the test as operator and station.
class Plant {
 public:
  /// `machine`: one of deploy/machines, but for its approach, which takes no time from a test,
  /// and for exact stop, so that the tests know where their programs rest.
  explicit Plant(std::string machine = "lai");
  /// In the DDS domain of `other`.
  Plant(std::string machine, const Plant& other);
  ~Plant();

  /// Runs service and drives with another cycle time.
  void set_cycle_us(int cycle_us);
  /// Changes their machine file: what matches the first becomes the second, at least once each.
  void change_machine(const std::vector<std::pair<std::string, std::string>>& changes);

  /// Start meridiand (best effort, recording and flight recorder on) or the drives, `more` on the
  /// command line. The drives read `console` where one is given.
  Process& start_service(const std::vector<std::string>& more = {});
  Process& start_drives(const std::vector<std::string>& more = {},
                        const InputPipe* console = nullptr);
  [[nodiscard]] std::unique_ptr<Process> another_service();

  /// The newest status; waits for a first one.
  [[nodiscard]] const dds::Status& status();
  [[nodiscard]] bool wait_for(State state, milliseconds patience = milliseconds(8000));
  /// Waits until `condition` is true of the status; false as soon as a Fault is in its way.
  [[nodiscard]] bool runs_until(const std::function<bool(const dds::Status&)>& condition,
                                milliseconds patience = milliseconds(8000));
  /// How the machine stands, for who waited in vain: state, alarm, block and message.
  [[nodiscard]] std::string standing();
  /// Says a verb as an operator who has just looked; nothing where no reply came.
  [[nodiscard]] std::optional<dds::Reply> say(Verb verb, double argument = 0);
  [[nodiscard]] std::optional<dds::Reply> say_having_seen(Verb verb, const dds::Status& seen,
                                                          double argument = 0);
  /// Says it until it is not refused as stale, nor as `passing`: what is refused does nothing. It
  /// must be accepted then: call under ASSERT_NO_FATAL_FAILURE.
  void must(Verb verb, double argument = 0, Refusal passing = Refusal::kStale);
  [[nodiscard]] bool enable();

  /// Streams `blocks` and goes on until `until` is true of the station, or time is up.
  [[nodiscard]] bool stream(const std::vector<ClBlock>& blocks,
                            const std::function<bool(const stream::Station&)>& until,
                            milliseconds patience = milliseconds(8000));
  /// Goes on with the station of the last stream().
  [[nodiscard]] bool stream_on(const std::function<bool(const stream::Station&)>& until,
                               milliseconds patience);
  [[nodiscard]] const stream::Station& station() const { return *station_; }

  [[nodiscard]] std::filesystem::path recording() const { return folder_ / "recording.csv"; }
  /// Where the service keeps its journal.
  [[nodiscard]] std::filesystem::path state() const { return folder_ / "state"; }
  /// Where the flight recorder writes, into a folder of the machine.
  [[nodiscard]] std::filesystem::path faults() const { return state() / "faults"; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  /// The machine file that service and drives are started with.
  [[nodiscard]] const std::string& machine() const { return machine_file_; }
  [[nodiscard]] std::string domain() const { return std::to_string(domain_->id()); }
  [[nodiscard]] dds::Participant& participant() { return participant_; }
  [[nodiscard]] Process& service() { return *service_; }
  [[nodiscard]] Process& drives() { return *drives_; }

 private:
  Plant(std::string machine, std::shared_ptr<support::PrivateDomain> domain);
  void look();

  std::string machine_, machine_file_;
  std::shared_ptr<support::PrivateDomain> domain_;
  std::filesystem::path folder_;
  dds::Participant participant_;
  dds::Reader<dds::Status> statuses_;
  dds::Followed<dds::Status> followed_;
  dds::Writer<dds::CommandRequest> commands_;
  dds::Reader<dds::Reply> replies_;
  dds::Writer<dds::SessionRequest> requests_;
  dds::Writer<dds::Batch> batches_;
  dds::Reader<dds::Credit> credits_;
  std::optional<dds::Status> status_;
  std::unique_ptr<stream::Station> station_;
  std::unique_ptr<Process> service_, drives_;
  std::uint64_t request_ = 0, session_ = 0;
};

/// A small five-axis program near home: zigzag cuts at `feed_mm_per_min` with tilting axis.
[[nodiscard]] std::vector<ClBlock> small_program(int blocks, double feed_mm_per_min,
                                                 double step_mm = 2,
                                                 const std::string& machine = "lai");

/// `blocks` from place `begin` on as statements of a CL file, without head and end.
[[nodiscard]] std::string cl_text(const std::vector<ClBlock>& blocks, std::size_t begin = 0);

[[nodiscard]] std::string machine_file(const std::string& machine = "lai");

}  // namespace meridian::test
