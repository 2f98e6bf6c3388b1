// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/file/recorded/operator_events_writer.hpp"

#include "meridian/cycle/state_table.hpp"

namespace meridian::record {

std::string operator_events_path(const std::string& recording) {
  const std::size_t folder = recording.rfind('/');
  const std::size_t dot = recording.rfind('.');
  const bool has_ending = dot != std::string::npos && (folder == std::string::npos || dot > folder);
  return recording.substr(0, has_ending ? dot : recording.size()) + ".events.csv";
}

Expected<OperatorEventsWriter, RecordError> OperatorEventsWriter::create(const std::string& path) {
  auto file = CsvFile::create(path, Links::kRefused);
  if (!file) return tl::make_unexpected(std::move(file.error()));
  (void)file->append("cycle,verb,argument,block,span\n");
  (void)file->flush();
  return OperatorEventsWriter(std::move(*file));
}

bool is_replayed(const Event& event) noexcept {
  const auto verb = static_cast<Verb>(event.b);
  // No program is there then.
  const bool is_outside = verb == Verb::kJog || verb == Verb::kHome || verb == Verb::kDryRun ||
                          is_set_up(verb);  // has rows of its own
  return (event.code == EventCode::kAccepted && event.b < kVerbCount && !is_outside) ||
         event.code == EventCode::kPeriodsLost || event.code == EventCode::kActionAnswered ||
         event.code == EventCode::kContactFound || event.code == EventCode::kPlanBegun ||
         event.code == EventCode::kFeedPlanned || event.code == EventCode::kPlanLooked;
}

bool OperatorEventsWriter::write(const Event& event) noexcept {
  if (!is_replayed(event)) return true;
  char* const at = file_.begin_row();
  if (at == nullptr) return false;
  CsvRow row(at);
  row.put_integer(event.cycle).put(',');
  if (event.code == EventCode::kPeriodsLost) {
    row.put(event.b != 0 ? kPeriodsBridgedWord : kPeriodsLostWord).put(',').put_integer(event.a);
  } else if (event.code == EventCode::kActionAnswered) {
    row.put(kActionAnsweredWord).put(',').put_real(event.x);
  } else if (event.code == EventCode::kContactFound) {
    row.put(kContactFoundWord).put(',').put_integer(event.a);
  } else if (event.code == EventCode::kPlanBegun) {
    row.put(kPlanBegunWord).put(",1,").put_real(event.x);
  } else if (event.code == EventCode::kPlanLooked) {
    row.put(kPlanLookedWord).put(',').put_integer(event.a);
    if (event.b > 0) row.put(',').put_integer(event.b);
  } else if (event.code == EventCode::kFeedPlanned) {
    row.put(kFeedPlannedWord).put(',').put_real(event.x);
    row.put(',').put_integer(event.a).put(',').put_integer(event.b);
  } else {
    row.put(name_of(static_cast<Verb>(event.b))).put(',').put_real(event.x);
  }
  file_.end_row(row.put('\n').end());
  return file_.flush();
}

bool OperatorEventsWriter::write(const RecordedFrame& frame) noexcept {
  char* const at = file_.begin_row();
  if (at == nullptr) return false;
  CsvRow row(at);
  row.put_integer(frame.cycle).put(',').put(kFrameWord).put(',').put_integer(int{frame.number});
  for (const double value : frame.origin_mm) row.put(',').put_real(value);
  for (const double value : frame.rotation) row.put(',').put_real(value);
  file_.end_row(row.put('\n').end());
  return file_.flush();
}

bool OperatorEventsWriter::write(const RecordedTool& tool) noexcept {
  char* const at = file_.begin_row();
  if (at == nullptr) return false;
  CsvRow row(at);
  row.put_integer(tool.cycle).put(',').put(kToolWord).put(',').put_integer(tool.number);
  row.put(',').put_real(tool.length_mm).put(',').put_real(tool.radius_mm);
  file_.end_row(row.put('\n').end());
  return file_.flush();
}

bool OperatorEventsWriter::write(const RecordedLimits& limits) noexcept {
  char* const at = file_.begin_row();
  if (at == nullptr) return false;
  CsvRow row(at);
  row.put_integer(limits.cycle).put(',');
  if (limits.box == 0) {
    row.put(kLimitsWord);
  } else if (limits.box == kTipBoxNumber) {
    row.put(kTipBoxWord);
  } else {
    row.put(kKeepOutWord).put(',').put_integer(limits.box);
  }
  row.put(',').put_integer(limits.joint);
  row.put(',').put_real(limits.min).put(',').put_real(limits.max);
  file_.end_row(row.put('\n').end());
  return file_.flush();
}

void OperatorEventsWriter::mark_incomplete() noexcept {
  if (is_marked_) return;
  is_marked_ = true;
  (void)file_.append("incomplete\n");
  (void)file_.flush();
}

}  // namespace meridian::record
