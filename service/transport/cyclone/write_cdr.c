// SPDX-License-Identifier: Apache-2.0
#include "service/transport/cyclone/write_cdr.h"

#include <arpa/inet.h>
#include <dds/dds.h>
#include <string.h>

// These need what stands before them.
// clang-format off
#include <dds/ddsi/ddsi_entity.h>
#include <dds/ddsi/ddsi_domaingv.h>
#include <dds/ddsi/ddsi_endpoint.h>
#include <dds/ddsi/ddsi_entity_index.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/q_thread.h>
// clang-format on

/// The type of the topic that the writer has; it lives as long as the writer does.
static const struct ddsi_sertype* type_of(int32_t writer) {
  dds_guid_t guid;
  if (dds_get_guid(writer, &guid) != DDS_RETCODE_OK) return NULL;
  uint32_t words[4];  // in the network's byte order, inside in that of the host
  memcpy(words, guid.v, sizeof words);
  for (int i = 0; i < 4; ++i) words[i] = ntohl(words[i]);
  ddsi_guid_t inside;
  memcpy(&inside, words, sizeof inside);
  // Asking for its readers leaves the writer's domain with this thread.
  if (dds_get_matched_subscriptions(writer, NULL, 0) < 0) return NULL;
  struct thread_state* const thread = lookup_thread_state();
  const struct ddsi_domaingv* const domain = ddsrt_atomic_ldvoidp(&thread->gv);
  if (domain == NULL) return NULL;
  thread_state_awake(thread, domain);
  const struct ddsi_writer* const found = entidx_lookup_writer_guid(domain->entity_index, &inside);
  const struct ddsi_sertype* const type = found != NULL ? found->type : NULL;
  thread_state_asleep(thread);
  return type;
}

int32_t meridian_write_cdr(int32_t writer, const void* message, size_t bytes) {
  const struct ddsi_sertype* const type = type_of(writer);
  if (type == NULL) return DDS_RETCODE_BAD_PARAMETER;
  const ddsrt_iovec_t part = {.iov_base = (void*)message, .iov_len = bytes};
  struct ddsi_serdata* const data = ddsi_serdata_from_ser_iov(type, SDK_DATA, 1, &part, bytes);
  if (data == NULL) return DDS_RETCODE_BAD_PARAMETER;
  return dds_writecdr(writer, data);
}
