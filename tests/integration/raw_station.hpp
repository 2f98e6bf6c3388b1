// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "integration/process.hpp"
#include "meridian/path/cl_block.hpp"
#include "service/transport/convert/messages.hpp"
#include "service/transport/participant.hpp"
#include "service/transport/reader.hpp"
#include "service/transport/writer.hpp"

namespace meridian::test {

/// A station without manners: sends whatever the test asks for, credits or not, and hears every
/// answer.
class RawStation {
 public:
  explicit RawStation(dds::Participant& participant, std::string name = "raw");

  /// Opens a new session with `policies`; nothing where no answer came.
  std::optional<dds::Credit> open(std::uint32_t policies = 0);
  /// Sends `blocks` as one batch of this session from `first` on, CRC right.
  void send(std::uint64_t first, const std::vector<ClBlock>& blocks, bool is_end = false);
  /// Sends a batch as it is.
  void send(const dds::Batch& batch);
  /// The batch that send() would send.
  [[nodiscard]] dds::Batch batch(std::uint64_t first, const std::vector<ClBlock>& blocks,
                                 bool is_end = false) const;

  /// Waits for an answer to this session with `verdict`.
  [[nodiscard]] std::optional<dds::Credit> wait_for(dds::Verdict verdict,
                                                    milliseconds patience = milliseconds(5000));
  /// Waits for an answer to this session that `is_it` likes.
  [[nodiscard]] std::optional<dds::Credit> wait_for(
      const std::function<bool(const dds::Credit&)>& is_it,
      milliseconds patience = milliseconds(5000));

  [[nodiscard]] std::uint64_t session() const noexcept { return session_; }

 private:
  std::string name_;
  std::uint64_t session_ = 0;
  dds::Writer<dds::SessionRequest> requests_;
  dds::Writer<dds::Batch> batches_;
  dds::Reader<dds::Credit> credits_;
};

}  // namespace meridian::test
