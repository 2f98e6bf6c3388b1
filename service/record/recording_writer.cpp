// SPDX-License-Identifier: Apache-2.0
#include "service/record/recording_writer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <string_view>
#include <utility>

#include "service/record/words.hpp"

namespace meridian::record {
namespace {

constexpr std::size_t kBufferBytes = 256 * 1024;
/// 12 doubles of at most 24 characters, 10 integers of at most 20, words and commas.
constexpr std::size_t kLongestRow = 1024;

/// Appends to a buffer that is known to have room.
class Cursor {
 public:
  explicit Cursor(char* at) noexcept : at_(at) {}
  [[nodiscard]] char* at() const noexcept { return at_; }

  void put(char c) noexcept { *at_++ = c; }
  void put(std::string_view text) noexcept {
    std::memcpy(at_, text.data(), text.size());
    at_ += text.size();
  }
  template <class Integer>
  void put_integer(Integer value) noexcept {
    at_ = std::to_chars(at_, at_ + 24, value).ptr;
  }
  /// 17 significant digits: every double comes back as it was.
  void put_real(double value) noexcept {
    at_ = std::to_chars(at_, at_ + 32, value, std::chars_format::general, 17).ptr;
  }

 private:
  char* at_;
};

[[nodiscard]] std::string header(const MachineModel& model) {
  std::string text = "cycle,due_ns,line,kind";
  for (int i = 0; i < model.joint_count; ++i)
    text.append(",").append(position_column(model.joints[i]));
  for (int i = 0; i < model.joint_count; ++i)
    text.append(",").append(velocity_column(model.joints[i]));
  text += ",sequence,state,plan_time_s,rate,epoch,flags,lateness_ns,computation_ns\n";
  return text;
}

}  // namespace

Expected<RecordingWriter, RecordError> RecordingWriter::create(const std::string& path,
                                                               const MachineModel& model) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) {
    return tl::make_unexpected(
        RecordError{path, 0, std::string("cannot be created: ") + std::strerror(errno),
                    "name a file in a folder that exists and is writable"});
  }
  RecordingWriter writer(file, path, model.joint_count);
  const std::string text = header(model);
  Cursor cursor(writer.buffer_.data());
  cursor.put(text);
  writer.used_ = text.size();
  return writer;
}

RecordingWriter::RecordingWriter(int file, std::string path, int joint_count)
    : path_(std::move(path)), buffer_(kBufferBytes), file_(file), joint_count_(joint_count) {}

RecordingWriter::RecordingWriter(RecordingWriter&& other) noexcept
    : path_(std::move(other.path_)),
      buffer_(std::move(other.buffer_)),
      used_(std::exchange(other.used_, 0)),
      rows_(other.rows_),
      file_(std::exchange(other.file_, -1)),
      error_number_(other.error_number_),
      joint_count_(other.joint_count_) {}

RecordingWriter& RecordingWriter::operator=(RecordingWriter&& other) noexcept {
  if (this != &other) {
    close();
    path_ = std::move(other.path_);
    buffer_ = std::move(other.buffer_);
    used_ = std::exchange(other.used_, 0);
    rows_ = other.rows_;
    file_ = std::exchange(other.file_, -1);
    error_number_ = other.error_number_;
    joint_count_ = other.joint_count_;
  }
  return *this;
}

RecordingWriter::~RecordingWriter() { close(); }

bool RecordingWriter::write(const CycleRecord& record) noexcept {
  if (file_ < 0 || error_number_ != 0) return false;
  if (used_ + kLongestRow > buffer_.size() && !flush()) return false;
  const Setpoint& setpoint = record.setpoint;
  Cursor row(buffer_.data() + used_);
  row.put_integer(setpoint.cycle);
  row.put(',');
  row.put_integer(setpoint.due_ns);
  row.put(',');
  row.put_integer(setpoint.line);
  row.put(',');
  row.put(word(record.motion));
  for (int i = 0; i < joint_count_; ++i) {
    row.put(',');
    row.put_real(record.joints[i]);
  }
  for (int i = 0; i < joint_count_; ++i) {
    row.put(',');
    row.put_real(setpoint.velocity[i]);
  }
  row.put(',');
  row.put_integer(record.sequence);
  row.put(',');
  row.put(word(record.state));
  row.put(',');
  row.put_real(record.plan_time_s);
  row.put(',');
  row.put_real(record.rate);
  row.put(',');
  row.put_integer(setpoint.epoch);
  row.put(',');
  row.put_integer(setpoint.flags);
  row.put(',');
  row.put_integer(record.lateness_ns);
  row.put(',');
  row.put_integer(record.computation_ns);
  row.put('\n');
  used_ = static_cast<std::size_t>(row.at() - buffer_.data());
  ++rows_;
  return true;
}

bool RecordingWriter::flush() noexcept {
  std::size_t done = 0;
  while (error_number_ == 0 && done < used_) {
    const ssize_t written = ::write(file_, buffer_.data() + done, used_ - done);
    if (written > 0) {
      done += static_cast<std::size_t>(written);
    } else if (written < 0 && errno != EINTR) {
      error_number_ = errno;
    } else if (written == 0) {
      error_number_ = EIO;
    }
  }
  used_ = 0;
  return error_number_ == 0;
}

bool RecordingWriter::close() noexcept {
  if (file_ < 0) return error_number_ == 0;
  flush();
  if (::close(file_) != 0 && error_number_ == 0) error_number_ = errno;
  file_ = -1;
  return error_number_ == 0;
}

}  // namespace meridian::record
