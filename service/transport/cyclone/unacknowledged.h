// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdint.h>

/// What Cyclone keeps with a writer and has no interface for. In C: its inner headers are no C++.
#ifdef __cplusplus
extern "C" {
#endif

struct meridian_unacknowledged {
  uint64_t up_to;           ///< sequence that all readers have acknowledged
  uint64_t sent;            ///< sequence of the newest sample
  uint8_t participant[16];  ///< GUID of one that is behind, as on the wire
};

/// 1, and `out` filled: a reader of the DDS writer has not acknowledged all that it sent. 0: all
/// have, or there is no such writer.
int meridian_find_unacknowledged(int32_t writer, struct meridian_unacknowledged* out);

#ifdef __cplusplus
}
#endif
