// SPDX-License-Identifier: Apache-2.0
#include "service/recording/telemetry/journal/sealed_text.hpp"

#include <fcntl.h>
#include <spdlog/fmt/fmt.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <span>
#include <utility>

#include "service/transport/convert/crc32c.hpp"

namespace meridian::telemetry {
namespace {

constexpr std::string_view kCrcKey = "crc32c = ";

/// All that is in `file`, as open() returned it, at most `max` bytes.
[[nodiscard]] Expected<std::string, std::string> read_open_file(int file, std::size_t max) {
  const auto why = [](int error) {
    return tl::make_unexpected(error == ELOOP
                                   ? std::string("is a symbolic link")
                                   : fmt::format("cannot be read: {}", std::strerror(error)));
  };
  if (file < 0) return why(errno);
  struct stat facts {};
  if (::fstat(file, &facts) != 0) return why(errno);
  if (!S_ISREG(facts.st_mode)) return tl::make_unexpected(std::string("is no regular file"));
  std::string text(max, '\0');
  std::size_t size = 0;
  while (size < text.size()) {
    const ssize_t count = ::read(file, text.data() + size, text.size() - size);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return why(errno);
    if (count == 0) break;
    size += static_cast<std::size_t>(count);
  }
  text.resize(size);
  return text;
}

}  // namespace

Expected<std::optional<std::string>, std::string> read_small_file(const std::filesystem::path& path,
                                                                  std::size_t max) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW);
  if (file < 0 && errno == ENOENT) return std::nullopt;
  auto text = read_open_file(file, max);
  if (file >= 0) (void)::close(file);
  if (!text) return tl::make_unexpected(text.error());
  return std::move(*text);
}

std::uint32_t crc_of(std::string_view text) noexcept {
  return dds::crc32c(std::as_bytes(std::span(text.data(), text.size())));
}

std::string seal(const std::string& text) {
  return text + fmt::format("{}{:08X}\n", kCrcKey, crc_of(text));
}

std::optional<std::string> find_damage(std::string_view text, std::string_view head,
                                       std::string_view what) {
  if (!text.starts_with(fmt::format("meridian {} ", what))) {
    return fmt::format("is no {} of this service", what);
  }
  if (!text.starts_with(head) || !text.substr(head.size()).starts_with("\n")) {
    return "is of another version of this service";
  }
  const std::size_t at = text.rfind(kCrcKey);
  if (at == std::string_view::npos) return "is torn: its end is missing";
  const std::string_view digits = text.substr(at + kCrcKey.size());
  std::uint32_t crc = 0;
  const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), crc, 16);
  const bool is_whole =
      error == std::errc() && std::string_view(rest, digits.data() + digits.size()) == "\n";
  if (!is_whole || crc != crc_of(text.substr(0, at))) return "is torn: its checksum is wrong";
  return std::nullopt;
}

}  // namespace meridian::telemetry
