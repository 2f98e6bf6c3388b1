// SPDX-License-Identifier: Apache-2.0
#include "service/programs/cl/text/line_source.hpp"

#include <algorithm>
#include <cstring>
#include <exception>
#include <streambuf>

namespace meridian::cl {
namespace {
constexpr std::size_t kBufferSize = 256 * 1024;
constexpr std::size_t kHeadSize = 64 * 1024;
constexpr char kDosEnd = '\x1a';

const char* find_newline(const char* begin, const char* end, char newline) {
  if (begin == end) return nullptr;
  return static_cast<const char*>(
      std::memchr(begin, newline, static_cast<std::size_t>(end - begin)));
}

/// CR alone ends lines where there is one before other text and no LF anywhere.
char line_end_of(std::string_view head) {
  const std::size_t at = head.find('\r');
  const bool is_alone = at != std::string_view::npos && at + 1 < head.size() &&
                        head.find('\n') == std::string_view::npos;
  return is_alone ? '\r' : '\n';
}
}  // namespace

LineSource::LineSource(std::istream& stream) : stream_(&stream), buffer_(kBufferSize) {
  begin_ = end_ = buffer_.data();
}

LineSource::LineSource(std::string_view text)
    : begin_(text.data()), end_(text.data() + text.size()), supply_(Supply::kAtEnd) {}

/// Takes what the stream has, at least one byte: a slow source is not waited for longer than it
/// takes to its next line.
void LineSource::refill() {
  if (supply_ != Supply::kOpen) return;
  const auto rest = static_cast<std::size_t>(end_ - begin_);
  std::memmove(buffer_.data(), begin_, rest);
  begin_ = buffer_.data();
  end_ = begin_ + rest;
  try {
    std::streambuf* const source = stream_->rdbuf();
    std::streamsize ready = source->in_avail();
    if (ready <= 0) {
      if (std::streambuf::traits_type::eq_int_type(source->sgetc(),
                                                   std::streambuf::traits_type::eof())) {
        supply_ = Supply::kAtEnd;
        return;
      }
      ready = std::max<std::streamsize>(source->in_avail(), 1);
    }
    const auto room = static_cast<std::streamsize>(buffer_.size() - rest);
    end_ += source->sgetn(buffer_.data() + rest, std::min(ready, room));
  } catch (const std::exception&) {  // what a file buffer throws when the medium fails
    supply_ = Supply::kFailed;
  }
}

std::string_view LineSource::head() {
  if (!started_) {
    refill();
    constexpr std::string_view kMark = "\xef\xbb\xbf";
    if (std::string_view(begin_, end_).starts_with(kMark)) {
      begin_ += kMark.size();
      bytes_ += kMark.size();
    }
    started_ = true;
  }
  const std::string_view head(begin_, std::min(static_cast<std::size_t>(end_ - begin_), kHeadSize));
  if (line_number_ == 0) line_end_ = line_end_of(head);
  return head;
}

bool LineSource::read_on() {
  const auto before = static_cast<std::size_t>(end_ - begin_);
  if (before >= kHeadSize) return false;
  refill();
  return static_cast<std::size_t>(end_ - begin_) > before;
}

bool LineSource::look_ahead(const std::function<void(LineSource&)>& look) {
  const std::streampos kNowhere(std::streamoff(-1));
  std::streambuf* const source = stream_ != nullptr ? stream_->rdbuf() : nullptr;
  std::streampos at;
  if (source != nullptr) {
    at = source->pubseekoff(0, std::ios::cur, std::ios::in);
    if (at == kNowhere) return false;
  }
  LineSource ahead(*this);  // goes on from this buffer into its own: lines given out stay good
  look(ahead);
  if (source != nullptr && source->pubseekpos(at, std::ios::in) != at) supply_ = Supply::kFailed;
  return true;
}

LineSource::Outcome LineSource::next(std::string_view& line) {
  if (!started_) (void)head();
  const char* newline = find_newline(begin_, end_, line_end_);
  while (newline == nullptr && supply_ == Supply::kOpen &&
         static_cast<std::size_t>(end_ - begin_) <= kLongestLine) {
    refill();
    newline = find_newline(begin_, end_, line_end_);
  }
  if (newline == nullptr && supply_ == Supply::kFailed) return Outcome::kReadError;
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
