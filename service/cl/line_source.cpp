// SPDX-License-Identifier: Apache-2.0
#include "service/cl/line_source.hpp"

#include <algorithm>
#include <cstring>

namespace meridian::cl {
namespace {
constexpr std::size_t kBufferSize = 256 * 1024;
constexpr std::size_t kHeadSize = 64 * 1024;
constexpr char kDosEnd = '\x1a';

const char* find_newline(const char* begin, const char* end) {
  if (begin == end) return nullptr;
  return static_cast<const char*>(std::memchr(begin, '\n', static_cast<std::size_t>(end - begin)));
}
}  // namespace

LineSource::LineSource(std::istream& stream) : stream_(&stream), buffer_(kBufferSize) {
  begin_ = end_ = buffer_.data();
}

LineSource::LineSource(std::string_view text)
    : begin_(text.data()), end_(text.data() + text.size()), at_end_(true) {}

void LineSource::refill() {
  if (at_end_) return;
  const auto rest = static_cast<std::size_t>(end_ - begin_);
  std::memmove(buffer_.data(), begin_, rest);
  begin_ = buffer_.data();
  stream_->read(buffer_.data() + rest, static_cast<std::streamsize>(buffer_.size() - rest));
  end_ = begin_ + rest + static_cast<std::size_t>(stream_->gcount());
  if (stream_->eof() || stream_->fail()) {
    at_end_ = true;
    read_error_ = stream_->bad();
  }
}

std::string_view LineSource::head() {
  if (!started_) {
    while (!at_end_ && static_cast<std::size_t>(end_ - begin_) < kHeadSize) refill();
    constexpr std::string_view kMark = "\xef\xbb\xbf";
    if (std::string_view(begin_, end_).starts_with(kMark)) {
      begin_ += kMark.size();
      bytes_ += kMark.size();
    }
    started_ = true;
  }
  return {begin_, std::min(static_cast<std::size_t>(end_ - begin_), kHeadSize)};
}

LineSource::Outcome LineSource::next(std::string_view& line) {
  if (!started_) (void)head();
  const char* newline = find_newline(begin_, end_);
  if (newline == nullptr && !at_end_) {
    refill();
    newline = find_newline(begin_, end_);
  }
  if (newline == nullptr && read_error_) return Outcome::kReadError;
  if (newline == nullptr && begin_ == end_) return Outcome::kEnd;
  const char* const stop = newline != nullptr ? newline : end_;
  const char* tail = stop;
  if (static_cast<std::size_t>(tail - begin_) > kLongestLine) return Outcome::kTooLong;
  if (tail != begin_ && tail[-1] == '\r') --tail;
  const char* const start = begin_;
  begin_ = newline != nullptr ? stop + 1 : stop;
  bytes_ += static_cast<std::uint64_t>(begin_ - start);
  ++line_number_;
  if (newline == nullptr || begin_ == end_) {
    if (newline == nullptr && tail != start && tail[-1] == kDosEnd) {
      if (--tail == start) return Outcome::kEnd;
    } else {
      open_end_ = newline == nullptr;
    }
  }
  line = {start, static_cast<std::size_t>(tail - start)};
  return Outcome::kLine;
}

}  // namespace meridian::cl
