// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <zstd.h>

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "service/recording/mcap/crc32.hpp"

/// An MCAP file read from its begin to its end, or to where it was cut off, as readers do that find
/// no summary. Of its own: it shares the checksum with the writer and nothing else.
namespace meridian::test {

/// Numbers and texts one after the other.
class Parts {
 public:
  explicit Parts(std::string_view bytes) : bytes_(bytes) {}
  template <class Number>
  [[nodiscard]] Number number() {
    Number value{};
    if (bytes_.size() < sizeof value) {
      is_short_ = true;
      return value;
    }
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_.remove_prefix(sizeof value);
    return value;
  }
  [[nodiscard]] std::string_view bytes(std::uint64_t count) {
    if (bytes_.size() < count) {
      is_short_ = true;
      return {};
    }
    const std::string_view out = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return out;
  }
  [[nodiscard]] std::string text() { return std::string(bytes(number<std::uint32_t>())); }
  [[nodiscard]] std::string_view rest() const { return bytes_; }
  [[nodiscard]] bool is_short() const { return is_short_; }

 private:
  std::string_view bytes_;
  bool is_short_ = false;
};

struct McapMessage {
  std::string topic;
  std::uint32_t sequence = 0;
  std::uint64_t time_ns = 0;
  std::string data;
};

struct McapContent {
  std::vector<McapMessage> messages;
  std::vector<std::size_t> chunks;             ///< messages in each of them
  std::map<std::string, std::string> schemas;  ///< text by name
  std::map<std::string, std::string> metadata;
  bool has_end = false;  ///< the magic after the footer
  bool is_sound = true;  ///< the sums of all chunks
};

class McapReading {
 public:
  explicit McapReading(std::string_view file) {
    Parts parts(file);
    (void)parts.bytes(8);
    while (!parts.is_short()) {
      if (parts.rest().size() == 8) {
        content_.has_end = parts.rest() == file.substr(0, 8);
        break;
      }
      if (!read_record(parts)) break;
    }
  }
  [[nodiscard]] const McapContent& content() const { return content_; }

 private:
  bool read_record(Parts& parts) {
    const auto opcode = parts.number<std::uint8_t>();
    const std::string_view record = parts.bytes(parts.number<std::uint64_t>());
    if (parts.is_short()) return false;
    Parts in(record);
    switch (opcode) {
      case 0x03: {
        (void)in.number<std::uint16_t>();
        const std::string name = in.text();
        (void)in.text();
        content_.schemas[name] = in.text();
        break;
      }
      case 0x04: {
        const auto id = in.number<std::uint16_t>();
        (void)in.number<std::uint16_t>();
        topics_[id] = in.text();
        break;
      }
      case 0x05: {
        const auto channel = in.number<std::uint16_t>();
        const auto sequence = in.number<std::uint32_t>();
        const auto time_ns = in.number<std::uint64_t>();
        (void)in.number<std::uint64_t>();
        content_.messages.push_back({topics_[channel], sequence, time_ns, std::string(in.rest())});
        break;
      }
      case 0x06:
        read_chunk(in);
        break;
      case 0x0C: {
        (void)in.text();
        Parts values(in.bytes(in.number<std::uint32_t>()));
        while (!values.rest().empty() && !values.is_short()) {
          const std::string key = values.text();
          content_.metadata[key] = values.text();
        }
        break;
      }
      default:
        break;
    }
    return true;
  }

  void read_chunk(Parts& in) {
    (void)in.bytes(16);
    const auto size = in.number<std::uint64_t>();
    const auto sum = in.number<std::uint32_t>();
    const std::string compression = in.text();
    std::string records(in.bytes(in.number<std::uint64_t>()));
    if (compression == "zstd") {
      std::string plain(size, '\0');
      const std::size_t got =
          ZSTD_decompress(plain.data(), plain.size(), records.data(), records.size());
      content_.is_sound &= got == size;
      records = plain;
    }
    content_.is_sound &= mcap::crc32_of(records) == sum && records.size() == size;
    const std::size_t before = content_.messages.size();
    Parts parts(records);
    while (!parts.rest().empty() && read_record(parts)) {
    }
    content_.chunks.push_back(content_.messages.size() - before);
  }

  McapContent content_;
  std::map<std::uint16_t, std::string> topics_;
};

[[nodiscard]] inline McapContent read_mcap(std::string_view file) {
  return McapReading(file).content();
}

/// The content of a ROS 2 message, field by field.
class CdrParts {
 public:
  explicit CdrParts(std::string_view message) : bytes_(message.substr(4)) {}
  template <class Number>
  [[nodiscard]] Number number() {
    at_ = (at_ + sizeof(Number) - 1) / sizeof(Number) * sizeof(Number);
    Number value{};
    std::memcpy(&value, bytes_.substr(at_, sizeof value).data(), sizeof value);
    at_ += sizeof value;
    return value;
  }
  [[nodiscard]] std::string text() {
    const auto length = number<std::uint32_t>();
    const std::string out(bytes_.substr(at_, length - 1));
    at_ += length;
    return out;
  }
  [[nodiscard]] bool is_over() const { return at_ == bytes_.size(); }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

}  // namespace meridian::test
