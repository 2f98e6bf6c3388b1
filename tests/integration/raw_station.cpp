// SPDX-License-Identifier: Apache-2.0
#include "integration/raw_station.hpp"

#include <algorithm>
#include <utility>

#include "service/protocol/operator/operator_link.hpp"

namespace meridian::test {

RawStation::RawStation(dds::Participant& participant, std::string name)
    : name_(std::move(name)),
      requests_(participant),
      batches_(participant),
      credits_(participant) {}

std::optional<dds::Credit> RawStation::open(std::uint32_t policies) {
  session_ = stream::draw_id();
  const bool is_met = eventually([this] {
    return requests_.matched_readers() > 0 && batches_.matched_readers() > 0 &&
           credits_.matched_writers() > 0;
  });
  if (!is_met) return std::nullopt;
  dds::SessionRequest request;
  request.session = session_;
  request.station = name_;
  request.program = name_ + ".apt";
  request.policies = policies;
  for (int i = 0; i < 10; ++i) {
    static_cast<void>(requests_.write(request));
    const auto answer = wait_for([](const dds::Credit&) { return true; }, milliseconds(500));
    if (answer) return answer;
  }
  return std::nullopt;
}

dds::Batch RawStation::batch(std::uint64_t first, const std::vector<ClBlock>& blocks,
                             bool is_end) const {
  dds::Batch batch;
  batch.session = session_;
  batch.first_sequence = first;
  batch.count = static_cast<std::uint32_t>(blocks.size());
  batch.is_end = is_end;
  std::copy(blocks.begin(), blocks.end(), batch.blocks.begin());
  batch.crc = dds::batch_crc(batch);
  return batch;
}

void RawStation::send(std::uint64_t first, const std::vector<ClBlock>& blocks, bool is_end) {
  send(batch(first, blocks, is_end));
}

void RawStation::send(const dds::Batch& batch) { static_cast<void>(batches_.write(batch)); }

std::optional<dds::Credit> RawStation::wait_for(
    const std::function<bool(const dds::Credit&)>& is_it, milliseconds patience) {
  std::optional<dds::Credit> found;
  static_cast<void>(eventually(
      [&] {
        dds::Credit credit;
        while (!found && credits_.take(credit)) {
          if (credit.session == session_ && is_it(credit)) found = credit;
        }
        return found.has_value();
      },
      patience));
  return found;
}

std::optional<dds::Credit> RawStation::wait_for(dds::Verdict verdict, milliseconds patience) {
  return wait_for([verdict](const dds::Credit& credit) { return credit.verdict == verdict; },
                  patience);
}

}  // namespace meridian::test
