// SPDX-License-Identifier: Apache-2.0
#include "service/transport/cyclone/unacknowledged.h"

#include <arpa/inet.h>
#include <dds/dds.h>
#include <stddef.h>
#include <string.h>

// These need what stands before them.
// clang-format off
#include <dds/ddsi/ddsi_entity.h>
#include <dds/ddsi/q_hbcontrol.h>
#include <dds/ddsi/ddsi_deliver_locally.h>
#include <dds/ddsi/ddsi_domaingv.h>
#include <dds/ddsi/ddsi_endpoint.h>
#include <dds/ddsi/ddsi_entity_index.h>
#include <dds/ddsi/ddsi_entity_match.h>
#include <dds/ddsi/q_thread.h>
// clang-format on

_Static_assert(sizeof(dds_guid_t) == sizeof(ddsi_guid_t), "a GUID has 16 bytes");
_Static_assert(offsetof(struct ddsi_wr_prd_match, avlnode) == 0, "a node of the tree is the match");

/// Cyclone's inside has GUIDs in the host's byte order, its interface in the network's.
static ddsi_guid_t inside(dds_guid_t guid) {
  uint32_t words[4];
  ddsi_guid_t out;
  memcpy(words, guid.v, sizeof words);
  for (int i = 0; i < 4; ++i) words[i] = ntohl(words[i]);
  memcpy(&out, words, sizeof out);
  return out;
}

static void participant_of(ddsi_guid_t endpoint, uint8_t out[16]) {
  uint32_t words[4];
  memcpy(words, &endpoint, sizeof words);
  words[3] = 0x1c1;  // the entity of a participant, DDSI 9.3.1.3
  for (int i = 0; i < 4; ++i) words[i] = htonl(words[i]);
  memcpy(out, words, sizeof words);
}

int meridian_find_unacknowledged(int32_t writer, struct meridian_unacknowledged* out) {
  dds_guid_t guid;
  // Asking for its readers leaves the writer's domain with this thread.
  if (dds_get_guid(writer, &guid) != DDS_RETCODE_OK ||
      dds_get_matched_subscriptions(writer, NULL, 0) <= 0) {
    return 0;
  }
  struct thread_state* const thread = lookup_thread_state();
  const struct ddsi_domaingv* const domain = ddsrt_atomic_ldvoidp(&thread->gv);
  if (domain == NULL) return 0;
  int is_unacknowledged = 0;
  const ddsi_guid_t own = inside(guid);
  thread_state_awake(thread, domain);
  struct ddsi_writer* const found = entidx_lookup_writer_guid(domain->entity_index, &own);
  if (found != NULL) {
    ddsrt_mutex_lock(&found->e.lock);
    const struct ddsi_wr_prd_match* const root =
        (const struct ddsi_wr_prd_match*)found->readers.root;
    is_unacknowledged = root != NULL && root->min_seq < found->seq;
    if (is_unacknowledged) {
      out->up_to = root->min_seq;
      out->sent = found->seq;
      participant_of(root->arbitrary_unacked_reader, out->participant);
    }
    ddsrt_mutex_unlock(&found->e.lock);
  }
  thread_state_asleep(thread);
  return is_unacknowledged;
}
