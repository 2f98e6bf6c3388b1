// SPDX-License-Identifier: Apache-2.0
#include "service/recording/record/file/recording_writer.hpp"

namespace meridian::record {

Expected<RecordingWriter, RecordError> RecordingWriter::create(const std::string& path,
                                                               const MachineModel& model,
                                                               Links links) {
  auto file = CsvFile::create(path, links);
  if (!file) return tl::make_unexpected(std::move(file.error()));
  (void)file->append(RecordColumns::header(model) + "\n");
  return RecordingWriter(std::move(*file), model);
}

bool RecordingWriter::write(const CycleRecord& record) noexcept {
  char* const at = file_.begin_row();
  if (at == nullptr) return false;
  CsvRow row(at);
  columns_.put(row, record);
  file_.end_row(row.put('\n').end());
  ++rows_;
  return true;
}

}  // namespace meridian::record
