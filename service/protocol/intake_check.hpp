// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "meridian/kinematics/machine_model.hpp"
#include "meridian/path/block_reject.hpp"
#include "meridian/path/cl_block.hpp"
#include "service/protocol/block_check.hpp"
#include "service/protocol/session_phase.hpp"
#include "service/transport/convert/messages.hpp"

namespace meridian::stream {

/// How the cuts of a program join that asks for it; nothing: as the machine's file says.
[[nodiscard]] std::optional<Transition> transition_asked(
    const dds::SessionRequest& request) noexcept;

/// What the intake thread knows at the moment of a call.
struct IntakeContext {
  std::int64_t now_ns = 0;     ///< monotonic
  std::size_t free_slots = 0;  ///< of the block queue
  ActionPeer actions;
  bool is_tool_known = true;  ///< false: its change was given up and is not answered yet
};

/// Blocks that a batch added to the program, in order: push them all, there is room.
struct Accepted {
  std::array<ClBlock, dds::kBatchBlocks + 1> blocks;  ///< one more for the end
  std::size_t count = 0;
};

/// How many batches and blocks went which way since the start. For the status.
struct IntakeCounters {
  std::uint64_t blocks_accepted = 0;
  std::uint64_t batches_duplicate = 0;  ///< dropped: every block was in already
  std::uint64_t batches_corrupted = 0;  ///< dropped: CRC; asked for again
  std::uint64_t batches_gap = 0;        ///< dropped: blocks before it missing; asked for again
  std::uint64_t batches_stale = 0;      ///< dropped: session not open here, or refused
  std::uint64_t sessions_refused = 0;
};

/// The service's end of the session protocol: who holds the machine, which blocks it gets, what
/// is wrong with them. A state machine of one thread; time, queue slots and peers are arguments.
///
/// One session at a time holds the machine, from its open until its program ran to the end, its
/// queues were emptied (abort, disable, fault), or it left or was refused without a block. Credits
/// never go back: what was granted stays granted. After a refusal nothing of the session is
/// accepted any more; what was accepted before stays the machine's to run. Protocol:
/// docs/interface.md. Proof: tests/unit/protocol/intake_check_test.cpp,
/// tests/property/protocol/session_test.cpp.
class IntakeCheck {
 public:
  IntakeCheck(const MachineModel& model, const ToolLengths& tools, std::uint64_t service_id);

  /// Between two programs: the tools that the machine has from here on.
  void set_tools(const ToolTable& tools) { check_.set_tools(lengths_of(tools)); }

  /// A station asks for the machine or gives it back. Returns the answer, to be published at once.
  /// `tool_length_mm` is that of the tool in the spindle when the program will start.
  [[nodiscard]] dds::Credit on_request(const dds::SessionRequest& request,
                                       const IntakeContext& context, double tool_length_mm);

  /// The answer to an open that is refused for a reason that lies outside of the protocol.
  [[nodiscard]] dds::Credit refuse_program(const dds::SessionRequest& request, std::string why);

  /// A batch came. `accepted` gets the blocks that go into the queue. Returns an answer where the
  /// station must hear something at once: send again, refused, complete, not your session.
  [[nodiscard]] std::optional<dds::Credit> on_batch(const dds::Batch& batch,
                                                    const IntakeContext& context,
                                                    Accepted& accepted);

  /// The planner refused a block of the session that was accepted before.
  [[nodiscard]] std::optional<dds::Credit> on_planner_reject(const BlockReject& reject,
                                                             const IntakeContext& context);
  /// Blocks that were accepted found no room in the queue, against what credits promise: nothing
  /// behind them may run.
  [[nodiscard]] dds::Credit on_queue_full(const IntakeContext& context);
  /// The machine executed the program to its end: the machine is free.
  [[nodiscard]] std::optional<dds::Credit> on_program_end(const IntakeContext& context);
  /// Queues were emptied at rest (abort, disable, fault) for `reason`: the machine is free.
  [[nodiscard]] std::optional<dds::Credit> on_queues_emptied(const std::string& reason,
                                                             const IntakeContext& context);
  /// The station's process is gone, or its connection. What it sent stays; if it sent nothing the
  /// machine is free.
  void on_station_lost(std::uint64_t session);

  /// Returns the credit to be published now: at once when `kCreditStep` blocks more may be sent,
  /// else repeated every `kCreditRepeat_ns` while a session holds the machine.
  [[nodiscard]] std::optional<dds::Credit> due_credit(const IntakeContext& context);

  [[nodiscard]] bool is_held() const noexcept { return phase_ != SessionPhase::kFree; }
  [[nodiscard]] bool is_complete() const noexcept { return has_end_mark(phase_); }
  /// Blocks are in, and none comes any more, nor an end: a refusal or its station ended the
  /// session. What is in is to be run to its end.
  [[nodiscard]] bool is_cut_off() const noexcept { return is_refused(phase_); }
  [[nodiscard]] std::uint64_t session() const noexcept { return session_; }
  [[nodiscard]] const dds::SessionRequest& request() const noexcept { return request_; }
  [[nodiscard]] const IntakeCounters& counters() const noexcept { return counters_; }
  [[nodiscard]] std::uint64_t next_sequence() const noexcept { return next_; }
  /// The newest verdict in words, of whatever session: for status and log.
  [[nodiscard]] const std::string& message() const noexcept { return message_; }

  static constexpr std::uint64_t kCreditStep = 256;
  static constexpr std::int64_t kCreditRepeat_ns = 100'000'000;

 private:
  [[nodiscard]] dds::Credit open(const dds::SessionRequest& request, const IntakeContext& context,
                                 double tool_length_mm);
  [[nodiscard]] dds::Credit close(const dds::SessionRequest& request, const IntakeContext& context);
  [[nodiscard]] dds::Credit stranger(std::uint64_t session, dds::Verdict verdict, std::string text);
  [[nodiscard]] dds::Credit refuse(const BlockReject& reject, const IntakeContext& context);
  [[nodiscard]] dds::Credit refuse(dds::Verdict verdict, std::string text,
                                   const IntakeContext& context);
  [[nodiscard]] dds::Credit end_session(dds::Verdict verdict, std::string text,
                                        const IntakeContext& context);
  [[nodiscard]] const dds::Credit* find_ended(std::uint64_t session) const noexcept;
  void change(SessionEvent event) noexcept { phase_ = phase_after(phase_, event); }
  void grant(const IntakeContext& context) noexcept;
  [[nodiscard]] dds::Credit credit(const IntakeContext& context);
  [[nodiscard]] bool take_blocks(const dds::Batch& batch, const IntakeContext& context,
                                 Accepted& accepted, dds::Credit& refusal);
  void append_end(Accepted& accepted);

  const MachineModel& model_;
  std::uint64_t service_id_;
  BlockCheck check_;
  IntakeCounters counters_;
  std::string message_;

  SessionPhase phase_ = SessionPhase::kFree;
  std::uint64_t session_ = 0;  ///< that holds the machine; 0: it is free
  dds::SessionRequest request_;
  std::uint64_t next_ = 0;         ///< first sequence that is not in
  std::uint64_t granted_end_ = 0;  ///< sequences below it may be sent
  bool is_lost_ = false;           ///< its station is gone
  bool has_end_block_ = false;     ///< a block of kind kEnd is in
  dds::Credit newest_;             ///< the newest answer to the session
  std::int64_t published_ns_ = 0;
  std::uint64_t published_end_ = 0;
  std::array<dds::Credit, 16>
      ended_;  ///< last words to sessions that are over: repeated, never reopened
  std::size_t ended_at_ = 0;
};

}  // namespace meridian::stream
