// SPDX-License-Identifier: Apache-2.0
#include "service/recording/mcap/writer.hpp"

#include "service/recording/mcap/bytes.hpp"

namespace meridian::mcap {
namespace {

/// Every file begins and ends with it; 0 is the version of the format.
constexpr std::string_view kMagic = "\x89MCAP0\r\n";

}  // namespace

Expected<std::unique_ptr<Writer>, int> Writer::create(const std::string& path,
                                                      const WriterSettings& settings) {
  std::unique_ptr<Writer> writer(new Writer(settings));
  if (const int error = writer->file_.open(path); error != 0) {
    writer->is_closed_ = true;
    return tl::make_unexpected(error);
  }
  std::string begin(kMagic);
  put_record(begin, Opcode::kHeader, [&](std::string& out) {
    put_text(out, settings.profile);
    put_text(out, settings.library);
  });
  (void)writer->file_.write(begin);
  return writer;
}

std::uint16_t Writer::add_schema(std::string_view name, std::string_view encoding,
                                 std::string_view text) {
  const auto id = static_cast<std::uint16_t>(summary_.schema_count() + 1);  // 0 means none
  record_.clear();
  put_record(record_, Opcode::kSchema, [&](std::string& out) {
    put(out, id);
    put_text(out, name);
    put_text(out, encoding);
    put_text(out, text);
  });
  summary_.add_schema(record_);
  (void)file_.write(record_);
  return id;
}

std::uint16_t Writer::add_channel(std::uint16_t schema, std::string_view topic,
                                  std::string_view message_encoding) {
  const std::uint16_t id = summary_.channel_count();
  record_.clear();
  put_record(record_, Opcode::kChannel, [&](std::string& out) {
    put(out, id);
    put(out, schema);
    put_text(out, topic);
    put_text(out, message_encoding);
    put_list(out, [](std::string&) {});  // no metadata
  });
  summary_.add_channel(record_);
  (void)file_.write(record_);
  return id;
}

void Writer::add_metadata(std::string_view name, const std::map<std::string, std::string>& values) {
  record_.clear();
  put_record(record_, Opcode::kMetadata, [&](std::string& out) {
    put_text(out, name);
    put_list(out, [&](std::string& list) {
      for (const auto& [key, value] : values) {
        put_text(list, key);
        put_text(list, value);
      }
    });
  });
  summary_.add_metadata(name, file_.size(), record_.size());
  (void)file_.write(record_);
}

bool Writer::write(std::uint16_t channel, std::uint64_t time_ns, std::string_view data) {
  if (is_closed_ || error_number() != 0) return false;
  const auto sequence = static_cast<std::uint32_t>(summary_.message_count(channel));
  chunk_.add(channel, sequence, time_ns, data);
  summary_.add_message(channel, time_ns);
  return chunk_.size() < chunk_bytes_ || end_chunk();
}

bool Writer::end_chunk() {
  if (is_closed_) return false;
  if (chunk_.is_empty()) return error_number() == 0;
  chunk_.finish(file_.size(), record_, entry_);
  summary_.add_chunk(entry_);
  return file_.write(record_);
}

bool Writer::close() {
  if (is_closed_) return error_number() == 0;
  (void)end_chunk();
  is_closed_ = true;
  const std::uint32_t sum = file_.crc();
  record_.clear();
  put_record(record_, Opcode::kDataEnd, [&](std::string& out) { put(out, sum); });
  record_ += summary_.text(file_.size() + record_.size());
  record_ += kMagic;
  (void)file_.write(record_);
  return file_.close();
}

}  // namespace meridian::mcap
