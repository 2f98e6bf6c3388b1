// SPDX-License-Identifier: Apache-2.0
#include "service/protocol/intake_check.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "meridian/kinematics/kinematics.hpp"
#include "meridian/kinematics/tip_over_base.hpp"
#include "service/protocol/station/smooth_tolerances.hpp"

namespace meridian::stream {

namespace {

using dds::Verdict;

std::string number(std::uint64_t value) { return std::to_string(value); }

std::string in_hex(std::uint64_t value) {
  char buffer[17];
  std::snprintf(buffer, sizeof buffer, "%llx", static_cast<unsigned long long>(value));
  return buffer;
}

bool contradicts_itself(const dds::SessionRequest& request) {
  constexpr std::uint32_t kBoth = dds::kPolicyExactStop | dds::kPolicySmooth;
  return (request.policies & kBoth) == kBoth;
}

/// Why no program may begin at the joints that the request names; empty where it may.
std::string refusal_of_first_joints(const dds::SessionRequest& request, const MachineModel& model,
                                    double tool_length_mm) {
  if ((request.policies & dds::kPolicyFirstJoints) == 0) return "";
  const JointVector& joints = request.first_joints;
  const int outside = first_joint_outside_travel(model, joints, 0);
  if (outside >= 0) {
    return "the program begins outside of the travel of " + limited_spec(model, outside).name;
  }
  const int box = keep_out_at(model.keep_out, joints);
  if (box >= 0) {
    return std::string("the program begins inside of the keep-out box ") +
           model.keep_out.name_of(box);
  }
  if (tip_axis_outside(model, tool_length_mm, joints) >= 0) {
    return "the program begins with the tip outside of the tip box; jog it in, or widen the box";
  }
  const auto unused = joints.begin() + model.joint_count;
  const bool names_more = std::any_of(unused, joints.end(), [](double at) { return at != 0; });
  return names_more ? "the program begins at joints that machine " + model.name + " has not" : "";
}

}  // namespace

std::optional<Transition> transition_asked(const dds::SessionRequest& request) noexcept {
  if ((request.policies & dds::kPolicySmooth) != 0) return Transition::kSmooth;
  if ((request.policies & dds::kPolicyExactStop) != 0) return Transition::kExactStop;
  return {};
}

IntakeCheck::IntakeCheck(const MachineModel& model, const ToolLengths& tools,
                         std::uint64_t service_id)
    : model_(model), service_id_(service_id), check_(model, tools) {}

dds::Credit IntakeCheck::on_request(const dds::SessionRequest& request,
                                    const IntakeContext& context, double tool_length_mm) {
  return request.request == dds::SessionRequestKind::kOpen ? open(request, context, tool_length_mm)
                                                           : close(request, context);
}

dds::Credit IntakeCheck::open(const dds::SessionRequest& request, const IntakeContext& context,
                              double tool_length_mm) {
  if (request.session != 0 && request.session == session_) {
    is_lost_ = false;
    return credit(context);
  }
  if (const dds::Credit* last = find_ended(request.session)) return *last;
  const auto refused = [&](Verdict verdict, std::string text) {
    ++counters_.sessions_refused;
    return stranger(request.session, verdict, std::move(text));
  };
  if (is_held()) {
    return refused(Verdict::kRefusedStation,
                   "machine " + model_.name + " is held by station " + request_.station +
                       " with program " + request_.program +
                       (is_lost_ ? ", which is gone; enable the machine and abort to free it"
                                 : "; wait for its end, or enable the machine and abort it"));
  }
  if (!context.is_tool_known) {
    return refused(Verdict::kRefusedProgram,
                   "which tool is in the spindle is not known: its change was given up, and the "
                   "action peer has not said yet whether it is done");
  }
  if (request.session == 0) return refused(Verdict::kRefusedProgram, "0 names no session");
  if (contradicts_itself(request)) {
    return refused(Verdict::kRefusedProgram,
                   "the program asks for exact stop and for smooth transitions");
  }
  std::string refusal =
      refusal_of_tolerances(model_, transition_asked(request).value_or(model_.transition),
                            request.tip_tolerance_mm, request.axis_tolerance_rad);
  if (refusal.empty()) refusal = refusal_of_first_joints(request, model_, tool_length_mm);
  if (!refusal.empty()) return refused(Verdict::kRefusedProgram, std::move(refusal));
  if ((request.policies & dds::kPolicyContainsActions) != 0 && !context.actions.is_there &&
      !context.actions.is_ignored) {
    return refused(Verdict::kRefusedProgram,
                   "the program has tool, spindle, coolant or stop words and nobody answers "
                   "actions; start the action peer or set auxiliary = \"ignore\"");
  }
  session_ = request.session;
  request_ = request;
  next_ = granted_end_ = published_end_ = 0;
  is_lost_ = has_end_block_ = false;
  change(SessionEvent::kOpened);
  check_.begin(tool_length_mm);
  newest_ = {};
  newest_.verdict = Verdict::kGood;
  newest_.text = message_ = "station " + request.station + " opened " + request.program;
  return credit(context);
}

dds::Credit IntakeCheck::refuse_program(const dds::SessionRequest& request, std::string why) {
  ++counters_.sessions_refused;
  return stranger(request.session, Verdict::kRefusedProgram, std::move(why));
}

dds::Credit IntakeCheck::close(const dds::SessionRequest& request, const IntakeContext& context) {
  if (request.session != session_ || !is_held()) {
    if (const dds::Credit* last = find_ended(request.session)) return *last;
    return stranger(request.session, Verdict::kClosed,
                    "session " + in_hex(request.session) + " is not open here");
  }
  if (is_complete()) return credit(context);
  if (next_ == 0) {
    return end_session(is_cut_off() ? newest_.verdict : Verdict::kClosed,
                       is_cut_off() ? newest_.text : "closed before the first block", context);
  }
  if (is_cut_off()) return credit(context);
  is_lost_ = true;
  change(SessionEvent::kRefused);
  newest_.verdict = Verdict::kClosed;
  newest_.text = message_ = "station " + request_.station + " closed before the end: the machine " +
                            "runs the " + number(next_) + " blocks that it has and stops";
  return credit(context);
}

std::optional<dds::Credit> IntakeCheck::on_batch(const dds::Batch& batch,
                                                 const IntakeContext& context, Accepted& accepted) {
  accepted.count = 0;
  const bool is_intact = batch.count <= dds::kBatchBlocks && dds::batch_crc(batch) == batch.crc;
  if (!is_held() || batch.session != session_) {
    ++(is_intact ? counters_.batches_stale : counters_.batches_corrupted);
    if (!is_intact || batch.session == 0) return std::nullopt;
    if (const dds::Credit* last = find_ended(batch.session)) return *last;
    return stranger(
        batch.session, Verdict::kClosed,
        "session " + in_hex(batch.session) + " is not open here: its blocks were dropped");
  }
  if (is_cut_off()) {
    ++counters_.batches_stale;
    return std::nullopt;
  }
  if (!is_intact) {
    ++counters_.batches_corrupted;
    if (is_complete()) return std::nullopt;
    newest_.verdict = Verdict::kGap;
    newest_.verdict_sequence = next_;
    newest_.text = "a batch was corrupted: send again from block " + number(next_);
    return credit(context);
  }
  grant(context);  // places that came free count for this batch too
  if (batch.first_sequence > granted_end_ || batch.count > granted_end_ - batch.first_sequence) {
    return refuse(Verdict::kBeyondCredit,
                  "station sent blocks up to " + number(batch.first_sequence + batch.count) +
                      " and had credit up to " + number(granted_end_) + ": session refused",
                  context);
  }
  if (batch.first_sequence > next_) {
    ++counters_.batches_gap;
    newest_.verdict = Verdict::kGap;
    newest_.verdict_sequence = next_;
    newest_.text = "blocks " + number(next_) + " to " + number(batch.first_sequence - 1) +
                   " are missing: send again";
    return credit(context);
  }
  const std::uint64_t batch_end = batch.first_sequence + batch.count;
  if (is_complete() || batch_end < next_ || (batch_end == next_ && !batch.is_end)) {
    ++counters_.batches_duplicate;
    return is_complete() ? std::optional(credit(context)) : std::nullopt;
  }
  dds::Credit refusal;
  if (!take_blocks(batch, context, accepted, refusal)) return refusal;
  const bool was_gap = newest_.verdict == Verdict::kGap;
  newest_.verdict = Verdict::kGood;
  newest_.text.clear();
  if (!batch.is_end) return was_gap ? std::optional(credit(context)) : std::nullopt;
  if (next_ == 0) {
    return end_session(Verdict::kRefusedProgram, "the program has no block", context);
  }
  if (!has_end_block_) append_end(accepted);
  change(SessionEvent::kEndMark);
  newest_.verdict = Verdict::kComplete;
  newest_.verdict_sequence = next_ - 1;
  newest_.text = message_ = "program " + request_.program + " is in: " + number(next_) + " blocks";
  return credit(context);
}

/// Checks the new blocks of a batch that follows on; false with the refusal where one is bad.
bool IntakeCheck::take_blocks(const dds::Batch& batch, const IntakeContext& context,
                              Accepted& accepted, dds::Credit& refusal) {
  for (std::uint64_t i = next_ - batch.first_sequence; i < batch.count; ++i) {
    ClBlock block = batch.blocks[i];
    BlockReject verdict{next_, block.line, RejectCode::kKind, -1, 0};
    if (block.sequence == next_ && !has_end_block_) verdict = check_.check(block, context.actions);
    if (verdict.code != RejectCode::kNone) {
      refusal = refuse(verdict, context);
      return false;
    }
    has_end_block_ = block.kind == BlockKind::kEnd;
    accepted.blocks[accepted.count++] = block;
    ++next_;
    ++counters_.blocks_accepted;
  }
  return true;
}

/// A program whose file does not say its end ends where the end mark says so.
void IntakeCheck::append_end(Accepted& accepted) {
  ClBlock end;
  end.sequence = next_;
  end.line = accepted.count > 0 ? accepted.blocks[accepted.count - 1].line : 0;
  end.kind = BlockKind::kEnd;
  accepted.blocks[accepted.count++] = end;
  has_end_block_ = true;
}

std::optional<dds::Credit> IntakeCheck::on_planner_reject(const BlockReject& reject,
                                                          const IntakeContext& context) {
  if (!is_held() || newest_.verdict == Verdict::kRefusedBlock) return std::nullopt;
  return refuse(reject, context);
}

dds::Credit IntakeCheck::on_queue_full(const IntakeContext& context) {
  change(SessionEvent::kEndIsLost);
  return refuse(dds::Verdict::kBeyondCredit,
                "the block queue is full although credit was kept, a fault of the service: session "
                "refused",
                context);
}

std::optional<dds::Credit> IntakeCheck::on_program_end(const IntakeContext& context) {
  if (!is_held()) return std::nullopt;
  return end_session(Verdict::kRan, "program " + request_.program + " ran to its end", context);
}

std::optional<dds::Credit> IntakeCheck::on_queues_emptied(const std::string& reason,
                                                          const IntakeContext& context) {
  if (!is_held()) return std::nullopt;
  if (is_cut_off()) return end_session(newest_.verdict, newest_.text, context);
  return end_session(Verdict::kAborted, reason, context);
}

void IntakeCheck::on_station_lost(std::uint64_t session) {
  if (!is_held() || session != session_) return;
  if (is_complete()) return;  // it has done its work
  is_lost_ = true;
  message_ = "station " + request_.station + " is gone";
  if (next_ == 0) static_cast<void>(end_session(Verdict::kClosed, message_, {}));
}

std::optional<dds::Credit> IntakeCheck::due_credit(const IntakeContext& context) {
  if (!is_held()) return std::nullopt;
  const std::int64_t published_ns = published_ns_;
  const std::uint64_t published_end = published_end_;
  dds::Credit now = credit(context);
  if (granted_end_ >= published_end + kCreditStep ||
      context.now_ns - published_ns >= kCreditRepeat_ns) {
    return now;
  }
  published_ns_ = published_ns;
  published_end_ = published_end;
  return std::nullopt;
}

dds::Credit IntakeCheck::refuse(const BlockReject& reject, const IntakeContext& context) {
  newest_.verdict_sequence = reject.sequence;
  newest_.verdict_line = reject.line;
  newest_.verdict_joint = reject.joint;
  newest_.verdict_value = reject.value;
  return refuse(Verdict::kRefusedBlock, describe(reject, model_), context);
}

dds::Credit IntakeCheck::refuse(dds::Verdict verdict, std::string text,
                                const IntakeContext& context) {
  ++counters_.sessions_refused;
  if (next_ == 0) return end_session(verdict, std::move(text), context);
  change(SessionEvent::kRefused);
  newest_.verdict = verdict;
  newest_.text = message_ = std::move(text);
  return credit(context);
}

/// The answer to somebody who does not hold the machine.
dds::Credit IntakeCheck::stranger(std::uint64_t session, dds::Verdict verdict, std::string text) {
  dds::Credit answer;
  answer.session = session;
  answer.service_id = service_id_;
  answer.verdict = verdict;
  answer.text = message_ = std::move(text);
  return answer;
}

dds::Credit IntakeCheck::end_session(dds::Verdict verdict, std::string text,
                                     const IntakeContext& context) {
  newest_.verdict = verdict;
  newest_.text = message_ = std::move(text);
  change(SessionEvent::kRefused);
  dds::Credit last = credit(context);
  ended_[ended_at_++ % ended_.size()] = last;
  session_ = 0;
  change(SessionEvent::kOver);
  return last;
}

const dds::Credit* IntakeCheck::find_ended(std::uint64_t session) const noexcept {
  const auto* last =
      std::find_if(ended_.begin(), ended_.end(),
                   [session](const dds::Credit& credit) { return credit.session == session; });
  return session == 0 || last == ended_.end() ? nullptr : last;
}

/// Free slots become credit. One is kept for the end that append_end() may add.
void IntakeCheck::grant(const IntakeContext& context) noexcept {
  if (!is_accepting(phase_) || context.free_slots <= 1) return;
  granted_end_ = std::max(granted_end_, next_ + context.free_slots - 1);
}

dds::Credit IntakeCheck::credit(const IntakeContext& context) {
  grant(context);
  newest_.session = session_;
  newest_.service_id = service_id_;
  newest_.next_sequence = next_;
  newest_.credits = is_accepting(phase_) ? static_cast<std::uint32_t>(granted_end_ - next_) : 0;
  published_ns_ = context.now_ns;
  published_end_ = granted_end_;
  return newest_;
}

}  // namespace meridian::stream
