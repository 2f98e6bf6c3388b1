// SPDX-License-Identifier: Apache-2.0
#include "service/transport/waitset.hpp"

#include <dds/dds.h>

#include <string>

namespace meridian::dds {

Waitset::Waitset(Participant& participant)
    : waitset_(dds_create_waitset(participant.handle())),
      guard_(dds_create_guardcondition(participant.handle())) {
  if (waitset_ < 0 || guard_ < 0 || dds_waitset_attach(waitset_, guard_, 0) < 0) {
    dds_delete(waitset_);
    dds_delete(guard_);
    throw DdsError("DDS waitset cannot be created; the process is out of memory or handles");
  }
}

Waitset::~Waitset() {
  dds_delete(waitset_);
  dds_delete(guard_);
}

void Waitset::attach_reader(std::int32_t reader) {
  const dds_entity_t condition = dds_create_readcondition(reader, DDS_ANY_STATE);
  if (condition < 0 || dds_waitset_attach(waitset_, condition, 0) < 0) {
    throw DdsError(std::string("DDS reader cannot be waited for: ") + dds_strretcode(-condition));
  }
}

void Waitset::wait(std::chrono::nanoseconds timeout) noexcept {
  (void)dds_waitset_wait(waitset_, nullptr, 0, timeout.count());
  bool was_woken = false;
  (void)dds_take_guardcondition(guard_, &was_woken);
}

void Waitset::wake() noexcept { (void)dds_set_guardcondition(guard_, true); }

}  // namespace meridian::dds
