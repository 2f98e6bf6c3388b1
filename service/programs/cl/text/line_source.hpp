// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <istream>
#include <string_view>
#include <vector>

namespace meridian::cl {

/// Physical lines of a stream or of a text in memory, one after the other, in constant memory.
///
/// Lines end at LF; a CR before it is taken off, and so are a UTF-8 byte order mark at the start
/// and a DOS end-of-file mark (Ctrl-Z) at the end. Where the head has CR and no LF, lines end at
/// CR. Bytes are ISO-8859-1 or UTF-8 alike: nothing beyond ASCII carries meaning.
class LineSource {
 public:
  enum class Outcome : std::uint8_t { kLine, kEnd, kTooLong, kReadError };
  static constexpr std::size_t kLongestLine = 64 * 1024;

  /// The stream is read as its bytes come and must live as long as the source.
  explicit LineSource(std::istream& stream);
  /// The text is used in place and must live as long as the source.
  explicit LineSource(std::string_view text);

  /// The next line without its end. The view is good until the next call.
  [[nodiscard]] Outcome next(std::string_view& line);

  /// The first bytes of the source, as many as it has at once, up to 64 KiB; to be asked before the
  /// first next().
  [[nodiscard]] std::string_view head();
  /// Waits for more of the head; false where there is none, or head() is as long as it gets.
  [[nodiscard]] bool read_on();

  /// Shows `look` the lines behind the last one, all of which are read again afterwards. False, and
  /// nothing is shown, where the stream cannot go back, as a pipe.
  bool look_ahead(const std::function<void(LineSource&)>& look);

  [[nodiscard]] std::uint32_t line_number() const noexcept { return line_number_; }
  [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_; }
  /// True once the last line came without an LF behind it.
  [[nodiscard]] bool ended_without_newline() const noexcept { return open_end_; }

 private:
  /// Whether the stream has more than what is between begin_ and end_.
  enum class Supply : std::uint8_t { kOpen, kAtEnd, kFailed };
  void refill();

  std::istream* stream_ = nullptr;
  std::vector<char> buffer_;
  const char* begin_ = nullptr;  ///< what is not given out yet
  const char* end_ = nullptr;
  std::uint64_t bytes_ = 0;
  std::uint32_t line_number_ = 0;
  char line_end_ = '\n';
  Supply supply_ = Supply::kOpen;
  bool open_end_ = false;
  bool started_ = false;
};

}  // namespace meridian::cl
