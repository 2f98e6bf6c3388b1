// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "meridian/cycle/state.hpp"
#include "service/panel/desks/outcome.hpp"
#include "service/panel/jog_grip.hpp"
#include "service/protocol/operator/jog_hand.hpp"
#include "service/protocol/operator/operator_link.hpp"
#include "service/transport/participant.hpp"

namespace meridian::panel {

/// Asks the machine for what pages ask for, as `meridian ctl` does: every command quotes what its
/// page saw last. Hold, abort and disable have a thread and a link of their own and wait behind
/// nothing. Any thread may ask; outcomes come on the desk's threads.
class OperatorDesk {
 public:
  /// Throws DdsError.
  OperatorDesk(dds::Participant& participant, const std::string& operator_name);
  ~OperatorDesk();  ///< lets go of a jog; waits for what is under way
  OperatorDesk(const OperatorDesk&) = delete;
  OperatorDesk& operator=(const OperatorDesk&) = delete;

  void ask(Verb verb, double argument, const stream::Seen& seen, OnOutcome on_outcome);
  /// Jogs for as long as `grip` is held.
  void jog(const stream::JogPlan& plan, std::shared_ptr<JogGrip> grip, OnOutcome on_outcome);

 private:
  using Task = std::function<void(stream::OperatorLink&)>;

  /// A thread with a link of its own; what it is asked waits its turn, little of it.
  class Lane {
   public:
    Lane(dds::Participant& participant, const std::string& operator_name);
    ~Lane();
    Lane(const Lane&) = delete;
    Lane& operator=(const Lane&) = delete;
    [[nodiscard]] bool add(Task task);  ///< false: too much waits already

   private:
    static constexpr std::size_t kMaxTasks = 16;
    void run();

    stream::OperatorLink link_;
    std::mutex mutex_;
    std::condition_variable added_;
    std::deque<Task> tasks_;
    bool is_ending_ = false;
    std::thread thread_;
  };

  dds::Participant& participant_;
  std::mutex mutex_;
  std::weak_ptr<JogGrip> grip_;  ///< the newest
  /// Of the others' thread. One for all jogs: the service goes by the numbers of its samples.
  std::unique_ptr<stream::JogHand> hand_;
  Lane stops_, others_;
};

}  // namespace meridian::panel
