// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "meridian/cycle/state.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/followed.hpp"
#include "service/transport/participant.hpp"
#include "service/transport/reader.hpp"
#include "service/transport/waitset.hpp"
#include "service/transport/writer.hpp"

namespace meridian::stream {

/// What an operator saw when he said something: it is quoted, so that the service refuses what was
/// said to a machine that is another one by now.
struct Seen {
  std::uint64_t service_id = 0;
  std::uint16_t epoch = 0;
  std::uint64_t status_sequence = 0;
};

/// An operator's end of a machine: sees its status, asks for verbs and gets the answers. Every
/// request quotes the newest status that was seen when it was made, also where it is repeated, as
/// it is until it is answered: one that comes late is stale. The service answers a repetition
/// without acting twice; a stop it obeys each time.
///
/// An answer counts where it is the followed service's own, to this participant. Where several
/// services speak for the machine a stop counts as accepted only when each of them has accepted it:
/// which of them moves the drives is not known here. One thread.
class OperatorLink {
 public:
  using Milliseconds = std::chrono::milliseconds;

  /// Throws DdsError.
  OperatorLink(dds::Participant& participant, std::string operator_name);

  /// Takes what came and waits for more, at most `timeout`; true if there is a newer status.
  bool wait_for_status(Milliseconds timeout);
  /// The newest status; nothing where none was seen yet.
  [[nodiscard]] const std::optional<dds::Status>& status() const noexcept { return status_; }

  [[nodiscard]] std::uint64_t operator_id() const noexcept { return operator_id_; }
  /// Services that spoke for this machine a moment ago, the followed one too, in words.
  [[nodiscard]] std::vector<std::string> services() const;

  /// Asks for `verb` and returns the answer; nothing where the service stays silent. What is said
  /// for a dry run alone (may_be_dry(), argument 1) is said to a machine that reports one: of any
  /// other the answer is our own refusal, for services of before took the word for any other.
  /// `seen`: what the operator saw elsewhere, in place of the newest status that came in here.
  [[nodiscard]] std::optional<dds::Reply> ask(Verb verb, double argument, Milliseconds timeout,
                                              const std::optional<Seen>& seen = std::nullopt);
  /// Asks for a change of the set-up.
  [[nodiscard]] std::optional<dds::Reply> ask(const FrameOrder& order, Milliseconds timeout);
  [[nodiscard]] std::optional<dds::Reply> ask(const LimitsOrder& order, Milliseconds timeout);
  /// Asks for another tool table, as the text of its file; empty: the service's own file. It was
  /// made from the one that is known by `tools_seen`, 0: from none.
  [[nodiscard]] std::optional<dds::Reply> ask_for_tools(std::string text, std::uint64_t tools_seen,
                                                        Milliseconds timeout);

  /// Waits until the machine is in a state that `is_there` likes, after `reply` (the answer to the
  /// verb that is to lead there), and returns that state. `look` sees every status meanwhile.
  /// Nothing: time was up.
  [[nodiscard]] std::optional<State> wait_for_state(
      const dds::Reply& reply, const std::function<bool(State)>& is_there,
      const std::function<void(const dds::Status&)>& look, Milliseconds timeout);

 private:
  [[nodiscard]] std::optional<dds::Reply> ask(dds::CommandRequest request, Milliseconds timeout,
                                              const std::optional<Seen>& seen);
  /// A service that publishes a status for this machine.
  struct Service {
    std::uint64_t source = 0, participant = 0, service_id = 0;
    std::chrono::steady_clock::time_point seen;
    std::optional<dds::Reply> reply;  ///< to the request that waits
  };

  bool take_statuses();
  void see(const dds::Status& status, std::uint64_t source);
  /// Keeps the answers to the request that waits with the services that gave them.
  void take_replies(Verb verb);
  /// The answer to the request that waits, once there is one.
  [[nodiscard]] std::optional<dds::Reply> answer(Verb verb) const;
  /// Our own answer to `request`, which was not sent.
  [[nodiscard]] dds::Reply refuse_as_not_dry(const dds::CommandRequest& request) const;

  std::string name_;
  dds::Participant& participant_;
  std::uint64_t participant_number_;
  std::uint64_t operator_id_;
  std::chrono::steady_clock::time_point made_ = std::chrono::steady_clock::now();
  std::uint64_t request_ = 0;
  std::vector<Service> services_;
  bool was_matched_ = false;  ///< the service heard us once: whoever it does not hear is cut off
  dds::Writer<dds::CommandRequest> commands_;
  dds::Reader<dds::Reply> replies_;
  dds::Reader<dds::Status> statuses_;
  dds::Followed<dds::Status> followed_;
  dds::Waitset waitset_;
  std::optional<dds::Status> status_;
};

/// Returns a random number that is not 0, for sessions and operators.
[[nodiscard]] std::uint64_t draw_id();

}  // namespace meridian::stream
